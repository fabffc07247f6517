#!/usr/bin/env python3
"""Bounded C structs and field tables from LCM type files.

    lcm_codec.py --header OUT/aisle/messages.h --tables OUT/wire/tables.c lcmtypes/*.lcm

lcm-gen's own C decoders allocate whatever a count on the wire says. Ours decode into fixed structs: every
variable array is as long as its bound, and one engine (src/wire/codec.c) walks the tables written here.

Rules beyond the LCM language:
  * `type name[num_things]` needs `const intN_t MAX_THINGS` in the same struct: the bound of the array.
  * One variable dimension per array, the first one. No strings, no enums, no named constants as dimensions.
  * Structs may nest (no cycles); a comment before a struct or member, or behind one, goes into the header.
Anything else is an error that names file and line. Standard library only; same input, same bytes out.
"""

import argparse
import dataclasses
import pathlib
import re
import sys
from typing import NoReturn

# LCM type -> (C type, table kind, bytes on the wire)
PRIMITIVES = {
    "int8_t": ("int8_t", "INT8", 1),
    "int16_t": ("int16_t", "INT16", 2),
    "int32_t": ("int32_t", "INT32", 4),
    "int64_t": ("int64_t", "INT64", 8),
    "byte": ("uint8_t", "BYTE", 1),
    "boolean": ("int8_t", "BOOLEAN", 1),
    "float": ("float", "FLOAT", 4),
    "double": ("double", "DOUBLE", 8),
}
COUNT_TYPES = {"int8_t": 0x7F, "int16_t": 0x7FFF, "int32_t": 0x7FFFFFFF}
TOKEN = re.compile(r"(?P<comment>//[^\n]*|/\*.*?\*/)|(?P<word>[A-Za-z_][\w.]*)|(?P<number>[-+]?[\d.][\w.]*)"
                   r"|(?P<sign>[{}\[\];,=])|(?P<space>\s+)", re.DOTALL)


class SourceError(Exception):
    """What is wrong with an .lcm file, as file:line: text."""


@dataclasses.dataclass
class Token:
    kind: str
    text: str
    line: int


@dataclasses.dataclass
class Constant:
    type: str
    name: str
    value: str
    before: list
    behind: str = ""


@dataclasses.dataclass
class Member:
    type: str
    name: str
    dims: list  # as written, outermost first
    line: int
    before: list
    behind: str = ""
    bound: int = 0  # a count: the largest value; a variable array: its rows
    bound_name: str = ""
    slot: int = -1  # of a count: where the engine keeps its value
    rows_slot: int = -1  # of a variable array: the slot of its count

    @property
    def each(self) -> int:
        """Elements per row of a variable array, or in all."""
        product = 1
        for dim in self.dims:
            product *= int(dim) if dim.isdigit() else 1
        return product


@dataclasses.dataclass
class Struct:
    path: pathlib.Path
    name: str  # as in the file: path_t
    before: list
    members: list = dataclasses.field(default_factory=list)
    constants: list = dataclasses.field(default_factory=list)

    @property
    def short(self) -> str:
        return self.name[:-2]

    @property
    def c_name(self) -> str:
        return f"aisle_{self.short}_msg"

    @property
    def prefix(self) -> str:
        return f"AISLE_{self.short.upper()}_"


# ---- reading


class Parser:
    """Recursive descent over one file; keeps comments, which lcm-gen drops."""

    def __init__(self, path: pathlib.Path):
        self.path = path
        self.tokens = list(self.scan(path.read_text(encoding="utf-8")))
        self.at = 0
        self.comments: list = []  # seen since the last taken word, each (line, text)

    def fail(self, line: int, text: str) -> NoReturn:
        raise SourceError(f"{self.path}:{line}: {text}")

    def scan(self, text: str):
        at, line = 0, 1
        while at < len(text):
            match = TOKEN.match(text, at)
            if match is None:
                self.fail(line, f"cannot read {text[at]!r}")
            if match.lastgroup != "space":
                yield Token(match.lastgroup, match.group(), line)
            line += match.group().count("\n")
            at = match.end()
        yield Token("end", "end of file", line)

    def peek(self) -> Token:
        while self.tokens[self.at].kind == "comment":
            token = self.tokens[self.at]
            self.comments.append((token.line, plain(token.text)))
            self.at += 1
        return self.tokens[self.at]

    def take(self, *wanted: str) -> Token:
        token = self.peek()
        if token.text not in wanted and token.kind not in wanted:
            self.fail(token.line, f"expected {' or '.join(wanted)}, found {token.text!r}")
        self.at += 1
        return token

    def comments_before(self) -> list:
        self.peek()
        lines = [text for _, texts in self.comments for text in texts]
        self.comments = []
        return lines

    def comment_behind(self) -> str:
        """The comment on the line just finished, if there is one."""
        line = self.tokens[self.at - 1].line
        self.peek()
        behind = [text for at, texts in self.comments if at == line for text in texts]
        self.comments = [comment for comment in self.comments if comment[0] != line]
        return " ".join(behind)

    def file(self) -> list:
        structs = []
        while self.peek().kind != "end":
            before = self.comments_before()
            if self.take("package", "struct").text == "package":
                if self.take("word").text != "aisle":
                    self.fail(self.tokens[self.at - 1].line, "the package is aisle")
                self.take(";")
                self.comment_behind()
            else:
                structs.append(self.struct(before))
        return structs

    def struct(self, before: list) -> Struct:
        name = self.take("word")
        if not name.text.endswith("_t"):
            self.fail(name.line, "a struct's name ends in _t")
        struct = Struct(self.path, name.text, before)
        self.take("{")
        self.comment_behind()
        while self.peek().text != "}":
            before = self.comments_before()
            type_name = self.take("word")
            if type_name.text == "const":
                struct.constants += self.constants(before)
            else:
                struct.members += self.declared(type_name, before)
        self.take("}")
        self.comments = []
        return struct

    def constants(self, before: list) -> list:
        type_name = self.take("word").text
        found = []
        while True:
            name = self.take("word").text
            self.take("=")
            found.append(Constant(type_name, name, self.take("number").text, before))
            if self.take(",", ";").text == ";":
                break
        found[-1].behind = self.comment_behind()
        return found

    def declared(self, type_name: Token, before: list) -> list:
        found = []
        while True:
            name = self.take("word")
            member = Member(type_name.text.removeprefix("aisle."), name.text, [], name.line, before)
            while self.peek().text == "[":
                self.take("[")
                member.dims.append(self.take("word", "number").text)
                self.take("]")
            found.append(member)
            before = []
            if self.take(",", ";").text == ";":
                break
        found[-1].behind = self.comment_behind()
        return found


def plain(comment: str) -> list:
    """The lines of a comment without its marks."""
    body = comment[2:] if comment.startswith("//") else comment[2:-2]
    return [line.strip(" \t*") if comment.startswith("/*") else line.strip() for line in body.split("\n")]


# ---- checking


class Types:
    """All structs of a run: nested ones before those that hold them, counts bound to arrays."""

    def __init__(self, structs: list):
        self.by_name = {struct.name: struct for struct in structs}
        if len(self.by_name) != len(structs):
            raise SourceError("a struct is defined twice")
        self.enum = sorted(self.by_name, key=lambda name: name[:-2])  # the numbering of aisle_msg_type
        self.order: list = []
        for name in self.enum:
            self.place(self.by_name[name], [])
        for struct in self.order:
            bind_counts(struct)

    def fail(self, struct: Struct, member: Member, text: str) -> NoReturn:
        raise SourceError(f"{struct.path}:{member.line}: {struct.name}.{member.name}: {text}")

    def place(self, struct: Struct, above: list) -> None:
        if struct in self.order:
            return
        for member in struct.members:
            if member.type in PRIMITIVES:
                continue
            if member.type not in self.by_name:
                self.fail(struct, member, f"unknown type {member.type}")
            if member.type in above + [struct.name]:
                self.fail(struct, member, "a struct must not contain itself")
            self.place(self.by_name[member.type], above + [struct.name])
        self.order.append(struct)

    def depth(self, struct: Struct) -> int:
        """Levels of structs, 1 for one without nested ones."""
        return 1 + max((self.depth(self.by_name[m.type]) for m in struct.members if m.type in self.by_name), default=0)

    def size(self, struct: Struct, largest: bool) -> int:
        """Encoded bytes without fingerprint when all counts are 0 or at their bound."""
        total = 0
        for member in struct.members:
            rows = 1 if member.rows_slot < 0 else member.bound if largest else 0
            nested = self.by_name.get(member.type)
            element = self.size(nested, largest) if nested else PRIMITIVES[member.type][2]
            total += rows * member.each * element
        return total

    def fingerprint(self, struct: Struct) -> int:
        """As lcm-gen: the struct's own hash plus those of the structs it holds, rotated by one."""
        total = own_hash(struct)
        for member in struct.members:
            if member.type in self.by_name:
                total += self.fingerprint(self.by_name[member.type])
        total &= MASK
        return ((total << 1) & MASK) + (total >> 63)


def bind_counts(struct: Struct) -> None:
    """Finds the count and the bound of every variable array."""
    slots: dict = {}
    limits = {constant.name: constant for constant in struct.constants if constant.name.startswith("MAX_")}
    seen: dict = {}
    for member in struct.members:
        where = f"{struct.path}:{member.line}: {struct.name}.{member.name}"
        if member.name in seen:
            raise SourceError(f"{where}: declared twice")
        if any(not dim.isdigit() for dim in member.dims[1:]) or any(dim.isdigit() and int(dim) < 1 for dim in member.dims):
            raise SourceError(f"{where}: only the first dimension may vary, and the others are numbers above 0")
        if member.dims and not member.dims[0].isdigit():
            count = seen.get(member.dims[0])
            if count is None or count.type not in COUNT_TYPES or count.dims:
                raise SourceError(f"{where}: its count {member.dims[0]} must be an integer declared before it")
            limit = limits.get("MAX_" + count.name.removeprefix("num_").upper())
            if limit is None or not count.name.startswith("num_"):
                raise SourceError(f"{where}: no bound: the struct needs a constant MAX_... named after num_...")
            if not 1 <= int(limit.value) <= COUNT_TYPES[count.type]:
                raise SourceError(f"{where}: {limit.name} does not fit its count")
            count.bound = member.bound = int(limit.value)
            member.bound_name = struct.prefix + limit.name
            count.slot = member.rows_slot = slots.setdefault(count.name, len(slots))
        seen[member.name] = member


MASK = (1 << 64) - 1


def hash_byte(value: int, byte: int) -> int:
    """One step of lcm-gen's hash; its value is signed, so the shift to the right copies the sign."""
    signed = value - (1 << 64) if value >> 63 else value
    return (((value << 8) ^ (signed >> 55)) + byte) & MASK


def hash_text(value: int, text: str) -> int:
    value = hash_byte(value, len(text))
    for char in text.encode("ascii"):
        value = hash_byte(value, char)
    return value


def own_hash(struct: Struct) -> int:
    """Hash of member names, primitive types and dimensions; names of structs and constants do not count."""
    value = 0x12345678
    for member in struct.members:
        value = hash_text(value, member.name)
        if member.type in PRIMITIVES:
            value = hash_text(value, member.type)
        value = hash_byte(value, len(member.dims))
        for dim in member.dims:
            value = hash_byte(value, 0 if dim.isdigit() else 1)
            value = hash_text(value, dim)
    return value


# ---- writing


def header(types: Types) -> str:
    out = [
        "// messages.h - every message of Aisle as a fixed C struct. Level: public. Generated from lcmtypes/*.lcm.",
        "//",
        "// Members have the names, order, types and units of the .lcm files; a variable array is as long as its bound and its",
        "// count says how many entries mean something. boolean is int8_t 0 or 1. Fields with a count out of range, or floats",
        "// that are not finite, are refused by the codec in both directions (src/wire/codec.h).",
        "#ifndef AISLE_MESSAGES_H",
        "#define AISLE_MESSAGES_H",
        "",
        "#include <stdint.h>",
        "",
        "#ifdef __cplusplus",
        'extern "C" {',
        "#endif",
        "",
        "// One per .lcm file, nested ones included.",
        "typedef enum aisle_msg_type {",
    ]
    for number, name in enumerate(types.enum):
        out.append(f"    AISLE_MSG_{name[:-2].upper()} = {number},")
    out += [f"    AISLE_MSG_COUNT = {len(types.enum)}", "} aisle_msg_type;", ""]
    for struct in types.order:
        out += header_struct(struct, types)
    return "\n".join(out + ["#ifdef __cplusplus", "}", "#endif", "#endif", ""])


def header_struct(struct: Struct, types: Types) -> list:
    out = [f"// ---- {struct.name}: {sizes_text(struct, types)}"]
    for constant in struct.constants:
        out += [f"// {line}".rstrip() for line in constant.before]
        comment = f" // {constant.behind}" if constant.behind else ""
        out.append(f"#define {struct.prefix}{constant.name} {constant.value}{comment}")
    if struct.constants:
        out.append("")
    out += [f"// {line}".rstrip() for line in struct.before]
    out.append(f"typedef struct {struct.c_name} {{")
    for member in struct.members:
        out += [f"    // {line}".rstrip() for line in member.before]
        dims = "".join(f"[{member.bound_name if not dim.isdigit() else dim}]" for dim in member.dims)
        c_type = PRIMITIVES[member.type][0] if member.type in PRIMITIVES else f"aisle_{member.type[:-2]}_msg"
        comment = member_comment(member)
        out.append(f"    {c_type} {member.name}{dims};" + (f" // {comment}" if comment else ""))
    out.append(f"}} {struct.c_name};")
    return out + [""]


def member_comment(member: Member) -> str:
    parts = [member.behind] if member.behind else []
    if member.type == "boolean":
        parts.append("0 or 1")
    if member.rows_slot >= 0:
        parts.append(f"the first {member.dims[0]} count")
    elif member.slot >= 0 and not member.behind:
        parts.append(f"0..{member.bound}")
    return "; ".join(parts)


def sizes_text(struct: Struct, types: Types) -> str:
    least, most = types.size(struct, False), types.size(struct, True)
    return f"{least} bytes encoded" if least == most else f"{least} to {most} bytes encoded"


def tables(types: Types) -> str:
    out = [
        "// tables.c - what the codec walks: the fields of every message. Generated from lcmtypes/*.lcm.",
        '#include "wire/tables.h"',
        "",
        "#include <stddef.h>",
        "",
        f"#if AISLE_WIRE_DEPTH_MAX < {max(types.depth(s) for s in types.order)}",
        '#error "AISLE_WIRE_DEPTH_MAX is too small for the message types"',
        "#endif",
        f"#if AISLE_WIRE_SLOTS_MAX < {max(slots(s) for s in types.order)}",
        '#error "AISLE_WIRE_SLOTS_MAX is too small for the message types"',
        "#endif",
        "",
    ]
    for struct in types.order:
        out.append(f"static const aisle_wire_field {struct.short}_fields[] = {{")
        out += [f"    {{{field_row(struct, member)}}}," for member in struct.members]
        out += ["};", ""]
    out.append("const aisle_wire_type aisle_wire_types[AISLE_MSG_COUNT] = {")
    for name in types.enum:
        struct = types.by_name[name]
        least, most = types.size(struct, False), types.size(struct, True)
        out.append(f'    {{"{struct.name}", {struct.short}_fields, UINT64_C(0x{types.fingerprint(struct):016x}),')
        out.append(f"     sizeof({struct.c_name}), {least}, {most}, {len(struct.members)}}},")
    return "\n".join(out + ["};", ""])


def slots(struct: Struct) -> int:
    return sum(member.slot >= 0 for member in struct.members)


def field_row(struct: Struct, member: Member) -> str:
    """In the order of aisle_wire_field: name, offset, each, bound, kind, nested, slot, rows_slot."""
    kind, nested = "STRUCT", f"AISLE_MSG_{member.type[:-2].upper()}"
    if member.type in PRIMITIVES:
        kind, nested = PRIMITIVES[member.type][1], "0"
    slot, rows = (str(s) if s >= 0 else "AISLE_WIRE_NO_SLOT" for s in (member.slot, member.rows_slot))
    return (f'"{member.name}", offsetof({struct.c_name}, {member.name}), {member.each}, {member.bound}, '
            f"AISLE_WIRE_{kind}, {nested}, {slot}, {rows}")


def write(path: pathlib.Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8", newline="\n")


def main() -> int:
    parser = argparse.ArgumentParser(description="Bounded C structs and field tables from LCM type files.")
    parser.add_argument("--header", type=pathlib.Path, required=True, help="messages.h to write")
    parser.add_argument("--tables", type=pathlib.Path, required=True, help="tables.c to write")
    parser.add_argument("files", type=pathlib.Path, nargs="+", metavar="file.lcm")
    args = parser.parse_args()
    try:
        types = Types([struct for path in sorted(args.files) for struct in Parser(path).file()])
    except (SourceError, OSError) as error:
        print(f"lcm_codec: {error}", file=sys.stderr)
        return 1
    write(args.header, header(types))
    write(args.tables, tables(types))
    return 0


if __name__ == "__main__":
    sys.exit(main())
