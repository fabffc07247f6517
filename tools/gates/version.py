#!/usr/bin/env python3
"""One version: CMakeLists.txt states it; pyproject.toml and the newest heading of CHANGELOG.md say the same."""

import re
import sys
from pathlib import Path

from csource import ROOT

PLACES = {
    "CMakeLists.txt": r"project\(\w+ VERSION (\d+\.\d+\.\d+)",
    "pyproject.toml": r'(?m)^version *= *"(\d+\.\d+\.\d+)"',
    "CHANGELOG.md": r"(?m)^## \[?(\d+\.\d+\.\d+)",
}


def problems_of(root):
    """Files that name no version or another one."""
    found = {}
    for name, pattern in PLACES.items():
        path = root / name
        match = re.search(pattern, path.read_text()) if path.is_file() else None
        found[name] = match.group(1) if match else None
    stated = found["CMakeLists.txt"]
    odd = [name for name, value in found.items() if value != stated or not value]
    return [f"{name} says {found[name]}, CMakeLists.txt {stated}" for name in odd]


def main():
    problems = problems_of(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT)
    for problem in problems:
        print(f"version: {problem}")
    print(f"version: {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
