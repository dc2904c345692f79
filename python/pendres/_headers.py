"""Declarations for cffi, read from the library's public headers.

There is no second copy of any structure, constant or signature: what C programs include is what
Python reads. The headers are plain C with a few macros, which are expanded here, so that no
compiler is needed.
"""
import functools
import os
import re

MACRO = re.compile(r"#define\s+(\w+)(\(([^)]*)\))?[ \t]*(.*)")


def folder_text(folder):
    """All headers of a folder, in the order in which pendres.h includes them."""
    with open(os.path.join(folder, "pendres.h"), encoding="utf-8") as umbrella:
        names = re.findall(r"#include\s+<pendres/(\w+\.h)>", umbrella.read())
    parts = []
    for name in _with_dependencies(folder, names):
        with open(os.path.join(folder, name), encoding="utf-8") as header:
            parts.append(header.read())
    return "\n".join(parts)


def _with_dependencies(folder, names, seen=None):
    """Headers, each after those that it includes itself."""
    seen = [] if seen is None else seen
    for name in names:
        if name in seen:
            continue
        with open(os.path.join(folder, name), encoding="utf-8") as header:
            own = re.findall(r"#include\s+<pendres/(\w+\.h)>", header.read())
        _with_dependencies(folder, [other for other in own if other != name], seen)
        if name not in seen:
            seen.append(name)
    return seen


def _without_comments(text):
    return re.sub(r"/\*.*?\*/|//[^\n]*", " ", text, flags=re.S)


class Declarations:
    """What the headers' text declares: for cffi, and words for people."""

    def __init__(self, text):
        self.constants = {}  # of #define NAME VALUE: numbers and strings
        self._text = text
        self.types, self.calls = "", {}  # the latter {function: its prototype}
        for statement in self._statements(self._expand(_without_comments(text))):
            head = re.match(r"[^{]*?\b(pendres_\w+)\s*\([^{]*\)\s*$", statement)
            if head and not re.search(r"\btypedef\b", statement):
                self.calls[head.group(1)] = statement + ";\n"
            else:
                self.types += statement + (";\n" if statement.strip() else "")

    @functools.cached_property
    def functions(self):
        """{name: (which parameters are const, declaration, words)} of every public function."""
        return self._functions(self._text)

    def _expand(self, text):
        """The text without directives, with macros expanded and bodies of functions removed."""
        lines, macros, skipped, depth = [], {}, None, 0
        for line in text.replace("\\\n", " ").split("\n"):
            directive = line.strip()
            if directive.startswith("#if"):
                depth += 1
                if skipped is None and "__cplusplus" in directive and "!" not in directive:
                    skipped = depth
            elif directive.startswith("#endif"):
                skipped = None if skipped == depth else skipped
                depth -= 1
            elif directive.startswith("#el") and skipped == depth:
                skipped = None
            elif skipped is None and directive.startswith("#define"):
                self._define(directive, macros)
            elif skipped is None and not directive.startswith("#"):
                lines.append(_apply(line, macros))
        return _without_bodies("\n".join(lines))

    def _define(self, directive, macros):
        name, arguments, parameters, body = MACRO.match(directive).groups()
        if arguments:
            macros[name] = ([p.strip() for p in parameters.split(",")], body)
        elif body.startswith('"'):
            self.constants[name] = body.strip().strip('"')
        elif re.fullmatch(r"[-+]?(0x)?[0-9a-fA-F]+[uUlL]*", body.strip()):
            self.constants[name] = int(body.strip().rstrip("uUlL"), 0)

    def _functions(self, text):
        found = {}
        doc = re.compile(r"/\*\*(.*?)\*/", re.S)
        plain = re.sub(r"/\*(?!\*).*?\*/", " ", text, flags=re.S)
        comments = doc.findall(plain)
        marked = doc.sub(" @ ", plain)
        statements, number = self._statements(marked), 0
        for statement in statements:
            marks = statement.count("@")
            words = comments[number + marks - 1] if statement.lstrip().startswith("@") else ""
            number += marks
            head = re.search(r"\b(pendres_\w+)\s*\((.*)\)\s*$", statement, re.S)
            if not head or "{" in statement or re.search(r"\btypedef\b|\bstatic\b", statement):
                continue
            declaration = " ".join(statement.replace("@", " ").split())
            constant = ["const" in part.split("*")[0] for part in _split(head.group(2))]
            found[head.group(1)] = (constant, declaration, _plain_words(words))
        return found

    @staticmethod
    def _statements(text):
        """Statements outside of braces: those with braces as a whole, without directives."""
        text = re.sub(r"#ifdef __cplusplus.*?#endif", " ", text.replace("\\\n", " "), flags=re.S)
        text = re.sub(r"^[ \t]*#.*$", " ", text, flags=re.M)
        statements, depth, start = [], 0, 0
        for sign in re.finditer("[{};]", text):
            letter = sign.group()
            depth += (letter == "{") - (letter == "}" and depth > 0)
            if letter == ";" and depth == 0:
                statements.append(text[start:sign.start()])
                start = sign.end()
        return statements + [text[start:]]


def _apply(line, macros):
    """Expand macros with arguments in a line, again and again until there are none."""
    for _ in range(100):
        call = next((m for m in re.finditer(r"\b(\w+)\s*\(([^()]*(?:\([^()]*\)[^()]*)*)\)", line)
                     if m.group(1) in macros), None)
        if not call:
            return line
        parameters, body = macros[call.group(1)]
        for name, value in zip(parameters, _split(call.group(2))):
            body = re.sub(rf"\b{name}\b", lambda _m, value=value: value.strip(), body)
        line = line[:call.start()] + re.sub(r"\s*##\s*", "", body) + line[call.end():]
    raise ValueError(f"a macro that expands without end: {line}")


def _split(arguments):
    """Arguments apart at the commas outside of parentheses and strings."""
    parts, depth, quoted, last = [], 0, False, 0
    for i, letter in enumerate(arguments):
        quoted ^= letter == '"'
        if not quoted:
            depth += (letter == "(") - (letter == ")")
            if letter == "," and depth == 0:
                parts.append(arguments[last:i])
                last = i + 1
    return parts + [arguments[last:]]


def _without_bodies(text):
    """Without functions that are defined in a header."""
    while True:
        start = re.search(r"\bstatic\b[^;{}]*\)\s*\{", text)
        if not start:
            return text
        depth, end = 1, start.end()
        while depth:
            depth += (text[end] == "{") - (text[end] == "}")
            end += 1
        text = text[:start.start()] + text[end:]


def _plain_words(comment):
    lines = [re.sub(r"^\s*\*?\s?", "", line).rstrip() for line in comment.split("\n")]
    return "\n".join(lines).strip()
