#!/usr/bin/env python3
"""What libaisle.a needs from outside is a short list: no allocation, clock or I/O, no libm but sqrt, fabs, floor.

    symbols.py LIBAISLE.A [--nm NM]

Reads `nm -P`; prints the list; exit 1 if it holds anything not allowed.
"""

import argparse
import re
import subprocess
import sys

ALLOWED = {
    "aisle_assert_failed": "supplied by the program",
    "ccdMPRIntersect": "libccd",
    **dict.fromkeys(("sqrt", "sqrtf", "fabs", "fabsf", "floor", "floorf"), "libm, exact by IEEE 754"),
    **dict.fromkeys(("memcpy", "memset", "memmove", "memcmp", "strcmp", "strlen"), "C library, pure"),
}
# What compilers call by themselves: stack protector, position-independent code, arithmetic of small CPUs.
COMPILER = re.compile(
    r"_GLOBAL_OFFSET_TABLE_|__stack_chk_(fail|guard)|__aeabi_\w+"
    r"|__(u?div|u?mod|mul|ashl|ashr|lshr|clz|ctz|popcount)[sdt]i[234]"
)


def undefined(listing):
    """Names needed but not defined in the archive, from the text of nm -P."""
    needed, defined = set(), set()
    for line in listing.splitlines():
        fields = line.split()
        if len(fields) < 2 or line.endswith(":"):
            continue
        (needed if fields[1] in "Uwv" else defined).add(fields[0])
    return sorted(needed - defined), len(defined)


def problems_of(names):
    """Those that are not allowed."""
    return [name for name in names if name not in ALLOWED and not COMPILER.fullmatch(name)]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("archive")
    parser.add_argument("--nm", default="nm")
    arguments = parser.parse_args()
    run = subprocess.run([arguments.nm, "-P", arguments.archive], capture_output=True, text=True, check=True)
    names, defined = undefined(run.stdout)
    for name in names:
        print(f"  {name:<24}{ALLOWED.get(name, 'compiler' if COMPILER.fullmatch(name) else 'NOT ALLOWED')}")
    problems = problems_of(names)
    print(f"symbols: {defined} defined, {len(names)} needed from outside, {len(problems)} not allowed")
    return 1 if problems or not defined else 0


if __name__ == "__main__":
    sys.exit(main())
