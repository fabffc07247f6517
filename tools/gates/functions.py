#!/usr/bin/env python3
"""Functions stay short: median <= 15 lines, 95th percentile <= 50, none over 80, nesting <= 4 (the body is 1).

Over src/ and include/; a function's lines run from its return type to its closing brace. Nesting counts braces, so
every if, else, for, while and switch must have them. Prints the table; exit 1 if a limit is passed.
"""

import sys
from pathlib import Path

from csource import ROOT, SourceError, c_files, functions, missing_braces

MEDIAN, P95, LONGEST, NESTING = 15, 50, 80, 4


def percentile(ordered, percent):
    """Nearest rank."""
    return ordered[max(0, -(-len(ordered) * percent // 100) - 1)]


def problems_of(found):
    """What passes a limit, as lines of text."""
    if not found:
        return []
    lengths = sorted(f.lines for f in found)
    out = []
    for name, percent, limit in (("median", 50, MEDIAN), ("95th percentile", 95, P95)):
        value = percentile(lengths, percent)
        if value > limit:
            out.append(f"{name} is {value} lines, limit {limit}")
    for f in found:
        if f.lines > LONGEST:
            out.append(f"{f.path}:{f.line}: {f.name} has {f.lines} lines, limit {LONGEST}")
        if f.nesting > NESTING:
            out.append(f"{f.path}:{f.line}: {f.name} nests {f.nesting} deep, limit {NESTING}")
    return out


def collect(root):
    """Functions of all files below root's src and include."""
    found = []
    for path in c_files("src", "include", root=root):
        found += functions(path.relative_to(root), path.read_text())
    return found


def table(found):
    """One line per folder and one for all."""
    groups = {}
    for f in found:
        groups.setdefault(str(Path(f.path).parent), []).append(f)
    rows = [f"{'folder':<16}{'functions':>10}{'median':>8}{'p95':>6}{'max':>6}{'nesting':>9}"]
    for name, group in [*sorted(groups.items()), ("all", found)]:
        lengths = sorted(f.lines for f in group) or [0]
        rows.append(
            f"{name:<16}{len(group):>10}{percentile(lengths, 50):>8}{percentile(lengths, 95):>6}{lengths[-1]:>6}"
            f"{max((f.nesting for f in group), default=0):>9}"
        )
    return rows


def main():
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT
    try:
        found = collect(root)
    except SourceError as error:
        print(f"functions: {error}")
        return 1
    print("\n".join(table(found)))
    for f in sorted(found, key=lambda f: -f.lines)[:5]:
        print(f"  {f.lines:>3} lines  {f.path}:{f.line} {f.name}")
    problems = problems_of(found)
    for path in c_files("src", "include", root=root):
        problems += [f"{path.relative_to(root)}:{line}: braces wanted" for line in missing_braces(path.read_text())]
    for problem in problems:
        print(f"functions: {problem}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
