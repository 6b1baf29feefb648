# SPDX-License-Identifier: GPL-3.0-or-later
"""The forges' workflow files: well formed, and they call programs of this repository that are there."""
import os
import re
import subprocess
import unittest

from support import ROOT

FILES = (ROOT / ".github/workflows/checks.yml", ROOT / ".gitlab-ci.yml")
SCRIPTS = (".ci/run", "packaging/deb", "packaging/check-packages", "packaging/install", "packaging/run", "packaging/test",
           "packaging/tree", "packaging/check")


class Workflows(unittest.TestCase):
    def test_they_are_yaml(self):
        try:
            import yaml
        except ImportError:
            self.skipTest("python3-yaml is not installed")
        for file in FILES:
            self.assertIsInstance(yaml.safe_load(file.read_text()), dict, file.name)

    def test_they_run_the_tests_build_the_packages_and_attach_them_to_a_tag(self):
        for file in FILES:
            text = file.read_text()
            called = set(re.findall(r"(?<![\w/])(\.ci/run|packaging/[\w-]+)\b", text))
            with self.subTest(file=file.name):
                self.assertLessEqual({".ci/run", "packaging/check", "packaging/deb", "packaging/check-packages", "packaging/tree"}, called)
                self.assertLessEqual(called, set(SCRIPTS))
                self.assertRegex(text, r"\.deb")
                self.assertRegex(text, r"\.tar\.gz")
                self.assertRegex(text, r"(?i)tag")

    def test_the_scripts_can_be_run_and_are_bash(self):
        for script in SCRIPTS:
            path = ROOT / script
            self.assertTrue(os.access(path, os.X_OK), script)
            subprocess.run(["bash", "-n", path], check=True)

    def test_the_list_of_packages_holds_every_tool_that_is_called(self):
        listed = {line.strip() for line in (ROOT / "packaging/debian-packages.txt").read_text().splitlines()}
        for tool in ("lintian", "mmdebstrap", "desktop-file-utils", "appstream", "help2man", "dpkg-dev", "man-db"):
            self.assertIn(tool, listed)


if __name__ == "__main__":
    unittest.main()
