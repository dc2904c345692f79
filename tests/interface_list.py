"""The public interface as a list of lines: functions, constants, and structs with sizes and offsets.

    python3 tests/interface_list.py COMPILER HEADERS >LIST
    python3 tests/interface_list.py --compare OLD NEW

The first asks the compiler where the fields of every struct stand and which value each constant has.
The second tells what NEW lacks of OLD, or has otherwise: that breaks programs which were linked with
it. What NEW has beside breaks nothing. Exit code 0: equal; 1: only more; 2: broken.
"""
import os
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "python", "pendres"))
import _headers  # noqa: E402  pylint: disable=wrong-import-position


def fields_of(body):
    """Names of the fields in a struct's body, without the bodies of structs within it."""
    while True:
        plain = re.sub(r"\{[^{}]*\}", " ", body)
        if plain == body:
            break
        body = plain
    for statement in body.split(";"):
        function = re.search(r"\(\s*\*\s*(\w+)\s*\)", statement)
        if function:
            yield function.group(1)
            continue
        for part in statement.split(","):
            name = re.search(r"(\w+)\s*(\[[^\]]*\]\s*)*$", part.strip())
            if name:
                yield name.group(1)


def structs_of(text):
    """(name, names of fields) of every struct that has fields for others."""
    for start in re.finditer(r"\btypedef\s+struct\s+(\w+)\s*\{", text):
        depth, end = 1, start.end()
        while depth:
            depth += (text[end] == "{") - (text[end] == "}")
            end += 1
        yield start.group(1), list(fields_of(text[start.end():end - 1]))


def constants_of(text):
    """Names of the values of all enums, in their order."""
    for body in re.findall(r"\benum\b[^;{]*\{([^}]*)\}", text):
        for part in body.split(","):
            name = re.match(r"\s*(PENDRES_\w+)", part)
            if name:
                yield name.group(1)


def program(declared):
    """C that prints sizes, offsets and values."""
    lines = ["#include <stddef.h>", "#include <stdio.h>", "#include <pendres/pendres.h>",
             "int main(void)", "{"]
    for name, fields in structs_of(declared.types):
        lines.append(f'  printf("struct {name} %zu\\n", sizeof({name}));')
        for field in fields:
            lines.append(f'  printf("struct {name}.{field} %zu %zu\\n", offsetof({name}, {field}), '
                         f'sizeof((({name} *)0)->{field}));')
    for name in constants_of(declared.types):
        lines.append(f'  printf("value {name} %lld\\n", (long long){name});')
    return "\n".join(lines + ["  return 0;", "}", ""])


def listing(compiler, headers):
    """All lines."""
    declared = _headers.Declarations(_headers.folder_text(os.path.join(headers, "pendres")))
    lines = [f"function {declaration};" for _, declaration, _ in declared.functions.values()]
    with tempfile.TemporaryDirectory() as scratch:
        source, binary = (os.path.join(scratch, name) for name in ("list.c", "list"))
        with open(source, "w", encoding="utf-8") as out:
            out.write(program(declared))
        subprocess.run([*compiler.split(), "-std=c11", f"-I{headers}", source, "-o", binary],
                       check=True)
        answer = subprocess.run([binary], check=True, capture_output=True, text=True).stdout
    return sorted(lines) + answer.splitlines()


def compare(old, new):
    """What was and is no more, what is new; the exit code."""
    before, now = ([line for line in open(path, encoding="utf-8").read().splitlines()
                    if line and not line.startswith("#")] for path in (old, new))
    # What takes the first places of a struct's spares, which end where they did, breaks nothing.
    spares = [{line.split()[1]: sum(map(int, line.split()[2:])) for line in lines
               if re.match(r"struct \w+\.spare ", line)} for lines in (before, now)]
    kept = {name for name, end in spares[0].items() if spares[1].get(name) == end}
    gone = [line for line in before if line not in set(now) and line.split()[1] not in kept]
    come = [line for line in now if line not in set(before)]
    # The count of an enum grows with it.
    grown = {line.split()[1] for line in come if re.match(r"value \w*_COUNT ", line)}
    gone = [line for line in gone if line.split()[1] not in grown or not line.startswith("value ")]
    for words, lines in (("no more, or otherwise", gone), ("new", come)):
        for line in lines:
            print(f"  {words}: {line}")
    return 2 if gone else 1 if come else 0


if __name__ == "__main__":
    if sys.argv[1] == "--compare":
        sys.exit(compare(sys.argv[2], sys.argv[3]))
    print("\n".join(listing(sys.argv[1], sys.argv[2])))
