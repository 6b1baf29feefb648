#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every text of the window has its German: what lupdate finds in the sources, the table of keys and gestures, the names
of undo steps, what the outline tools say, and the line about research use, against the catalogue.

usage: check_translations.py ROOT LUPDATE    prints what is missing, exits 1 where anything is
       check_translations.py --self-test ROOT LUPDATE    takes one translation of each kind away and checks that it is missed
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

STRING = r'"((?:[^"\\]|\\.)*)"'
NUMBER = re.compile(r"%L?\d+|\{\w+\}")


def table_texts(root):
    """Texts of the key table: groups, what a key does, and gestures; ids and keys are not shown in words."""
    source = (root / "ui/tools/keymap.cpp").read_text(encoding="utf-8")
    texts = set(re.findall(r"constexpr const char\* \w+ = " + STRING, source))
    texts.update(row[2] for row in re.findall(r"\{C::\w+,\s*" + STRING + r",\s*" + STRING + r",\s*\w+,\s*" + STRING,
                                              source))
    for rows in re.findall(r"(?:gesture|scene)Rows = \{\{(.*?)\}\};", source, re.S):
        texts.update(t for t in re.findall(STRING, rows) if t)
    return {t.replace('\\"', '"') for t in texts}


def command_texts(root):
    """Names of undo steps: "Undo move vertices"."""
    texts = set()
    for path in sorted((root / "ui/commands").glob("*.h")):
        for body in re.findall(r"text\(\) const override \{(.*?)\}", path.read_text(encoding="utf-8"), re.S):
            texts.update(re.findall(STRING, body))
    for name in ("ui/session/act_command.h", "ui/session/session_outlines.cpp", "ui/session/session_slices.cpp",
                 "ui/session/session_case.cpp"):
        source = (root / name).read_text(encoding="utf-8")
        texts.update(re.findall(r'\? "([a-z][a-z ]+)"', source))
        texts.update(re.findall(r': "([a-z][a-z ]+)";', source))
        texts.update(re.findall(r'replaceContours\([^;]*, "([a-z ]+)"\)', source))
        texts.update(re.findall(r'paste\([^;]*, "([a-z ]+)"\)', source))
    return texts


def sentences(root):
    """What the outline tools say in the status line."""
    source = (root / "ui/tools/sentences.h").read_text(encoding="utf-8")
    return set(re.findall(r"constexpr const char\* \w+ =\s*" + STRING + ";", source))


def diagnostic_texts(root):
    """What core says of inputs and results, by code."""
    source = (root / "core/base/diagnostics.def").read_text(encoding="utf-8")
    rows = re.findall(r"^GLISSON_DIAGNOSTIC\(\w+,\s*" + STRING + r",\s*\w+,\s*((?:" + STRING.replace("(", "(?:", 1) +
                      r"\s*)+)\)", source, re.M)
    return {"".join(re.findall(STRING, text)).replace('\\"', '"') for _, text in rows}


def window_texts(root):
    """The one text of the window that is a constant of the whole program."""
    source = (root / "core/base/version.h").read_text(encoding="utf-8")
    return set(re.findall(r"constexpr const char\* researchUseOnly =\s*" + STRING + ";", source))


def catalogue(path):
    """(context, source) -> translation, finished ones only; and the texts of unfinished ones."""
    finished, unfinished = {}, []
    for context in xml.parse(path).getroot().iter("context"):
        for message in context.iter("message"):
            source, translation = message.findtext("source"), message.find("translation")
            if translation.get("type") in ("obsolete", "vanished"):
                continue
            forms = [f.text or "" for f in translation.iter("numerusform")] or [translation.text or ""]
            if translation.get("type") == "unfinished" or not all(forms):
                unfinished.append((context.findtext("name"), source))
            else:
                finished[context.findtext("name"), source] = forms
    return finished, unfinished


def missing(root, lupdate, german):
    finished, _ = catalogue(german)
    found = []
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder) / "glisson_de.ts"
        shutil.copy(german, copy)
        subprocess.run([lupdate, "-silent", "-no-obsolete", "-disable-heuristic", "sametext", str(root / "ui"),
                        str(root / "app" / "glisson"), "-ts", str(copy)], check=True)
        found += [f"{context}: {text}" for context, text in catalogue(copy)[1]]
    # These are looked up by name, so that lupdate does not see them.
    for context, texts, least in (("keymap", table_texts(root), 8), ("commands", command_texts(root), 8),
                                  ("tools", sentences(root), 8), ("diagnostics", diagnostic_texts(root), 100),
                                  ("glisson::panels::MainWindow", window_texts(root), 1)):
        if len(texts) < least:
            found.append(f"{context}: the sources were not understood; has the table another form?")
        found += [f"{context}: {t}" for t in sorted(texts) if (context, t) not in finished]
    # A number or name that gets lost on the way.
    for (context, source), forms in finished.items():
        for form in forms:
            if set(NUMBER.findall(source)) != set(NUMBER.findall(form)):
                found.append(f"{context}: {source}: other place holders in the translation")
    return found


def main(arguments):
    self_test = arguments[:1] == ["--self-test"]
    root, lupdate = pathlib.Path(arguments[-2]), arguments[-1]
    german = root / "resources" / "translations" / "glisson_de.ts"
    if not self_test:
        found = missing(root, lupdate, german)
        print("\n".join(found) or "every text has its German")
        return 1 if found else 0
    text = german.read_text(encoding="utf-8")
    for context in ("glisson::panels::ComparePage", "keymap", "commands", "tools", "diagnostics"):
        start = text.index(f"<name>{context}</name>")
        source = re.search(r"<source>(.*?)</source>\s*<translation>[^<]+</translation>", text[start:], re.S)
        with tempfile.TemporaryDirectory() as folder:
            damaged = pathlib.Path(folder) / "glisson_de.ts"
            damaged.write_text(text[:start] + text[start:].replace(source.group(0), f"<source>{source.group(1)}</source>"
                               '<translation type="unfinished"></translation>', 1), encoding="utf-8")
            if not any(line.startswith(context) for line in missing(root, lupdate, damaged)):
                print(f"a text of {context} without German was not missed")
                return 1
    print("what is taken away is missed")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
