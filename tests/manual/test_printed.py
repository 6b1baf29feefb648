# SPDX-License-Identifier: GPL-3.0-or-later
"""Commands that are printed and run by no test (in a line of text, or in a ```text block: they wait for someone, or for files of the
reader's own): the verb is there and knows the options, the script is there and can be run."""
import os
import re
import shlex
import subprocess
import unittest

from support import CLI, ROOT

DOCUMENTS = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "SECURITY.md", *sorted((ROOT / "resources").rglob("*.md")),
             *sorted((ROOT / "packaging").rglob("*.md")), *sorted((ROOT / "app").rglob("*.md")), *sorted((ROOT / "core").rglob("*.md"))]
QUOTED = re.compile(r"`+([^`]+?)`+", re.S)


def printed(text):
    """Lines of code of a document that begin with a program of ours."""
    blocks = re.findall(r"^```\w*[^\n]*\n(.*?)^```", text, re.M | re.S)
    prose = re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)
    for piece in [line for block in blocks for line in block.splitlines()] + [q.replace("\n", " ") for q in QUOTED.findall(prose)]:
        piece = piece.split("  #")[0].strip()
        if re.match(r"(\S+/)?glisson-cli\s|packaging/\w", piece):
            yield piece


class Printed(unittest.TestCase):
    def setUp(self):
        self.helps = {}

    def help_of(self, *verbs):
        if verbs not in self.helps:
            done = subprocess.run([CLI, *verbs, "--help"], capture_output=True, text=True)
            self.helps[verbs] = done.stdout if done.returncode == 0 else ""
        return self.helps[verbs]

    def verbs_below(self, *verbs):
        part = self.help_of(*verbs).partition("Subcommands:")[2]
        return set(re.findall(r"^  ([a-z][a-z-]*)\b", part, re.M))

    def check_command(self, words):
        """What is wrong with `glisson-cli words...`, or nothing."""
        verbs = []
        while words and words[0] in self.verbs_below(*verbs):
            verbs.append(words.pop(0))
        if not verbs and words and not words[0].startswith("-") and words[0] != "VERB":
            return f"there is no verb {words[0]}"
        known = "".join(self.help_of(*verbs[:n]) for n in range(len(verbs) + 1))
        for word in words:
            option = re.match(r"--[a-z][a-z-]*", word)
            if option and not re.search(rf"(?<![\w-]){option[0]}(?![\w-])", known):
                return f"{' '.join(verbs)} has no {option[0]}"
        return None

    def check_script(self, words):
        script = ROOT / words[0]
        if not os.access(script, os.X_OK):
            # A file to read, not a command: it is there, and nothing is said of options.
            return None if script.exists() and len(words) == 1 else f"{words[0]} is not there"
        source = script.read_text(encoding="utf-8")
        return next((f"{words[0]} has no {w}" for w in words[1:] if w.startswith("--") and w not in source), None)

    def test_every_printed_command_is_one(self):
        seen, wrong = 0, []
        for document in DOCUMENTS:
            for line in printed(document.read_text(encoding="utf-8")):
                try:
                    words = shlex.split(line.split("|")[0].split(";")[0])
                except ValueError:
                    words = line.split()
                fault = self.check_script(words) if words[0].startswith("packaging/") else self.check_command(words[1:])
                seen += 1
                if fault:
                    wrong.append(f"{document.relative_to(ROOT)}: {line}: {fault}")
        self.assertEqual(wrong, [])
        self.assertGreater(seen, 100)

    def test_what_is_none_is_found(self):
        self.assertIsNotNone(self.check_command(["rum", "scene.json"]))
        self.assertIsNotNone(self.check_command(["run", "scene.json", "--outpit", "x"]))
        self.assertIsNotNone(self.check_command(["cohort", "merge", "--shart", "1/2"]))
        self.assertIsNone(self.check_command(["run", "scene.json", "--output", "x"]))
        self.assertIsNotNone(self.check_script(["packaging/dep"]))
        self.assertIsNotNone(self.check_script(["packaging/run", "--guy"]))


if __name__ == "__main__":
    unittest.main()
