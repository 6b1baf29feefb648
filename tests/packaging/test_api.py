# SPDX-License-Identifier: GPL-3.0-or-later
"""The API pages are made without a complaint, and a header that would deserve one is found."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(os.environ["GLISSON_ROOT"])
PLANTED = """
/// A comment for both of these: one line, no empty line between them.
int first(int a);
int second(int a);

struct Bare {
  int plain = 0;
};

/// Of <words> that are no tags, and of a @ref nowhere.
int third(int a);

enum class Naked { One };
"""


@unittest.skipUnless(shutil.which("doxygen"), "doxygen is not installed")
class Api(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def make(self, root):
        return subprocess.run([root / "packaging/api", self.folder / "pages"], capture_output=True, text=True)

    def test_pages_are_made_without_a_complaint(self):
        done = self.make(ROOT)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        pages = self.folder / "pages/html"
        mesh = (pages / "classglisson_1_1mechanics_1_1VoxelMesh.html").read_text(encoding="utf-8")
        self.assertIn("The nodes (corners) of the non-empty cells", mesh)
        # A declaration below another without an empty line has the comment of that one.
        loads = (pages / "namespaceglisson_1_1mechanics.html").read_text(encoding="utf-8")
        self.assertGreaterEqual(loads.count("Outward unit normal, area (m²), centre"), 4)
        self.assertIn("room_mechanics.html", (pages / "index.html").read_text(encoding="utf-8"))
        self.assertFalse(list(pages.glob("*detail*")), "a room's own header is published")

    def test_what_deserves_a_complaint_is_found(self):
        copy = self.folder / "clone"
        shutil.copytree(ROOT / "core", copy / "core")
        (copy / "packaging").mkdir()
        shutil.copy(ROOT / "packaging/api", copy / "packaging")
        shutil.copy(ROOT / "CMakeLists.txt", copy)
        (copy / "core/roi/planted.h").write_text(f"#pragma once\nnamespace glisson::roi {{\n{PLANTED}\n}}  // namespace glisson::roi\n",
                                                 encoding="utf-8")
        done = self.make(copy)
        self.assertEqual(done.returncode, 1)
        for line, word in ((8, "Bare"), (12, "nowhere"), (15, "Naked")):
            self.assertRegex(done.stderr, rf"core/roi/planted\.h:{line}: .*{word}")
        for quiet in ("first", "second", "plain", "words"):
            self.assertNotIn(quiet, done.stderr)


if __name__ == "__main__":
    unittest.main()
