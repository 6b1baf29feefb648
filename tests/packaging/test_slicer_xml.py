# SPDX-License-Identifier: GPL-3.0-or-later
"""`--xml` describes verbs as 3D Slicer's ModuleDescriptionParser takes them, and what Slicer then calls is accepted."""
import os
import re
import subprocess
import unittest
import xml.etree.ElementTree

from support import CLI, ROOT

VERBS = ("measure", "invert", "propose", "run", "export")

# The rules of the execution model: what may stand where, written from its documentation and parser.
HEAD = ["category", "title", "description", "version", "documentation-url", "license", "contributor"]
PARAMETERS = {"integer", "double", "boolean", "string", "string-vector", "double-vector", "string-enumeration",
              "integer-enumeration", "point", "file", "directory", "image"}
INSIDE = {"name", "index", "longflag", "label", "description", "default", "element", "channel", "constraints"}
ATTRIBUTES = {"image": {"type": {"scalar", "label"}, "multiple": {"true", "false"}},
              "point": {"multiple": {"true", "false"}, "coordinateSystem": {"lps", "ras", "ijk"}}}
IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")


def described(verb):
    done = subprocess.run([CLI, verb, "--xml"], capture_output=True, text=True)
    assert done.returncode == 0 and not done.stderr, done.stderr
    return done.stdout


def faults(text):
    """What Slicer's parser would refuse, or a user could not fill in."""
    found = []
    if not text.startswith('<?xml version="1.0" encoding="utf-8"?>'):
        found.append("first line")
    root = xml.etree.ElementTree.fromstring(text)
    if root.tag != "executable" or [e.tag for e in root][:len(HEAD)] != HEAD:
        found.append("head")
    names = []
    for group in root[len(HEAD):]:
        if group.tag != "parameters" or [e.tag for e in group][:2] != ["label", "description"]:
            found.append(f"group {group.tag}")
        for p in group[2:]:
            name = p.findtext("name", "")
            names.append(name)
            if p.tag not in PARAMETERS:
                found.append(f"{name}: <{p.tag}>")
            if not IDENTIFIER.match(name):
                found.append(f"{name}: no identifier")
            tags = [e.tag for e in p]
            found += [f"{name}: <{t}>" for t in tags if t not in INSIDE]
            found += [f"{name}: <{t}> twice" for t in set(tags) if t != "element" and tags.count(t) > 1]
            flag, index = p.findtext("longflag"), p.findtext("index")
            if (flag is None) == (index is None):
                found.append(f"{name}: a flag or a place, and not both")
            if flag is not None and not (flag.startswith("--") and IDENTIFIER.match(flag[2:])):
                found.append(f"{name}: {flag}")
            if not p.findtext("label") or not p.findtext("description"):
                found.append(f"{name}: no label or description")
            for key, value in p.attrib.items():
                if value not in ATTRIBUTES.get(p.tag, {}).get(key, ()):
                    found.append(f"{name}: {key}={value}")
            if p.tag in ("file", "directory", "image") and p.findtext("channel") not in ("input", "output"):
                found.append(f"{name}: channel")
            if p.tag in ("integer", "double") and p.findtext("default") is None:
                found.append(f"{name}: Slicer would pass 0")
            if p.tag.endswith("enumeration") and p.findtext("default") not in [e.text for e in p.findall("element")]:
                found.append(f"{name}: default is no choice")
            for limit in p.findall("constraints/*"):
                float(limit.text)
    if len(set(names)) != len(names):
        found.append("a name twice")
    return found


def parameters(verb):
    return [p for p in xml.etree.ElementTree.fromstring(described(verb)).iterfind("parameters/*") if p.find("name") is not None]


class Descriptions(unittest.TestCase):
    def test_every_description_is_what_the_parser_takes(self):
        for verb in VERBS:
            with self.subTest(verb=verb):
                self.assertEqual(faults(described(verb)), [])

    def test_the_check_sees_faults(self):
        good = described("run")
        for old, new in (("<longflag>--uncertainty", "<longflag>--un-certain"), ("<index>0</index>", ""),
                         ("<directory>", "<folder>"), ("</directory>", "</folder>"), ('<?xml version', "\n<?xml version"),
                         ("<channel>input", "<channel>in"), ("<name>strict", "<name>threads")):
            self.assertIn(old, good)
        planted = [good.replace("<longflag>--uncertainty", "<longflag>--un-certain"),
                   good.replace("<index>0</index>", ""),
                   good.replace("<directory>", "<folder>").replace("</directory>", "</folder>"),
                   good.replace("<channel>input", "<channel>in"), good.replace("<name>strict", "<name>threads")]
        for text in planted:
            self.assertNotEqual(faults(text), [])

    def test_every_option_of_help_is_described(self):
        for verb in VERBS:
            with self.subTest(verb=verb):
                help_text = subprocess.run([CLI, verb, "--help"], capture_output=True, text=True).stdout
                options = set(re.findall(r"^  (?:-\w,)?--([a-z][a-z-]*)", help_text, re.M)) - {"help", "xml"}
                self.assertGreater(len(options), 1)
                flags = {p.findtext("longflag", "")[2:].replace("_", "-") for p in parameters(verb)}
                self.assertEqual(options - flags, set())

    def test_what_slicer_writes_for_the_defaults_is_accepted(self):
        # Slicer passes every number and choice, also the untouched ones, and texts where they are not empty.
        for verb in VERBS:
            arguments = []
            for p in parameters(verb):
                if p.tag in ("integer", "double", "string-enumeration", "integer-enumeration"):
                    arguments += [p.findtext("longflag"), p.findtext("default")]
                elif p.tag == "string" and p.findtext("default"):
                    arguments += [p.findtext("longflag"), p.findtext("default")]
            needed = {"measure": ["--mre", "absent", "--roi", "absent"], "invert": ["--phase", "absent"],
                      "propose": ["--image", "absent", "--seed", "1.5,-2,3", "--output", "absent.json"], "run": ["absent.json"],
                      "export": ["--to", "vtu", "--output", "absent", "absent.json"]}[verb]
            with self.subTest(verb=verb):
                done = subprocess.run([CLI, verb, *arguments, *needed], capture_output=True, text=True)
                # Bad input (there is no such file) and not wrong usage.
                self.assertEqual(done.returncode, 3, done.stderr)

    def test_underscores_are_dashes_in_names_only(self):
        done = subprocess.run([CLI, "measure", "--confidence_scale=-1", "--mre", "a", "--roi", "b"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("confidence-scale", done.stderr)
        done = subprocess.run([CLI, "run", "no_such_file.json"], capture_output=True, text=True)
        self.assertIn("no_such_file.json", done.stderr)

    def test_each_verb_has_its_program_for_slicer(self):
        folder = ROOT / "resources/slicer/cli-modules"
        for verb in VERBS:
            wrapper = folder / f"Glisson{verb.capitalize()}"
            done = subprocess.run([wrapper, "--xml"], capture_output=True, text=True,
                                  env={**os.environ, "GLISSON_CLI": CLI, "LD_LIBRARY_PATH": "/nowhere"})
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stdout, described(verb))


if __name__ == "__main__":
    unittest.main()
