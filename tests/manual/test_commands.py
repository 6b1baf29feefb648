# SPDX-License-Identifier: GPL-3.0-or-later
"""Every command printed in the manual runs, page by page in the order of the manual, in one folder with nothing but the clone's
resources/ in it. A page may use what the tutorial made. Blocks marked `sh pacs` need a DICOM server, which is started here."""
import contextlib
import json
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

from support import CLI, ROOT
from test_pacs import ORTHANC, free_port, stop, wait_for

MANUAL = ROOT / "resources/manual"
MODULE = pathlib.Path(os.environ["GLISSON_BUILD"]) / "python/glisson"
BLOCK = re.compile(r"^```sh( pacs)?\n(.*?)^```", re.M | re.S)
# Printed port of the archive that the page about PACS speaks of.
PRINTED_PORT = "4242"


def pages():
    return [line.strip() for line in (MANUAL / "pages.txt").read_text(encoding="utf-8").splitlines() if line.strip().endswith(".md")]


def blocks(page):
    """(needs an archive, commands) of the ```sh blocks of a page; ```text blocks are not run."""
    return [(bool(kind), text) for kind, text in BLOCK.findall((MANUAL / page).read_text(encoding="utf-8"))]


@contextlib.contextmanager
def archive(folder):
    """An Orthanc on loopback; gives its port, or nothing where Orthanc is not installed."""
    if not ORTHANC.exists():
        yield None
        return
    port = free_port()
    place = pathlib.Path(folder) / "orthanc"
    place.mkdir()
    (place / "orthanc.json").write_text(json.dumps({
        "Name": "MANUAL", "StorageDirectory": str(place / "db"), "IndexDirectory": str(place / "db"), "Plugins": [],
        "HttpServerEnabled": False, "DicomServerEnabled": True, "DicomAet": "ORTHANC", "DicomPort": port,
        "DicomCheckCalledAet": True, "DicomAlwaysAllowFind": True, "DicomAlwaysAllowMove": True, "DicomAlwaysAllowGet": True}))
    server = subprocess.Popen([ORTHANC, place / "orthanc.json"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=place)
    try:
        wait_for(port, server)
        yield str(port)
    finally:
        stop(server)


class Commands(unittest.TestCase):
    def test_every_printed_command_runs(self):
        ran, done = 0, set()
        with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as elsewhere, archive(elsewhere) as port:
            folder = pathlib.Path(folder)
            os.symlink(ROOT / "resources", folder / "resources")
            bin_folder = pathlib.Path(elsewhere) / "bin"
            bin_folder.mkdir()
            os.symlink(CLI, bin_folder / "glisson-cli")
            # Debian's own interpreter, for which the module is built.
            os.symlink("/usr/bin/python3", bin_folder / "python3")
            env = {**os.environ, "PATH": f"{bin_folder}:{os.environ['PATH']}", "PYTHONPATH": os.environ["GLISSON_BUILD"] + "/python"}
            for page in pages():
                for needs_archive, text in blocks(page):
                    # A block that another page has printed before (the tutorial's translation) has run already.
                    if text in done or (needs_archive and port is None) or (page == "task-python.md" and not MODULE.exists()):
                        continue
                    done.add(text)
                    script = text.replace(f"--port {PRINTED_PORT}", f"--port {port}") if needs_archive else text
                    with self.subTest(page=page, commands=text):
                        result = subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=folder, env=env, capture_output=True,
                                                text=True)
                        self.assertEqual(result.returncode, 0, f"{page}: {text}\n{result.stderr[-600:]}")
                        ran += 1
            self.check_figures(folder)
        self.assertGreater(ran, 25)

    def check_figures(self, folder):
        """The figures that the tutorial tells about its patient."""
        run = json.loads((folder / "patients/patient-001/run/run.json").read_text())
        self.assertAlmostEqual(run["contact"]["travel_mm"], 45, delta=2)
        self.assertAlmostEqual(run["contact"]["force_along_hoist_N"], 15.9, delta=0.05)
        self.assertAlmostEqual(run["difference"]["travel_mm"], -12, delta=2)
        self.assertAlmostEqual(run["difference"]["at_retractor_mm"], 10, delta=1)
        self.assertAlmostEqual(run["model"]["dofs"] / 1e3, 150, delta=20)
        # The line of `measure` that is printed there, in both languages.
        measured = subprocess.run([CLI, "measure", "--mre", "patients/patient-001/mre", "--roi", "patients/patient-001/rtstruct.dcm"],
                                  cwd=folder, capture_output=True, text=True, check=True).stdout
        line = next(line for line in measured.splitlines() if line.startswith("pooled"))
        for page in ("tutorial.md", "tutorial.de.md"):
            self.assertIn(line, (MANUAL / page).read_text(encoding="utf-8"))

    def test_translation_prints_the_same_commands(self):
        self.assertEqual(blocks("tutorial.md"), blocks("tutorial.de.md"))


if __name__ == "__main__":
    unittest.main()
