"""What the gates know of C: comments, literals, preprocessor lines, functions. Nothing of the project's rules."""

import re
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]

TOKEN = re.compile(
    r"""(?P<comment>//(?:\\\n|[^\n])*|/\*.*?\*/)
      | (?P<string>"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')
      | (?P<word>[A-Za-z_]\w*)
      | (?P<number>\.?\d(?:[eEpP][+-]|[\w.])*)
      | (?P<newline>\n)
      | (?P<space>(?:[ \t\r\f\v]|\\\n)+)
      | (?P<punct>.)""",
    re.VERBOSE | re.DOTALL,
)


class Token(NamedTuple):
    kind: str
    text: str
    line: int


class Function(NamedTuple):
    path: str
    name: str
    line: int
    lines: int  # from the first token of its head to the closing brace, both included
    nesting: int  # deepest block, the body being 1


class SourceError(Exception):
    """A file the scanner cannot follow."""


def c_files(*folders, root=ROOT):
    """Every .c and .h below the folders, sorted."""
    found = []
    for folder in folders:
        found += [p for p in (root / folder).rglob("*") if p.suffix in (".c", ".h") and p.is_file()]
    return sorted(found)


def tokens(text):
    """Tokens of C text with their line numbers; comments and white space left out, newlines kept."""
    line = 1
    for match in TOKEN.finditer(text):
        kind, word = match.lastgroup, match.group()
        if kind == "newline" or kind not in ("comment", "space"):
            yield Token(kind, word, line)
        line += word.count("\n")


def without_comments(text):
    """The text with every comment blanked; lines and columns stay."""

    def blank(match):
        word = match.group()
        return re.sub(r"[^\n]", " ", word) if match.lastgroup == "comment" else word

    return TOKEN.sub(blank, text)


def includes(text):
    """(line, name, system) of every #include."""
    for number, line in enumerate(without_comments(text).splitlines(), 1):
        match = re.match(r'\s*#\s*include\s*(?:"([^"]*)"|<([^>]*)>)', line)
        if match:
            yield number, match.group(1) or match.group(2), match.group(2) is not None


def logical_lines(text):
    """Lists of tokens: one per preprocessor directive, all other tokens one list each."""
    directive, fresh = None, True
    for token in tokens(text):
        if token.kind == "newline":
            if directive is not None:
                yield directive
            directive, fresh = None, True
        elif directive is not None:
            directive.append(token)
        elif fresh and token.text == "#":
            directive = [token]
        else:
            fresh = False
            yield [token]
    if directive is not None:
        yield directive


class _Scanner:
    """Follows braces through one file. scopes: 'file' (extern "C"), 'function', 'block', 'data', 'type'."""

    def __init__(self, path):
        self.path = path
        self.scopes = []
        self.head = []  # tokens since the last ';' or brace at this level, whole file scope heads
        self.parens = []  # for each open '(': does a word stand before it, which
        self.closed = None  # the word before the parenthesis that closed last
        self.functions = []
        self.conditionals = []  # state of each open #if
        self.open = None  # (name, line, deepest)

    def fail(self, line, what):
        raise SourceError(f"{self.path}:{line}: {what}")

    def directive(self, line):
        words = [t.text for t in line[1:3]]
        kind = words[0] if words else ""
        if kind in ("if", "ifdef", "ifndef"):
            self.conditionals.append((list(self.scopes), list(self.head)))
        elif kind in ("else", "elif") and self.conditionals:
            self.scopes, self.head = (list(part) for part in self.conditionals[-1])
        elif kind == "endif" and self.conditionals:
            self.conditionals.pop()

    def in_function(self):
        return "function" in self.scopes

    def at_file_scope(self):
        return all(scope == "file" for scope in self.scopes)

    def kind_of_brace(self):
        head = [t.text for t in self.head]
        last = head[-1] if head else ""
        if self.scopes and self.scopes[-1] == "data":
            return "data"
        if self.at_file_scope():
            if head[:1] == ["extern"] and last.startswith('"'):
                return "file"
            if last == ")" and "=" not in head:
                return "function"
        if not self.parens and self.in_function():
            if last in ("", "else", "do", ":") or (last == ")" and self.closed not in (None, "return", "sizeof")):
                return "block"
        if any(word in ("struct", "union", "enum") for word in head[-2:]):
            return "type"
        return "data"

    def name_of_head(self):
        depth, name = 0, "?"
        for before, token in zip(self.head, self.head[1:]):
            if token.text == "(":
                if depth == 0 and before.kind == "word" and not before.text.startswith("__"):
                    name = before.text
                depth += 1
            elif token.text == ")":
                depth -= 1
        return name

    def push(self, token):
        kind = self.kind_of_brace()
        if kind == "function":
            self.open = [self.name_of_head(), self.head[0].line, 1]
        self.scopes.append(kind)
        if kind == "block":
            blocks = sum(scope in ("function", "block") for scope in self.scopes)
            self.open[2] = max(self.open[2], blocks)
        self.closed = None
        if kind in ("data", "type"):
            self.head.append(token)
        else:
            self.head, self.parens = [], []

    def pop(self, token):
        if not self.scopes:
            self.fail(token.line, "a brace closes that none opened")
        kind = self.scopes.pop()
        if kind == "function":
            name, line, deepest = self.open
            self.functions.append(Function(self.path, name, line, token.line - line + 1, deepest))
        if kind in ("data", "type"):
            self.head.append(token)
        else:
            self.head = []
        self.closed = None

    def parenthesis(self, token):
        if token.text == "(":
            before = self.head[-1] if self.head else None
            self.parens.append(before.text if before is not None and before.kind == "word" else None)
        elif self.parens:
            self.closed = self.parens.pop()

    def feed(self, token):
        if token.text == "{":
            self.push(token)
        elif token.text == "}":
            self.pop(token)
        elif token.text == ";" and not self.parens and (not self.scopes or self.scopes[-1] not in ("data", "type")):
            self.head = []
        elif token.text == ":" and self.head and self.head[0].text in ("case", "default"):
            self.head = []
        else:
            if token.text in "()":
                self.parenthesis(token)
            self.head.append(token)


def functions(path, text):
    """Every function defined in the text. SourceError if the braces cannot be followed."""
    scanner = _Scanner(str(path))
    for line in logical_lines(text):
        if line[0].text == "#":
            scanner.directive(line)
        else:
            scanner.feed(line[0])
    if scanner.scopes:
        scanner.fail(text.count("\n") + 1, "the file ends inside a brace")
    return scanner.functions


def missing_braces(text):
    """Lines where if, else, for, while, switch or do is not followed by a block (clang-format before 15 adds none)."""
    code = [t for line in logical_lines(text) if line[0].text != "#" for t in line]
    out, words = [], []  # words: for each open '(' the word before it, which '}' may precede
    for i, token in enumerate(code):
        following = code[i + 1].text if i + 1 < len(code) else ""
        if token.text in ("else", "do") and following not in ("{", "if"):
            out.append(token.line)
        elif token.text == "(":
            before = code[i - 1].text if i > 0 else ""
            words.append((before, code[i - 2].text if i > 1 else ""))
        elif token.text == ")" and words:
            word, ahead = words.pop()
            tail_of_do = word == "while" and ahead == "}" and following == ";"
            if word in ("if", "for", "while", "switch") and following != "{" and not tail_of_do:
                out.append(token.line)
    return out
