#!/usr/bin/env python3
"""A file includes its own level and lower, never upward; the core includes no allocation, clock, I/O or threads.

Reads the #include lines of src/ and include/. Exit 1 with one line per break of the rule.
"""

import sys
from pathlib import Path

from csource import ROOT, c_files, includes

LEVEL = {"base": 0, "wire": 1, "world": 1, "algo": 2, "robot": 3, "plan": 4, "daemon": 5, "replay": 5, "sim": 5}
CORE = 4  # levels up to here keep to CORE_SYSTEM
PUBLIC = {"status.h": 0, "limits.h": 0, "version.h": 0, "messages.h": 1, "energy.h": 3, "planner.h": 4}
CORE_SYSTEM = {"float.h", "inttypes.h", "limits.h", "math.h", "stdbool.h", "stddef.h", "stdint.h", "string.h"}
SIDEWAYS = {("wire", "world"), ("daemon", "replay"), ("daemon", "sim"), ("replay", "sim")}  # same level, still not seen by the first
CCD_USER = "src/world/collide.c"


def where(path):
    """(level, folder) of a file of ours, None if it has none: src/<folder>/x or include/aisle/x."""
    parts = path.parts
    if parts[:2] == ("include", "aisle") and len(parts) == 3:
        return PUBLIC.get(parts[2]), "aisle"
    if parts[0] == "src" and len(parts) == 3:
        return LEVEL.get(parts[1]), parts[1]
    return None, None


def problem_with_system(path, level, name):
    """Why this file may not include <name>, or None."""
    if name.startswith("ccd/") or name == "ccd.h":
        return None if str(path) == CCD_USER else f"only {CCD_USER} includes libccd"
    if level <= CORE and name not in CORE_SYSTEM:
        return "the core includes no allocation, clock, I/O, thread or library header"
    return None


def problem_with_own(folder, level, name):
    """Why a file of this level may not include "name", or None."""
    parts = name.split("/")
    if len(parts) != 2 or (parts[0] not in LEVEL and parts[0] != "aisle"):
        return 'write it as "level/file.h" or "aisle/file.h"'
    other = PUBLIC.get(parts[1]) if parts[0] == "aisle" else LEVEL[parts[0]]
    if other is None:
        return "no public header of that name"
    if folder == "aisle" and parts[0] != "aisle":
        return "a public header includes public headers alone"
    if other > level:
        return f"level {level} must not look up to level {other}"
    if (folder, parts[0]) in SIDEWAYS:
        return f"{folder} does not include {parts[0]}"
    return None


def problems_of(path, text):
    """Breaks of the rule in one file, as lines of text; path is relative to the root."""
    level, folder = where(path)
    if level is None:
        return [f"{path}: belongs to no level"]
    out = []
    for line, name, system in includes(text):
        why = problem_with_system(path, level, name) if system else problem_with_own(folder, level, name)
        if why:
            out.append(f"{path}:{line}: {name}: {why}")
    return out


def main():
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT
    files = c_files("src", "include", root=root)
    problems = []
    for path in files:
        problems += problems_of(path.relative_to(root), path.read_text())
    for problem in problems:
        print(f"levels: {problem}")
    print(f"levels: {len(files)} files, {len(problems)} breaks of the rule")
    return 1 if problems or not files else 0


if __name__ == "__main__":
    sys.exit(main())
