#!/usr/bin/env python3
"""Every header compiles alone and twice: public ones as C99 and C++17, internal ones as C99, warnings as errors.

headers_alone.py --build DIR [--cc CC] [--cxx CXX]     DIR: a configured build tree, for the generated headers
"""

import argparse
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from csource import ROOT

WARNINGS = ["-pedantic", "-Wall", "-Wextra", "-Werror", "-fsyntax-only"]


def compile_alone(compiler, language, standard, name, include_dirs):
    """The compiler's complaint about a file that includes the header twice and nothing else; empty if none."""
    command = [*compiler.split(), f"-std={standard}", *WARNINGS, *(f"-I{d}" for d in include_dirs), "-x", language, "-"]
    source = f'#include "{name}"\n#include "{name}"\nextern int aisle_translation_unit_is_not_empty;\n'
    run = subprocess.run(command, input=source, capture_output=True, text=True, check=False)
    return "" if run.returncode == 0 else run.stderr or f"{compiler} failed"


def jobs_of(root, generated, cc, cxx):
    """(compiler, language, standard, header, include directories) of every compilation to make."""
    public = [root / "include", generated]
    jobs = []
    for folder in public:
        for path in sorted(folder.rglob("*.h")):
            name = str(path.relative_to(folder))
            jobs += [(cc, "c", "c99", name, public), (cxx, "c++", "c++17", name, public)]
    for path in sorted((root / "src").rglob("*.h")):
        jobs.append((cc, "c", "c99", str(path.relative_to(root / "src")), [root / "src", *public]))
    return jobs


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("root", nargs="?", type=Path, default=ROOT)
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--cc", default="cc")
    parser.add_argument("--cxx", default="c++")
    arguments = parser.parse_args()
    generated = arguments.build / "gen" / "include"
    if not (generated / "aisle" / "messages.h").is_file():
        print(f"headers: {generated}/aisle/messages.h is not there: build first")
        return 1
    jobs = jobs_of(arguments.root, generated, arguments.cc, arguments.cxx)
    failed = 0
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        complaints = list(pool.map(lambda job: compile_alone(*job), jobs))
    for job, complaint in zip(jobs, complaints):
        if complaint:
            failed += 1
            print(f"headers: {job[3]} does not stand alone as {job[2]}:\n{complaint}")
    print(f"headers: {len(jobs)} compilations, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
