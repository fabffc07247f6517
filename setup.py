"""Build hook: the message package `aisle` is generated from lcmtypes/*.lcm before the files are collected."""

import shutil
import subprocess
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

ROOT = Path(__file__).resolve().parent
OUT = ROOT / "build" / "python"


def find_lcm_gen() -> str:
    """The ELF tool of the LCM wheel; without the wheel, the one of the system."""
    try:
        import lcm

        bundled = Path(lcm.__file__).resolve().parent.parent / "bin" / "lcm-gen"
        if bundled.is_file():
            return str(bundled)
    except ImportError:
        pass
    found = shutil.which("lcm-gen")
    if found is None:
        raise SystemExit("lcm-gen not found: install the Python package lcm (1.5.3) or Debian's liblcm-bin")
    return found


class BuildPy(build_py):
    def run(self) -> None:
        shutil.rmtree(OUT / "aisle", ignore_errors=True)
        OUT.mkdir(parents=True, exist_ok=True)
        files = sorted(str(f) for f in (ROOT / "lcmtypes").glob("*.lcm"))
        subprocess.run([find_lcm_gen(), "-p", "--ppath", str(OUT), *files], check=True)
        super().run()


(OUT / "aisle").mkdir(parents=True, exist_ok=True)  # looked for before build_py runs
setup(
    cmdclass={"build_py": BuildPy},
    options={"build": {"build_base": str(OUT / "setuptools")}, "egg_info": {"egg_base": str(OUT)}},
)
