#!/usr/bin/env python3
"""No unfinished ends and no names of one machine in what is committed.

Unfinished words in code; home and working directories of a machine and package mirrors anywhere.
Reads the files git tracks (or would track). Exit 1 with one line per find.
"""

import re
import subprocess
import sys
from pathlib import Path

from csource import ROOT

# Written so that this file does not find itself.
UNFINISHED = re.compile(r"\b(TO[D]O|FIX[M]E|XX[X]|HAC[K])\b")
MACHINE = re.compile(
    r"(?<![\w.:/])/(?:hom[e]/\w|roo[t]/\w|User[s]/\w|wor[k]/|far[m]/)|\.librar[y]/|\.\./share[d]\b"
    r"|https?://[^\s]*(?:/debia[n](?![\w-])|/simpl[e]/|registr[y]\.|/artifactor[y])"
)
CODE = ("src", "include", "examples", "tools", "tests", "cmake", "lcmtypes", ".ci")


def problems_of(path, text):
    """Finds in one file as lines of text; path is relative to the root."""
    out = []
    code = Path(path).parts[0] in CODE
    for number, line in enumerate(text.splitlines(), 1):
        if code and UNFINISHED.search(line):
            out.append(f"{path}:{number}: unfinished: {line.strip()[:100]}")
        if MACHINE.search(line):
            out.append(f"{path}:{number}: names a machine: {line.strip()[:100]}")
    return out


def tracked(root):
    """Files git tracks or would track, as paths relative to the root."""
    run = subprocess.run(
        ["git", "-C", str(root), "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        check=True,
        capture_output=True,
    )
    return sorted(Path(name.decode()) for name in run.stdout.split(b"\0") if name)


def main():
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT
    problems, count = [], 0
    for path in tracked(root):
        try:
            text = (root / path).read_text()
        except (UnicodeDecodeError, FileNotFoundError, IsADirectoryError):
            continue
        count += 1
        problems += problems_of(path, text)
    for problem in problems:
        print(f"words: {problem}")
    print(f"words: {count} files, {len(problems)} finds")
    return 1 if problems or not count else 0


if __name__ == "__main__":
    sys.exit(main())
