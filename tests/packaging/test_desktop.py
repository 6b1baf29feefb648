# SPDX-License-Identifier: GPL-3.0-or-later
"""What desktops read is valid by their own tools, and says the same everywhere."""
import configparser
import re
import shutil
import subprocess
import unittest
import xml.etree.ElementTree

from support import ROOT

DESKTOP = ROOT / "resources/desktop"
NAMESPACE = "{http://www.freedesktop.org/standards/shared-mime-info}"


class Desktop(unittest.TestCase):
    def valid(self, tool, *arguments):
        if not shutil.which(tool):
            self.skipTest(f"{tool} is not installed")
        done = subprocess.run([tool, *map(str, arguments)], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def test_desktop_entry(self):
        said = self.valid("desktop-file-validate", DESKTOP / "glisson.desktop")
        self.assertNotIn("error", said)

    def test_appstream(self):
        self.valid("appstreamcli", "validate", "--no-net", DESKTOP / "org.glisson.Glisson.metainfo.xml")

    def test_the_mime_type_is_the_same_everywhere(self):
        mime = xml.etree.ElementTree.parse(DESKTOP / "glisson-case.xml").getroot()
        types = [t.get("type") for t in mime.iter(NAMESPACE + "mime-type")]
        self.assertEqual(len(types), 1)
        entry = configparser.ConfigParser(interpolation=None)
        entry.read(DESKTOP / "glisson.desktop", encoding="utf-8")
        self.assertIn(types[0], entry["Desktop Entry"]["MimeType"].split(";"))
        metainfo = xml.etree.ElementTree.parse(DESKTOP / "org.glisson.Glisson.metainfo.xml").getroot()
        self.assertEqual([m.text for m in metainfo.iter("mediatype")], types)
        self.assertEqual(metainfo.findtext("launchable"), "glisson.desktop")

    def test_the_release_is_the_one_of_the_build(self):
        version = re.search(r"project\(Glisson VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
        metainfo = xml.etree.ElementTree.parse(DESKTOP / "org.glisson.Glisson.metainfo.xml").getroot()
        self.assertEqual(metainfo.find("releases")[0].get("version"), version)


if __name__ == "__main__":
    unittest.main()
