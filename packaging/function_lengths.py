#!/usr/bin/env python3
"""Functions longer than a limit, longest first: "lines file:line signature".  usage: function_lengths.py LIMIT

A function begins where a brace opens after a closing parenthesis (and perhaps qualifiers or initialisers) outside of any other
function, and ends where that brace closes. Comments, strings and characters are blanked first. No compiler: macros are not expanded.
"""
import pathlib
import re
import subprocess
import sys

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


def main():
    limit = int(sys.argv[1])
    rows = []
    for name in subprocess.run(["git", "ls-files", "*.cpp", "*.h"], capture_output=True, text=True, check=True).stdout.split():
        for first, last, signature in functions(pathlib.Path(name).read_text(encoding="utf-8")):
            if last - first + 1 > limit:
                called = re.search(r"([\w:~]+)\s*\(", signature)
                rows.append((last - first + 1, f"{name}:{first} {called.group(1) if called else signature[:60]}"))
    for length, what in sorted(rows, reverse=True):
        print(length, what)


if __name__ == "__main__":
    main()
