# SPDX-License-Identifier: GPL-3.0-or-later
"""Every command printed in README.md, in the rooms' README files and in the manual runs, in this order, in one folder with nothing but the
clone's resources/ in it. A page may use what the README and the tutorial made; what they print alike runs once. Blocks marked `sh pacs`
need a DICOM server, which is started here."""
import contextlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
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


def documents():
    """The README files, then the pages of the manual in their order."""
    readmes = [ROOT / "README.md", *sorted(p for room in ("core", "ui", "packaging") for p in (ROOT / room).rglob("README.md"))]
    return readmes + [MANUAL / page for page in pages()]


def blocks(document):
    """(needs an archive, commands) of the ```sh blocks of a document; ```text blocks are not run."""
    return [(bool(kind), text) for kind, text in BLOCK.findall(document.read_text(encoding="utf-8"))]


def commands(text):
    """The commands of a block one by one if each stands in a line of its own, else the block."""
    lines = [line.split("  #")[0].strip() for line in text.splitlines()]
    alone = all(re.match(r"(glisson-cli|git|cd|cp|ls|cat|grep|head) |packaging/|python3 resources/", line) and line.count('"') % 2 == 0
                and not line.endswith("\\") for line in lines if line)
    return [line for line in lines if line] if alone else [text]


def runs_elsewhere(command):
    """Set-up is what started this test, and the examples in Python have a test of their own, tests/python: such a script is there."""
    if not re.match(r"packaging/|git clone|cd |python3 resources/examples/python/", command):
        return False
    script = re.match(r"(?:python3 )?((?:packaging|resources)/\S+)", command)
    if script and command.startswith("packaging/"):
        assert os.access(ROOT / script[1], os.X_OK), command
        subprocess.run(["bash", "-n", ROOT / script[1]], check=True)
    elif script:
        assert (ROOT / script[1]).is_file(), command
    return True


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
        done = set()
        with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as elsewhere, archive(elsewhere) as port:
            folder = pathlib.Path(folder)
            os.symlink(ROOT / "resources", folder / "resources")
            bin_folder = pathlib.Path(elsewhere) / "bin"
            bin_folder.mkdir()
            os.symlink(CLI, bin_folder / "glisson-cli")
            # Debian's own interpreter, for which the module is built.
            os.symlink("/usr/bin/python3", bin_folder / "python3")
            env = {**os.environ, "PATH": f"{bin_folder}:{os.environ['PATH']}", "PYTHONPATH": os.environ["GLISSON_BUILD"] + "/python"}
            for document in documents():
                for needs_archive, text in blocks(document):
                    if (needs_archive and port is None) or (document.name == "task-python.md" and not MODULE.exists()):
                        continue
                    for command in commands(text):
                        if command in done or runs_elsewhere(command):
                            continue
                        done.add(command)
                        script = command.replace(f"--port {PRINTED_PORT}", f"--port {port}") if needs_archive else command
                        with self.subTest(document=document.name, command=command):
                            start = time.monotonic()
                            result = subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=folder, env=env, capture_output=True,
                                                    text=True)
                            self.assertEqual(result.returncode, 0, f"{document.name}: {command}\n{result.stderr[-600:]}")
                            print(f"{time.monotonic() - start:6.1f} s  {command.splitlines()[0]}", file=sys.stderr)
            self.check_figures(folder)
        self.assertGreater(len(done), 40)

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
        self.assertEqual(blocks(MANUAL / "tutorial.md"), blocks(MANUAL / "tutorial.de.md"))


if __name__ == "__main__":
    unittest.main()
