#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds functions to 60 lines and files to 400: what is longer must stand in packaging/long-code-allowed.txt, and no longer than there.

usage: code_lengths.py            what breaks the rule; exit code 1 where something does
       code_lengths.py --lower    takes out of the list what is short enough by now, and lowers the rest; never raises
       code_lengths.py --list     everything that is too long, longest first
       code_lengths.py --self-test

A function begins where a brace opens after a closing parenthesis (and perhaps qualifiers or initialisers) outside of any other
function, and ends where that brace closes. Comments, strings and characters are blanked first. No compiler: macros are not expanded.
"""
import pathlib
import re
import subprocess
import sys

FUNCTION, FILE = 60, 400
ALLOWED = pathlib.Path(__file__).with_name("long-code-allowed.txt")
HEADING = """# Functions of more than 60 lines and files of more than 400: lines, file, function. This list only ever gets shorter:
# packaging/check fails where something is longer than it stands here, or stands here and need not. `packaging/code_lengths.py --lower`
# writes it anew.
"""
BLANK = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)+\'', re.S)
# What may stand before the brace of a scope that holds functions.
SCOPE = re.compile(r"\b(namespace|class|struct|union|enum|extern)\b[^;(){}]*$")


def blanked(text):
    return BLANK.sub(lambda m: re.sub(r"[^\n]", " ", m.group(0)), text)


def functions(text):
    """(first line, last line, signature) of each function."""
    text = blanked(text)
    found, scopes, line, start = [], [], 1, 0
    for at, letter in enumerate(text):
        if letter == "\n":
            line += 1
        elif letter == ";" and not any(scopes):
            start = at + 1
        elif letter == "{":
            before = text[start:at]
            inside = any(scopes)
            begins = not inside and ")" in before and not SCOPE.search(before)
            scopes.append((line, " ".join(before.split())) if begins else (True if inside else None))
            if not inside:
                start = at + 1
        elif letter == "}" and scopes:
            scope = scopes.pop()
            if isinstance(scope, tuple):
                found.append((scope[0], line, scope[1]))
            if not any(scopes):
                start = at + 1
    return found


def named(signature):
    """What a function is called in the list: its name, of a test its suite and name."""
    test = re.search(r"\b(?:TEST|TEST_F|TEST_P)\s*\(\s*(\w+)\s*,\s*(\w+)", signature)
    if test:
        return f"{test.group(1)}.{test.group(2)}"
    called = re.search(r"([\w:~]+)\s*\(", signature)
    return called.group(1) if called else signature[:60].replace(" ", "_")


def too_long(name, text):
    """(file, function or "-") -> lines; of two functions of one name the longer."""
    found = {}
    # The licence and the line that parts it from a comment are nobody's choice.
    lines = re.sub(r"\A// SPDX-[^\n]*\n\n?", "", text).count("\n")
    if lines > FILE:
        found[name, "-"] = lines
    for first, last, signature in functions(text):
        if last - first + 1 > FUNCTION:
            key = name, named(signature)
            found[key] = max(found.get(key, 0), last - first + 1)
    return found


def in_tree():
    found = {}
    for name in subprocess.run(["git", "ls-files", "*.cpp", "*.h"], capture_output=True, text=True, check=True).stdout.split():
        if pathlib.Path(name).is_file():
            found.update(too_long(name, pathlib.Path(name).read_text(encoding="utf-8")))
    return found


def read(text):
    rows = (line.split() for line in text.splitlines() if line.strip() and not line.startswith("#"))
    return {(name, function): int(lines) for lines, name, function in rows}


def broken(found, allowed):
    """What breaks the rule, as lines."""
    for (name, function), lines in sorted(found.items(), key=lambda row: -row[1]):
        what = f"{name}: " + (f"{function} has {lines} lines" if function != "-" else f"{lines} lines")
        limit = FILE if function == "-" else FUNCTION
        if (name, function) not in allowed:
            yield f"{what}; {limit} are the limit: split it by what it does"
        elif lines > allowed[name, function]:
            yield f"{what}, and had {allowed[name, function]}: what is too long already must not grow"
        elif lines < allowed[name, function]:
            yield f"{what}, {allowed[name, function]} in the list: packaging/code_lengths.py --lower"
    for name, function in sorted(allowed.keys() - found.keys()):
        yield f"{name} {function}: short enough by now, and still in the list: packaging/code_lengths.py --lower"


def lowered(found, allowed):
    rows = ((min(lines, allowed[key]), *key) for key, lines in found.items() if key in allowed)
    return HEADING + "".join(f"{lines} {name} {function}\n" for lines, name, function in sorted(rows, key=lambda r: (-r[0], r[1:])))


def self_test():
    def body(lines):
        return "{\n" + "x;\n" * (lines - 2) + "}\n"
    text = "namespace n {\nint f(int a) " + body(FUNCTION) + "void C::g() const " + body(FUNCTION + 1) + "TEST(Suite, Name) " + \
        body(FUNCTION + 2) + "}\n"
    found = too_long("a.cpp", text)
    assert found == {("a.cpp", "C::g"): FUNCTION + 1, ("a.cpp", "Suite.Name"): FUNCTION + 2}, found
    assert too_long("b.cpp", "x;\n" * (FILE + 1)) == {("b.cpp", "-"): FILE + 1}
    assert too_long("c.cpp", 'const char* s = "f() {";\n' + "x;\n" * 100) == {}
    held = read("# a comment\n61 a.cpp C::g\n62 a.cpp Suite.Name\n")
    assert list(broken(found, held)) == []
    assert "must not grow" in " ".join(broken({("a.cpp", "C::g"): 70, ("a.cpp", "Suite.Name"): 62}, held))
    assert "are the limit" in " ".join(broken({**found, ("a.cpp", "h"): 61}, held))
    assert "short enough" in " ".join(broken({("a.cpp", "C::g"): 61}, held))
    assert read(lowered({("a.cpp", "C::g"): 90, ("a.cpp", "h"): 61}, held)) == {("a.cpp", "C::g"): 61}


def main():
    option = sys.argv[1] if len(sys.argv) > 1 else ""
    if option == "--self-test":
        self_test()
        return 0
    found = in_tree()
    if option == "--list":
        for (name, function), lines in sorted(found.items(), key=lambda row: -row[1]):
            print(lines, name, function)
        return 0
    allowed = read(ALLOWED.read_text(encoding="utf-8"))
    if option == "--lower":
        ALLOWED.write_text(lowered(found, allowed), encoding="utf-8")
        return 0
    lines = list(broken(found, allowed))
    print("\n".join(lines))
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
