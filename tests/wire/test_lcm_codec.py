#!/usr/bin/env python3
"""The generator tools/codegen/lcm_codec.py: what it writes for small types, and what it refuses, by file and line."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

GENERATOR = pathlib.Path(__file__).resolve().parents[2] / "tools" / "codegen" / "lcm_codec.py"


class Generated(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = pathlib.Path(self.folder.name)

    def run_on(self, *texts):
        """Runs the generator on files t0.lcm, t1.lcm... that hold the texts; returns exit code and stderr."""
        files = []
        for number, text in enumerate(texts):
            files.append(self.root / f"t{number}.lcm")
            files[-1].write_text("package aisle;\n" + text, encoding="utf-8")
        done = subprocess.run(
            [sys.executable, GENERATOR, "--header", self.root / "out/m.h", "--tables", self.root / "out/t.c", *files],
            capture_output=True, text=True, check=False)
        return done.returncode, done.stderr

    def header_of(self, *texts):
        code, error = self.run_on(*texts)
        self.assertEqual((code, error), (0, ""))
        return (self.root / "out/m.h").read_text(encoding="utf-8")

    def refused(self, text, *parts):
        code, error = self.run_on(text)
        self.assertEqual(code, 1)
        self.assertFalse((self.root / "out").exists())
        self.assertEqual(error.count("\n"), 1, error)
        for part in parts:
            self.assertIn(part, error)

    def test_array_is_as_long_as_the_constant_named_after_its_count(self):
        header = self.header_of("struct a_t { int8_t num_legs; float leg[num_legs][2]; const int8_t MAX_LEGS = 9; }")
        self.assertIn("#define AISLE_A_MAX_LEGS 9\n", header)
        self.assertIn("float leg[AISLE_A_MAX_LEGS][2];", header)

    def test_each_count_keeps_its_value_in_a_slot_of_its_own(self):
        self.header_of("struct a_t { int8_t num_b; int8_t num_c; byte b[num_b]; byte c[num_c]; byte more[num_b];"
                       " const int8_t MAX_B = 3; const int8_t MAX_C = 5; }")
        tables = (self.root / "out/t.c").read_text(encoding="utf-8")
        for name, bound, slots in (("num_b", 3, "0, AISLE_WIRE_NO_SLOT"), ("num_c", 5, "1, AISLE_WIRE_NO_SLOT"),
                                   ("b", 3, "AISLE_WIRE_NO_SLOT, 0"), ("c", 5, "AISLE_WIRE_NO_SLOT, 1"),
                                   ("more", 3, "AISLE_WIRE_NO_SLOT, 0")):
            kind = "INT8" if name.startswith("num") else "BYTE"
            self.assertIn(f'"{name}", offsetof(aisle_a_msg, {name}), 1, {bound}, AISLE_WIRE_{kind}, 0, {slots}', tables)

    def test_nested_struct_comes_first_whatever_the_order_of_files(self):
        inner, outer = "struct z_t { byte b; }", "struct a_t { z_t z[2]; }"
        for texts in ((inner, outer), (outer, inner)):
            header = self.header_of(*texts)
            self.assertLess(header.index("} aisle_z_msg;"), header.index("aisle_z_msg z[2];"))

    def test_comments_of_every_form_are_carried_over(self):
        header = self.header_of("// Above.\n/* And\n * below. */\nstruct a_t {\n  // before x\n  double x; // m\n"
                                "  boolean ok;\n  const int8_t ONE = 1, TWO = 2; // numbers\n}\n")
        for part in ("// Above.\n// And\n// below.\ntypedef", "    // before x\n    double x; // m\n",
                     "int8_t ok; // 0 or 1\n", "AISLE_A_ONE 1\n", "AISLE_A_TWO 2 // numbers\n"):
            self.assertIn(part, header)

    def test_same_input_gives_same_bytes(self):
        text = "struct a_t { int16_t num_b; int32_t b[num_b]; const int16_t MAX_B = 4; }"
        first = self.header_of(text), (self.root / "out/t.c").read_bytes()
        self.assertEqual(first, (self.header_of(text), (self.root / "out/t.c").read_bytes()))

    def test_array_without_a_bound_is_refused(self):
        self.refused("struct a_t {\n int16_t num_b;\n int32_t b[num_b];\n}", "t0.lcm:4: a_t.b:", "no bound")
        self.refused("struct a_t { int16_t n; int32_t b[n]; const int16_t MAX_N = 3; }", "no bound")

    def test_bound_that_its_count_cannot_hold_is_refused(self):
        self.refused("struct a_t { int8_t num_b; byte b[num_b]; const int16_t MAX_B = 128; }", "does not fit")
        self.refused("struct a_t { int8_t num_b; byte b[num_b]; const int16_t MAX_B = 0; }", "does not fit")

    def test_count_behind_its_array_or_not_an_integer_is_refused(self):
        for count in ("double num_b; byte b[num_b];", "byte b[num_b]; int8_t num_b;", "int64_t num_b; byte b[num_b];"):
            self.refused(f"struct a_t {{ {count} const int8_t MAX_B = 3; }}", "must be an integer declared before")

    def test_what_the_engine_cannot_do_is_refused(self):
        self.refused("struct a_t { string s; }", "unknown type string")
        self.refused("struct a_t { a_t a; }", "must not contain itself")
        self.refused("struct a_t { int8_t num_b; byte b[2][num_b]; const int8_t MAX_B = 3; }", "first dimension")
        self.refused("struct a_t { byte b[0]; }", "above 0")
        self.refused("struct a_t { byte b; byte b; }", "declared twice")
        self.refused("struct a { byte b; }", "ends in _t")

    def test_text_that_is_no_type_is_refused_with_its_line(self):
        self.refused("struct a_t {\n  byte b\n}", "t0.lcm:4:", "expected")
        self.refused("struct a_t { byte b; ", "end of file")
        self.refused("struct a_t { byte b?; }", "cannot read '?'")
        self.refused("enum e { A }", "expected package or struct")


if __name__ == "__main__":
    unittest.main()
