# SPDX-License-Identifier: GPL-3.0-or-later
"""Manual pages and bash completion come from the program's own options: complete, and free of faults."""
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from support import CLI, folder_of_class


def help_of(*verb):
    return subprocess.run([CLI, *verb, "--help"], capture_output=True, text=True, check=True).stdout


def options_in(text):
    return set(re.findall(r"^  (?:-\w,)?(--[a-z][a-z-]*)", text, re.M))


def verbs():
    return re.findall(r"^  ([a-z]+) ", help_of().split("Subcommands:")[1], re.M)


class Documents(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = folder_of_class(cls)
        subprocess.run([CLI, "document", "--output", cls.folder, "--quiet"], check=True, capture_output=True)

    def complete(self, *words):
        """What the Tab key offers after the words; the last is being written."""
        script = 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($#-1)); _glisson_cli; printf "%s\\n" "${COMPREPLY[@]}"'
        done = subprocess.run(["bash", "--norc", "-c", script, "bash", self.folder / "glisson-cli.bash", "glisson-cli", *words],
                              capture_output=True, text=True, cwd=self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return [line for line in done.stdout.splitlines() if line]

    def test_a_page_for_every_verb_with_every_option(self):
        self.assertGreater(len(verbs()), 15)
        for verb in verbs():
            with self.subTest(verb=verb):
                page = (self.folder / f"glisson-cli-{verb}.1").read_text().replace("\\-", "-")
                for option in options_in(help_of(verb)):
                    self.assertIn(f"\\fB{option}\\fR", page)
        self.assertIn("\\fB--output\\fR", (self.folder / "glisson-cli.1").read_text().replace("\\-", "-"))

    def test_man_reads_them_without_a_warning(self):
        if not shutil.which("man") or not shutil.which("groff"):
            self.skipTest("man is not installed")
        for page in sorted(self.folder.glob("*.1")):
            done = subprocess.run(["man", "--warnings", "--local-file", page], capture_output=True, text=True,
                                  env={**os.environ, "MANWIDTH": "80", "LC_ALL": "C.UTF-8"})
            self.assertEqual((done.returncode, done.stderr), (0, ""), page.name)
            self.assertIn("SYNOPSIS", done.stdout)

    def test_the_same_bytes_again(self):
        with tempfile.TemporaryDirectory() as again:
            subprocess.run([CLI, "document", "--output", again, "--quiet", "--threads", "1"], check=True, capture_output=True)
            written = sorted(pathlib.Path(again).iterdir())
            self.assertGreater(len(written), 15)
            for file in written:
                self.assertEqual(file.read_bytes(), (self.folder / file.name).read_bytes(), file.name)

    def test_completion_offers_verbs_options_and_values(self):
        self.assertEqual(set(self.complete("")), set(verbs()))
        self.assertEqual(self.complete("me"), ["measure"])
        for verb in ("run", "measure", "phantom"):
            self.assertLessEqual(options_in(help_of(verb)), set(self.complete(verb, "--")))
        self.assertIn("--output", self.complete("run", "--out"))
        self.assertEqual(self.complete("measure", "--quantity", ""), ["shear", "youngs"])
        self.assertEqual(self.complete("--quiet", "validate", "con"), ["contact"])
        self.assertEqual(set(self.complete("pacs", "")), {"echo", "find", "get", "receive", "send"})
        self.assertIn("--study-date", self.complete("pacs", "find", "--stu"))

    def test_completion_of_paths(self):
        (self.folder / "a folder").mkdir(exist_ok=True)
        (self.folder / "a file.json").touch()
        self.assertEqual(set(self.complete("run", "a")), {"a folder", "a file.json"})
        self.assertEqual(self.complete("scan", "--thumbnails", "a"), ["a folder"])


if __name__ == "__main__":
    unittest.main()
