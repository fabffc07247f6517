#!/usr/bin/env python3
"""Stack bound of the core: the deepest sum of frames over gcc's own call graph. Also proves: no recursion, no alloca.

    stack.py DIR... [--limit BYTES]     DIR: holds *.ci files of `gcc -fcallgraph-info=su,da`
    stack.py DIR... --header FILE       writes the bound as a macro, or none if it is not proved; exit 0

Calls through pointers are bounded by what inlets.txt beside this file lists for the calling file; a file that is
missing there fails the gate. Functions outside the archive count with the bytes of EXTERNAL, measured or stated there,
and with what inlets.txt says they call back.
Prints the worst frames and the bound of every public function; exit 1 on recursion, unbounded frames, unknown
callees or a bound above the limit.
"""

import argparse
import re
import sys
from pathlib import Path

# Bytes below our own frame. libccd 2.1, x86-64, gcc -O2: ccdMPRIntersect 352 + refinePortal 288 + small vector helpers.
# A failed assert ends the program, so it adds to nothing.
EXTERNAL = {
    "ccdMPRIntersect": 1024,
    "aisle_assert_failed": 0,
    "__stack_chk_fail": 0,
    **dict.fromkeys(("memcpy", "memset", "memmove", "memcmp", "strcmp", "strlen"), 128),
    **dict.fromkeys(("sqrt", "sqrtf", "floor", "floorf", "fabs", "fabsf"), 64),
}
INDIRECT = "__indirect_call"
NODE = re.compile(r'node: \{ title: "([^"]*)" label: "([^"]*)"')
EDGE = re.compile(r'edge: \{ sourcename: "([^"]*)" targetname: "([^"]*)"')
FRAME = re.compile(r"(\d+) bytes \((static|dynamic|dynamic,bounded)\)")


class Graph:
    """Frames and calls of all translation units. A static function's title carries its file, so names do not clash."""

    def __init__(self):
        self.frame = {}  # title -> bytes
        self.calls = {}  # title -> set of titles
        self.file = {}  # title -> source file
        self.unbounded = []

    def read(self, text):
        for title, label in NODE.findall(text):
            frame = FRAME.search(label)
            if frame is None:
                continue
            self.frame[title] = int(frame.group(1))
            self.file[title] = label.split("\\n")[1].split(":")[0]
            if frame.group(2) == "dynamic":
                self.unbounded.append(title)
        for source, target in EDGE.findall(text):
            self.calls.setdefault(source, set()).add(target)

    def titles(self, name):
        """The functions of that plain name."""
        return [t for t in self.frame if plain(t) == name]


def plain(title):
    """Function name of a title: what follows the file, without gcc's clone suffixes."""
    return title.rsplit(":", 1)[-1].split(".")[0]


def short(title):
    """A title without the folders of its file."""
    return title.rsplit("/", 1)[-1]


def read_inlets(text):
    """{file or external function: [callee...]} from lines "caller: callee callee"; # starts a comment."""
    inlets = {}
    for line in text.splitlines():
        line = line.split("#")[0].strip()
        if line:
            caller, _, callees = line.partition(":")
            inlets[caller.strip()] = callees.split()
    return inlets


def listed(inlets, path):
    """What inlets.txt says of a source file, None if nothing."""
    return next((names for key, names in inlets.items() if path == key or path.endswith("/" + key)), None)


def add_callbacks(graph, inlets):
    """External functions that call back become part of the graph."""
    for name in set(EXTERNAL) & set(inlets):
        graph.frame[name] = EXTERNAL[name]
        graph.file[name] = name
        graph.calls[name] = {INDIRECT}


def resolve(graph, inlets):
    """Calls with pointers replaced by the functions they may reach; also the problems met on the way."""
    calls, problems = {}, []
    add_callbacks(graph, inlets)
    for title in graph.frame:
        targets = set(graph.calls.get(title, ()))
        if INDIRECT in targets:
            targets.discard(INDIRECT)
            names = listed(inlets, graph.file[title])
            if names is None:
                problems.append(f"{short(title)} calls through a pointer and inlets.txt does not say whom")
            for name in names or ():
                found = graph.titles(name)
                targets.update(found)
                if not found:
                    problems.append(f"inlets.txt: {graph.file[title]} may call {name}, which is not there")
        for target in targets:
            if target not in graph.frame and plain(target) not in EXTERNAL:
                problems.append(f"{short(title)} calls {short(target)}, whose stack is not known")
        calls[title] = targets
    return calls, problems


def depths(graph, calls):
    """(bytes below and with each function, deepest callee of each, cycles found). Depth first without recursion."""
    depth, deepest, cycles, state = {}, {}, [], {}
    for root in graph.frame:
        stack = [(root, iter(sorted(calls[root])))] if root not in state else []
        state.setdefault(root, "open")
        while stack:
            title, targets = stack[-1]
            for target in targets:
                if target not in graph.frame:
                    continue
                if state.get(target) == "open":
                    chain = [t for t, _ in stack]
                    cycles.append([*chain[chain.index(target) :], target])
                elif target not in state:
                    state[target] = "open"
                    stack.append((target, iter(sorted(calls[target]))))
                    break
            else:
                below = {t: depth.get(t, EXTERNAL.get(plain(t), 0)) for t in calls[title]}
                deepest[title] = max(sorted(below), key=below.get, default=None)
                depth[title] = graph.frame[title] + max(below.values(), default=0)
                state[title] = "done"
                stack.pop()
    return depth, deepest, cycles


def chain_of(title, deepest):
    """Names from a function down its deepest calls."""
    names = []
    while title is not None and len(names) < 64:
        names.append(title)
        title = deepest.get(title)
    return names


def analyse(texts, inlets):
    """(graph, depth, deepest, problems) of the texts of .ci files."""
    graph = Graph()
    for text in texts:
        graph.read(text)
    calls, problems = resolve(graph, inlets)
    depth, deepest, cycles = depths(graph, calls)
    for cycle in cycles:
        problems.append(f"recursion: {' -> '.join(plain(t) for t in cycle)} ({short(graph.file[cycle[0]])})")
    problems += [f"{title} has a frame of no fixed size" for title in graph.unbounded]
    return graph, depth, deepest, problems


def report(graph, depth, deepest):
    """The table as lines, and the bound."""
    lines = ["worst frames (bytes):"]
    for title in sorted(graph.frame, key=lambda t: (-graph.frame[t], t))[:10]:
        lines.append(f"  {graph.frame[title]:>7}  {short(title)}")
    entries = {t: d for t, d in depth.items() if ":" not in t and t.startswith("aisle_planner_")} or depth
    lines.append("deepest chain from each entry (bytes):")
    for title in sorted(entries, key=lambda t: (-entries[t], t))[:20]:
        lines.append(f"  {entries[title]:>7}  {plain(title)}")
    worst = max(entries, key=entries.get)
    lines.append("the worst one, frame by frame:")
    for title in chain_of(worst, deepest):
        lines.append(f"  {graph.frame.get(title, EXTERNAL.get(plain(title), 0)):>7}  {plain(title)}")
    return lines, entries[worst]


def write_header(path, bound, problems):
    """The bound as a macro for the daemon to print; nothing if there are problems. Written only if it changes."""
    text = "// Made by tools/gates/stack.py from this build's call graph.\n"
    text += f"#define AISLE_STACK_BOUND {bound}\n" if not problems else "".join(f"// {p}\n" for p in problems)
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.is_file() or path.read_text() != text:
        path.write_text(text)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("directories", nargs="+", type=Path)
    parser.add_argument("--inlets", type=Path, default=Path(__file__).with_name("inlets.txt"))
    parser.add_argument("--limit", type=int, default=0, help="bytes; 0: print only")
    parser.add_argument("--header", type=Path)
    arguments = parser.parse_args()
    files = sorted(f for d in arguments.directories for f in d.rglob("*.ci"))
    if not files:
        print("stack: no .ci files; compile with -fcallgraph-info=su,da")
        return 1
    inlets = read_inlets(arguments.inlets.read_text())
    graph, depth, deepest, problems = analyse([f.read_text() for f in files], inlets)
    lines, bound = report(graph, depth, deepest)
    if arguments.header:
        write_header(arguments.header, bound, problems)
        return 0
    print("\n".join(lines))
    if arguments.limit and bound > arguments.limit:
        problems.append(f"the bound is {bound} bytes, limit {arguments.limit}")
    for problem in problems:
        print(f"stack: {problem}")
    print(f"stack: {len(graph.frame)} functions, bound {bound} bytes, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
