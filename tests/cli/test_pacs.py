# SPDX-License-Identifier: GPL-3.0-or-later
"""A real DICOM server (Orthanc) on loopback: echo, find, get, move, send; our receiver against storescu and hostile callers."""
import contextlib
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import struct
import subprocess
import time
import unittest

import pydicom

from support import CLI, cli, cli_json, folder_of_class, folder_of_test

ORTHANC = pathlib.Path("/usr/sbin/Orthanc")
HASHED = re.compile(r"^[0-9a-f]{32}\.dcm$")


def free_port():
    with contextlib.closing(socket.socket()) as s:
        s.bind(("", 0))
        return s.getsockname()[1]


def wait_for(port, process, seconds=20):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        assert process.poll() is None, "the server ended"
        with contextlib.closing(socket.socket()) as s:
            if s.connect_ex(("127.0.0.1", port)) == 0:
                return
        time.sleep(0.05)
    raise AssertionError(f"nothing listens on port {port} after {seconds} s")


def stop(process):
    process.send_signal(signal.SIGTERM)
    try:
        process.wait(10)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def pixels_by_uid(folder):
    """SOP Instance UID to everything but the file meta information."""
    found = {}
    for file in sorted(pathlib.Path(folder).rglob("*.dcm")):
        data = pydicom.dcmread(file)
        found[data.SOPInstanceUID] = data
    return found


class Base(unittest.TestCase):
    def setUp(self):
        self.folder = folder_of_test(self)


def write_image(path, uid, study="1.2.826.0.1.1", series="1.2.826.0.1.1.1", number=1):
    """A small MR image, explicit little endian, of a patient whose name must not be told."""
    data = pydicom.Dataset()
    data.SOPClassUID, data.SOPInstanceUID = "1.2.840.10008.5.1.4.1.1.4", uid
    data.StudyInstanceUID, data.SeriesInstanceUID = study, series
    data.PatientName, data.PatientID, data.StudyDate, data.Modality = "PHI^CANARY", "PHI-CANARY-7", "20240229", "MR"
    data.SeriesNumber, data.InstanceNumber = 1, number
    data.ImagePositionPatient, data.ImageOrientationPatient = [0, 0, 2.0 * number], [1, 0, 0, 0, 1, 0]
    data.PixelSpacing, data.SliceThickness = [1, 1], 2
    data.Rows = data.Columns = 16
    data.BitsAllocated = data.BitsStored = 16
    data.HighBit, data.PixelRepresentation, data.SamplesPerPixel = 15, 0, 1
    data.PhotometricInterpretation = "MONOCHROME2"
    data.PixelData = struct.pack("<256H", *((number * 256 + n) % 65536 for n in range(256)))
    meta = pydicom.dataset.FileMetaDataset()
    meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID = data.SOPClassUID, uid
    meta.TransferSyntaxUID = "1.2.840.10008.1.2.1"
    data.file_meta, data.is_little_endian, data.is_implicit_VR, data.preamble = meta, True, False, b"\0" * 128
    data.save_as(path, write_like_original=False)


@unittest.skipUnless(ORTHANC.exists(), "Orthanc is not installed (packaging/debian-packages.txt)")
class WithOrthanc(Base):
    @classmethod
    def setUpClass(cls):
        root = folder_of_class(cls)
        cls.source = root / "patient"
        cls.source.mkdir()
        for n in range(1, 9):
            series = 1 + n % 2
            write_image(cls.source / f"{n}.dcm", f"1.2.826.0.1.1.{series}.{n}", series=f"1.2.826.0.1.1.{series}", number=n)
        (cls.source / "notes.txt").write_text("no image")
        cls.port, cls.move_port = free_port(), free_port()
        (root / "orthanc.json").write_text(json.dumps({
            "Name": "TEST", "StorageDirectory": str(root / "db"), "IndexDirectory": str(root / "db"), "Plugins": [],
            "HttpServerEnabled": False, "DicomServerEnabled": True, "DicomAet": "ORTHANC", "DicomPort": cls.port,
            "DicomCheckCalledAet": True, "DicomAlwaysAllowFind": True, "DicomAlwaysAllowMove": True, "DicomAlwaysAllowGet": False,
            "DicomModalities": {"us": ["GLISSON", "127.0.0.1", cls.move_port]}}))
        cls.server = subprocess.Popen([ORTHANC, root / "orthanc.json"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                      cwd=root)
        cls.addClassCleanup(stop, cls.server)
        wait_for(cls.port, cls.server)
        cls.node = ("--host", "127.0.0.1", "--port", cls.port, "--called", "ORTHANC", "--timeout", 10)
        sent = cli_json("pacs", "send", *cls.node, cls.source, code=6)
        assert sent["objects"] == 8 and len(sent["failed"]) == 1, sent

    def test_echo_and_titles(self):
        self.assertTrue(cli_json("pacs", "echo", *self.node)["answers"])
        wrong = cli("pacs", "echo", "--port", self.port, "--called", "NOBODY", code=1).stderr
        self.assertIn("called AE title", wrong)
        self.assertEqual(len([line for line in wrong.splitlines() if line.startswith("glisson-cli")]), 1)

    def test_find_names_nobody_unasked(self):
        found = cli("pacs", "find", *self.node, "--patient-id", "PHI-CANARY-7", "--study-date", "2024-02-01..2024-02-29",
                    "--modality", "MR", "--series", "--json")
        self.assertNotIn("PHI", found.stdout + found.stderr)
        studies = json.loads(found.stdout)["studies"]
        self.assertEqual([s["uid"] for s in studies], ["1.2.826.0.1.1"])
        self.assertEqual({s["uid"]: s["objects"] for s in studies[0]["series"]}, {"1.2.826.0.1.1.1": 4, "1.2.826.0.1.1.2": 4})
        named = cli_json("pacs", "find", *self.node, "--study", "1.2.826.0.1.1", "--show-names")["studies"][0]
        self.assertEqual((named["patient_name"], named["patient_id"]), ("PHI^CANARY", "PHI-CANARY-7"))
        self.assertEqual(cli_json("pacs", "find", *self.node, "--modality", "CT")["studies"], [])
        self.assertEqual(cli_json("pacs", "find", *self.node, "--study-date", "20240301-")["studies"], [])
        self.assertIn("nothing is looked for", cli("pacs", "find", *self.node, code=3).stderr)
        self.assertIn("study date", cli("pacs", "find", *self.node, "--study-date", "20230229", code=3).stderr)

    def check(self, got, folder, objects):
        self.assertEqual((got["objects"], got["expected"], got["complete"], got["failed"]), (objects, objects, True, 0))
        self.assertTrue(all(HASHED.match(name) for name in got["files"]))
        self.assertEqual(sorted(p.name for p in folder.iterdir()), sorted(got["files"]))
        ours, theirs = pixels_by_uid(folder), pixels_by_uid(self.source)
        for uid, data in ours.items():
            self.assertEqual(data.PixelData, theirs[uid].PixelData)
            self.assertEqual(data, theirs[uid])
        self.assertEqual(len(ours), objects)

    def test_get_and_move_bring_back_what_was_sent(self):
        by_get, by_move, one = self.folder / "get", self.folder / "move", self.folder / "series"
        got = cli_json("pacs", "get", *self.node, "1.2.826.0.1.1", "--output", by_get)
        self.assertEqual(got["level"], "study")
        self.check(got, by_get, 8)
        self.check(cli_json("pacs", "get", *self.node, "1.2.826.0.1.1", "--move", "--receive-port", self.move_port, "--output",
                            by_move), by_move, 8)
        series = cli_json("pacs", "get", *self.node, "1.2.826.0.1.1.2", "--output", one)
        self.assertEqual(series["level"], "series")
        self.check(series, one, 4)
        for file in by_get.iterdir():
            self.assertEqual(file.read_bytes()[400:], (by_move / file.name).read_bytes()[400:])
        geometry = [[{k: s[k] for k in ("uid", "slices", "rows", "spacing_mm", "origin_lps_mm", "direction")}
                     for s in cli_json("scan", folder)["series"]] for folder in (self.source, by_get, by_move)]
        self.assertEqual(geometry[0], geometry[1])
        self.assertEqual(geometry[0], geometry[2])
        again = cli_json("pacs", "get", *self.node, "1.2.826.0.1.1", "--output", by_get)
        self.assertEqual((again["objects"], again["already_there"], again["complete"]), (0, 8, True))

    def test_what_is_not_there(self):
        self.assertIn("no study and no series", cli("pacs", "get", *self.node, "1.2.3", "--output", self.folder, code=3).stderr)
        self.assertIn("no UID", cli("pacs", "get", *self.node, "../../etc", "--output", self.folder, code=3).stderr)
        unknown = cli("pacs", "get", *self.node, "--calling", "STRANGER", "1.2.826.0.1.1", "--move", "--receive-port", free_port(),
                      "--output", self.folder, code=1).stderr
        self.assertIn("AE title", unknown)
        refused = cli("pacs", "get", *self.node, "--calling", "STRANGER", "1.2.826.0.1.1", "--output", self.folder, code=1).stderr
        self.assertIn("AE title", refused)
        self.assertEqual([p for p in self.folder.rglob("*") if p.is_file()], [])


class OnOurOwn(Base):
    def receiver(self, *options):
        port = free_port()
        process = subprocess.Popen([CLI, "pacs", "receive", "--port", str(port), "--output", self.folder / "in", "--json", "--quiet",
                                    *map(str, options)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(lambda: process.poll() is None and stop(process))
        wait_for(port, process)
        return process, port

    def ended(self, process, code=0):
        out, err = process.communicate(timeout=30)
        self.assertEqual(process.returncode, code, err)
        self.assertNotIn("PHI", out + err)
        return json.loads(out)

    def test_no_server(self):
        self.assertIn("connection refused", cli("pacs", "echo", "--port", free_port(), code=1).stderr)
        self.assertIn("--host", cli("pacs", "echo", "--host", "no-such-host.invalid", code=1).stderr)
        with contextlib.closing(socket.socket()) as mute:
            mute.bind(("127.0.0.1", 0))
            mute.listen()
            begin = time.monotonic()
            self.assertIn("timeout", cli("pacs", "echo", "--port", mute.getsockname()[1], "--timeout", 1, code=1).stderr)
            self.assertLess(time.monotonic() - begin, 8)
        self.assertIn("AE title", cli("pacs", "echo", "--calling", "A" * 17, code=3).stderr)

    def test_a_taken_port(self):
        with contextlib.closing(socket.socket()) as taken:
            taken.bind(("", 0))
            taken.listen()
            said = cli("pacs", "receive", "--port", taken.getsockname()[1], "--output", self.folder, code=1).stderr
            self.assertIn("taken", said)

    @unittest.skipUnless(shutil.which("storescu"), "storescu (dcmtk) is not installed")
    def test_storescu_sends_to_us(self):
        files = []
        for n in range(1, 4):
            files.append(self.folder / f"{n}.dcm")
            write_image(files[-1], f"1.2.3.{n}", number=n)
        process, port = self.receiver("--count", 3, "--calling", "FRIEND")
        call = ["storescu", "-aec", "GLISSON", "-aet", "FRIEND", "127.0.0.1", str(port), *map(str, files)]
        for stranger in (["-aec", "OTHER", "-aet", "FRIEND"], ["-aec", "GLISSON", "-aet", "STRANGER"]):
            self.assertNotEqual(subprocess.run([call[0], *stranger, *call[5:]], capture_output=True).returncode, 0)
        subprocess.run(call, check=True, capture_output=True)
        got = self.ended(process)
        self.assertEqual((got["objects"], got["rejected"]), (3, 2))
        ours, theirs = pixels_by_uid(self.folder / "in"), {f: pydicom.dcmread(f) for f in files}
        for data in theirs.values():
            self.assertEqual(ours[data.SOPInstanceUID], data)
        self.assertTrue(all(HASHED.match(p.name) for p in (self.folder / "in").iterdir()))

    def test_junk_and_half_objects_leave_nothing(self):
        process, port = self.receiver("--timeout", 3, "--pdu-timeout", 1)
        junk = [b"GET / HTTP/1.0\r\n\r\n", b"\x01\x00\xff\xff\xff\xff" + b"\0" * 64, b"\x04\x00\x00\x00\x00\x04\xff\xff\xff\xff", b"",
                os.urandom(4096)]
        for bytes_ in junk:
            with contextlib.closing(socket.create_connection(("127.0.0.1", port))) as s:
                with contextlib.suppress(OSError):
                    s.sendall(bytes_)
        write_image(self.folder / "1.dcm", "1.2.3.1")
        self.assertEqual(cli_json("pacs", "send", "--port", port, "--called", "GLISSON", self.folder / "1.dcm")["objects"], 1)
        self.assertEqual(self.ended(process)["objects"], 1)
        self.assertEqual(len(list((self.folder / "in").iterdir())), 1)


if __name__ == "__main__":
    unittest.main()
