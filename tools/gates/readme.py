#!/usr/bin/env python3
"""The README's C example is examples/plan_once.c, to the letter; files the README names exist."""

from __future__ import annotations

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent


def faults(readme: str, example: str, exists) -> list[str]:
    blocks = re.findall(r"^```c\n(.*?)^```", readme, re.M | re.S)
    found = [] if blocks == [example] else ["README.md: its C example is not examples/plan_once.c"]
    names = re.findall(r"`((?:[a-z_]+/)+[a-zA-Z_.-]+)`", readme) + re.findall(r"\]\(((?:[a-z]+/)[^)]+)\)", readme)
    return found + [f"README.md: names {n}, which is not there" for n in names if not n.startswith("build/") and not exists(n)]


def main() -> int:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    example = (ROOT / "examples" / "plan_once.c").read_text(encoding="utf-8")
    found = faults(readme, example, lambda name: (ROOT / name).exists())
    print("\n".join(found) if found else "readme: the example is the file, every file named is there")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
