"""Every gate must be able to fail: each is fed a case it has to refuse and one it has to let pass."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

GATES = Path(__file__).resolve().parents[2] / "tools" / "gates"
sys.path.insert(0, str(GATES))

import csource  # noqa: E402
import functions  # noqa: E402
import headers_alone  # noqa: E402
import levels  # noqa: E402
import readme  # noqa: E402
import stack  # noqa: E402
import symbols  # noqa: E402
import version  # noqa: E402
import words  # noqa: E402


def function_of(lines, name="f"):
    """A C function of that many lines."""
    return f"int {name}(void) {{\n" + "    work();\n" * (lines - 2) + "}\n"


def nested(depth):
    """A C function whose deepest block is that deep, the body being 1."""
    return "void f(int a) {\n" + "if (a) {\n" * (depth - 1) + "a++;\n" + "}\n" * (depth - 1) + "}\n"


def scan(text):
    return csource.functions("x.c", text)


class CSource(unittest.TestCase):
    def test_a_function_counts_from_return_type_to_closing_brace(self):
        found = scan("// above\nstatic int\nlong_name(int a,\n          int b) {\n    return a + b;\n}\n")
        self.assertEqual([(f.name, f.line, f.lines, f.nesting) for f in found], [("long_name", 2, 5, 1)])

    def test_braces_in_comments_strings_and_characters_do_not_count(self):
        found = scan(
            "void f(void) {\n // }\n /* }}} */\n puts(\"}\\\"}\");\n char c = '}';\n char d = '\\'';\n}\nint g(void) { return 1; }\n"
        )
        self.assertEqual([(f.name, f.lines) for f in found], [("f", 7), ("g", 1)])

    def test_initialisers_and_types_are_not_blocks(self):
        text = (
            "typedef struct a { int x; union { int y; }; } a;\nenum { ONE = 1 };\nstatic const a table[] = {{1}, {2}};\n"
            "static a at = (a){1};\n"
            "a f(int k) {\n    a v = (a){.x = k};\n    g((a[]){{1}, {{2}}});\n    struct b { int z; } w = {{{{{3}}}}};\n"
            "    return k ? (a){1} : (a){{{{2}}}};\n}\n"
        )
        self.assertEqual([(f.name, f.lines, f.nesting) for f in scan(text)], [("f", 6, 1)])

    def test_every_kind_of_block_nests(self):
        text = (
            "void f(int a) {\n for (int i = 0; i < a; i++) {\n  while (a) {\n   do {\n    switch (a) {\n    case 1: {\n"
            "     a++;\n    }\n    default: {\n    }\n    }\n   } while (0);\n  }\n } if (a) { } else if (g(a)) { { } } else { }\n}\n"
        )
        self.assertEqual([f.nesting for f in scan(text)], [6])

    def test_both_branches_of_a_conditional_may_open_the_same_brace(self):
        text = "#ifdef A\nint f(int a) {\n#else\nint f(void) {\n#endif\n    return 1;\n}\nint g(void) { return 2; }\n"
        self.assertEqual([f.name for f in scan(text)], ["f", "g"])

    def test_extern_c_and_attributes_are_seen_through(self):
        text = '#ifdef __cplusplus\nextern "C" {\n#endif\n__attribute__((noinline)) static int f(int (*g)(int)) {\n return g(1);\n}\n#ifdef __cplusplus\n}\n#endif\n'
        self.assertEqual([f.name for f in scan(text)], ["f"])

    def test_a_macro_of_several_lines_is_no_function(self):
        self.assertEqual(
            [f.name for f in scan("#define M(x) do { \\\n  x; \\\n} while (0)\nint f(void) { M(1); }\n")], ["f"]
        )

    def test_missing_braces_are_found_and_present_ones_are_not(self):
        bad = "void f(int a) {\n if (a) g();\n for (;;) g();\n if (a) { } else g();\n while (a) ;\n do g(); while (a);\n}\n"
        self.assertEqual(sorted(set(csource.missing_braces(bad))), [2, 3, 4, 5, 6])
        good = "void f(int a) {\n if (a) { } else if (g(a)) { } else { }\n do { } while (a);\n while (a) { }\n}\n#define M if (1) g()\n"
        self.assertEqual(csource.missing_braces(good), [])

    def test_an_unfinished_file_is_an_error_not_a_pass(self):
        for text in ("int f(void) {\n", "}\n"):
            with self.assertRaises(csource.SourceError):
                scan(text)


class Functions(unittest.TestCase):
    def test_limits_pass_at_the_limit_and_fail_one_above(self):
        short = [function_of(5, f"s{i}") for i in range(97)]
        for longest, nesting, fails in ((80, 4, 0), (81, 4, 1), (80, 5, 1)):
            found = scan("".join(short) + function_of(longest, "l") + nested(nesting))
            self.assertEqual(len(functions.problems_of(found)), fails, (longest, nesting))

    def test_median_above_15_fails(self):
        self.assertEqual(functions.problems_of(scan(function_of(15))), [])
        self.assertEqual(len(functions.problems_of(scan(function_of(16)))), 1)

    def test_percentile_above_50_fails(self):
        mostly_short = "".join(function_of(5, f"s{i}") for i in range(94))
        five = "".join(function_of(51, f"l{i}") for i in range(5))
        self.assertEqual(functions.problems_of(scan(mostly_short + function_of(5) + five)), [])
        self.assertEqual(len(functions.problems_of(scan(mostly_short + function_of(51) + five))), 1)


class Levels(unittest.TestCase):
    def refuses(self, path, line):
        return bool(levels.problems_of(Path(path), f"{line}\n"))

    def test_upward_sideways_and_bare_includes_are_refused(self):
        for path, line in (
            ("src/base/arena.c", '#include "world/grid.h"'),
            ("src/base/arena.c", '#include "aisle/messages.h"'),
            ("src/wire/codec.c", '#include "world/grid.h"'),
            ("src/algo/pso.c", '#include "robot/vehicle.h"'),
            ("src/robot/speed.c", '#include "aisle/planner.h"'),
            ("src/plan/verify.c", '  #  include "daemon/bus.h"'),
            ("src/plan/verify.c", '#include "verify.h"'),
            ("src/plan/verify.c", '#include "../plan/verify.h"'),
            ("include/aisle/planner.h", '#include "base/arena.h"'),
            ("include/aisle/status.h", '#include "aisle/messages.h"'),
            ("src/odd/file.c", ""),
        ):
            self.assertTrue(self.refuses(path, line), (path, line))

    def test_own_level_and_lower_pass(self):
        for path, line in (
            ("src/world/layout.c", '#include "wire/codec.h"'),
            ("src/wire/codec.c", '#include "base/check.h"'),
            ("src/plan/planner.c", '#include "aisle/planner.h"'),
            ("src/base/arena.c", '// #include "world/grid.h"'),
            ("src/base/arena.c", '/* \n#include "world/grid.h" */'),
        ):
            self.assertFalse(self.refuses(path, line), (path, line))

    def test_the_core_takes_no_heap_clock_or_io_header_and_one_file_takes_ccd(self):
        for name in ("stdlib.h", "stdio.h", "time.h", "pthread.h", "unistd.h", "assert.h", "lcm/lcm.h", "ccd/ccd.h"):
            self.assertTrue(self.refuses("src/plan/verify.c", f"#include <{name}>"), name)
            self.assertTrue(self.refuses("include/aisle/planner.h", f"#include <{name}>"), name)
        self.assertTrue(self.refuses("src/daemon/main.c", "#include <ccd/ccd.h>"))
        self.assertFalse(self.refuses("src/world/collide.c", "#include <ccd/ccd.h>"))
        self.assertFalse(self.refuses("src/daemon/main.c", "#include <stdlib.h>"))


class Symbols(unittest.TestCase):
    def test_foreign_names_are_refused_and_own_ones_are_not_foreign(self):
        listing = "lib.a[a.o]:\nf T 0 1\ng U\nmemcpy U\nlib.a[b.o]:\ng T 0 1\nmalloc U\nclock_gettime U\nsin U\n__aeabi_dmul U\n__printf_chk U\n"
        names, defined = symbols.undefined(listing)
        self.assertEqual(defined, 2)
        self.assertEqual(symbols.problems_of(names), ["__printf_chk", "clock_gettime", "malloc", "sin"])


class Stack(unittest.TestCase):
    @staticmethod
    def ci(frames, edges):
        nodes = "".join(
            f'node: {{ title: "{t}" label: "{t}\\nx.c:1:1\\n{b} bytes ({k})\\n0 dynamic objects" }}\n' for t, b, k in frames
        )
        return nodes + "".join(f'edge: {{ sourcename: "{a}" targetname: "{b}" label: "x.c:1:1" }}\n' for a, b in edges)

    def test_the_bound_is_the_deepest_chain(self):
        text = self.ci(
            [
                ("aisle_planner_step", 100, "static"),
                ("a.c:mid", 50, "static"),
                ("a.c:leaf", 7, "static"),
                ("wide", 56, "static"),
            ],
            [("aisle_planner_step", "a.c:mid"), ("a.c:mid", "a.c:leaf"), ("aisle_planner_step", "wide")],
        )
        graph, depth, deepest, problems = stack.analyse([text], {})
        self.assertEqual(problems, [])
        self.assertEqual(stack.report(graph, depth, deepest)[1], 157)

    def test_recursion_is_found_through_any_number_of_functions(self):
        text = self.ci([(n, 8, "static") for n in "abc"], [("a", "b"), ("b", "c"), ("c", "b")])
        self.assertIn("recursion: b -> c -> b (x.c)", stack.analyse([text], {})[3])

    def test_frames_without_bound_unknown_callees_and_unlisted_pointers_fail(self):
        text = self.ci([("a", 8, "dynamic"), ("b", 8, "static")], [("a", "qsort"), ("b", "__indirect_call")])
        self.assertEqual(len(stack.analyse([text], {})[3]), 3)

    def test_a_listed_pointer_counts_with_the_deepest_of_its_list(self):
        text = self.ci([("a", 8, "static"), ("x.c:cb", 30, "static")], [("a", "__indirect_call")])
        _, depth, _, problems = stack.analyse([text], stack.read_inlets("x.c: cb # why\n"))
        self.assertEqual((depth["a"], problems), (38, []))
        self.assertEqual(len(stack.analyse([text], {"x.c": ["gone"]})[3]), 1)

    def test_what_an_external_function_calls_back_lies_on_top_of_it(self):
        text = self.ci([("a", 8, "static"), ("x.c:support", 30, "static")], [("a", "ccdMPRIntersect")])
        _, depth, _, problems = stack.analyse([text], {"ccdMPRIntersect": ["support"]})
        self.assertEqual((depth["a"], problems), (38 + stack.EXTERNAL["ccdMPRIntersect"], []))


class Readme(unittest.TestCase):
    TEXT = "see `src/base/arena.h`\n```c\nint x;\n```\n![a](docs/a.png)\n"

    def test_the_example_must_be_the_file_and_named_files_must_be_there(self):
        self.assertEqual([], readme.faults(self.TEXT, "int x;\n", lambda name: True))
        self.assertEqual(1, len(readme.faults(self.TEXT, "int y;\n", lambda name: True)))
        self.assertEqual(2, len(readme.faults(self.TEXT, "int x;\n", lambda name: False)))


class Words(unittest.TestCase):
    def test_unfinished_words_are_found_in_code_and_machine_paths_anywhere(self):
        for path, line in (
            ("src/a.c", "// TO" + "DO later"),
            ("tools/x.py", "# FIX" + "ME"),
            ("README.md", "see /ho" + "me/me/x"),
            ("tests/a.sh", "cd /wo" + "rk/main"),
            ("a.txt", "ht" + "tp://mirror.example/deb" + "ian bookworm"),
            ("a.txt", "https://x.example/simp" + "le/pkg"),
            ("DESIGN.md", "in ../sha" + "red/data"),
        ):
            self.assertEqual(len(words.problems_of(path, f"fine\n{line}\n")), 1, (path, line))

    def test_ordinary_lines_pass(self):
        text = "a/home/x\n/homework\nhttps://example.org/deb" + "ian-like\nthe root of it\nnetwork/main\n"
        self.assertEqual(words.problems_of("src/a.c", text), [])


class Version(unittest.TestCase):
    def test_three_places_must_agree(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / "CMakeLists.txt").write_text("project(aisle VERSION 1.2.3 LANGUAGES C)\n")
            (root / "CHANGELOG.md").write_text("# Changelog\n\n## 1.2.3 - soon\n")
            (root / "pyproject.toml").write_text('[project]\nname = "x"\nversion = "1.2.3"\n')
            self.assertEqual(version.problems_of(root), [])
            (root / "pyproject.toml").write_text('[project]\nversion = "1.2.4"\n')
            self.assertEqual(len(version.problems_of(root)), 1)
            (root / "CHANGELOG.md").write_text("# Changelog\n")
            self.assertEqual(len(version.problems_of(root)), 2)


class HeadersAlone(unittest.TestCase):
    def complaint(self, text, language, standard):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "h.h").write_text(text)
            compiler = "c++" if language == "c++" else "cc"
            return headers_alone.compile_alone(compiler, language, standard, "h.h", [folder])

    def test_a_header_that_needs_another_or_has_no_guard_fails(self):
        self.assertTrue(self.complaint("uint8_t x(void);\n", "c", "c99"))
        self.assertTrue(self.complaint("struct a { int x; };\n", "c", "c99"))
        self.assertTrue(self.complaint("#ifndef H\n#define H\nstruct a { struct { int x; }; };\n#endif\n", "c", "c99"))
        self.assertTrue(self.complaint("#ifndef H\n#define H\nint f(int class);\n#endif\n", "c++", "c++17"))

    def test_a_sound_header_passes(self):
        text = "#ifndef H\n#define H\n#include <stdint.h>\nuint8_t x(void);\n#endif\n"
        self.assertEqual(self.complaint(text, "c", "c99"), "")
        self.assertEqual(self.complaint(text, "c++", "c++17"), "")


class Programs(unittest.TestCase):
    """The gates as programs: an empty tree is no pass, a bad one has exit status 1."""

    def status(self, gate, *arguments):
        return subprocess.run([sys.executable, GATES / gate, *arguments], capture_output=True, check=False).returncode

    def test_trees(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "src" / "base").mkdir(parents=True)
            (Path(folder) / "include").mkdir()
            self.assertEqual(self.status("levels.py", folder), 1)
            source = Path(folder) / "src" / "base" / "a.c"
            source.write_text('#include "base/a.h"\n' + function_of(10))
            self.assertEqual(self.status("levels.py", folder), 0)
            self.assertEqual(self.status("functions.py", folder), 0)
            source.write_text("#include <stdlib.h>\n" + function_of(90))
            self.assertEqual(self.status("levels.py", folder), 1)
            self.assertEqual(self.status("functions.py", folder), 1)
            self.assertEqual(self.status("stack.py", folder), 1)


if __name__ == "__main__":
    unittest.main()
