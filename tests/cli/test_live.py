# SPDX-License-Identifier: GPL-3.0-or-later
"""The retraction over OpenIGTLink, read byte by byte with nothing but the standard library."""
import itertools
import json
import pathlib
import re
import socket
import struct
import subprocess
import tempfile
import unittest

from support import CLI, cli, write_nifti, write_scene


def read_exactly(connection, count):
    data = b""
    while len(data) < count:
        part = connection.recv(count - len(data))
        if not part:
            raise EOFError
        data += part
    return data


def message(connection):
    """Type, device name and body of the next message (header version 1)."""
    version, kind, name, _, size, _ = struct.unpack(">H12s20sQQQ", read_exactly(connection, 58))
    assert version == 1
    return kind.rstrip(b"\0").decode(), name.rstrip(b"\0").decode(), read_exactly(connection, size)


def block(folder, retractor):
    """A block on springs with a bar under it."""
    folder = pathlib.Path(folder)
    cells = list(itertools.product(range(8), range(8), range(8)))
    write_nifti(folder / "mask.nii.gz", [1] * len(cells), (8, 8, 8), (8.0, 8.0, 8.0), kind="B")
    return write_scene(folder, {
        "geometry": {"kind": "mask", "file": "mask.nii.gz"}, "material": {"youngs_kPa": 12},
        "supports": [{"region": {"surface": "all"}, "kind": "spring", "stiffness_kPa_per_mm": 0.1}],
        "loads": [{"kind": "retractor", "length_mm": 40, "at": [-28, 0, 28], **retractor}],
        "compare": {"against": "atlas"}, "outputs": [{"probe": [[-20, -20, 20], [-30, -30, 30]]}]})


class Live(unittest.TestCase):
    def stream(self, frames, *options):
        """The first four messages, those of the last frame, and the record of a stream of both stiffnesses."""
        with tempfile.TemporaryDirectory() as temporary:
            scene = block(temporary, {"force": 2})
            process = subprocess.Popen([CLI, "live", str(scene), "--port", "0", "--frames", str(frames), "--rate", "100",
                                        "--json", *options],
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            port = None
            for line in process.stderr:
                found = re.search(r"port (\d+)", line)
                if found:
                    # Whoever only wanted a measurement is told what it waits for.
                    self.assertIn("waits for a client", line)
                    self.assertIn("--headless", line)
                    port = int(found.group(1))
                    break
            self.assertIsNotNone(port)
            with socket.create_connection(("127.0.0.1", port), timeout=20) as connection:
                seen = [message(connection) for _ in range(frames * 4)]
            out = process.stdout.read()
            process.wait(timeout=60)
            process.stdout.close()
            process.stderr.close()
            self.assertEqual(process.returncode, 0)
        return seen[:4], seen[-4:], json.loads(out)

    def check(self, first):
        self.assertEqual([(k, n) for k, n, _ in first],
                         [("POINT", "LandmarksMRE"), ("POINT", "LandmarksAtlas"), ("TRANSFORM", "RetractorReached"),
                          ("STRING", "RetractorForce")])
        self.assertEqual(len(first[0][2]), 2 * 136)
        # Points are RAS: the probe at LPS (-20, -20, 20) lies near (20, 20, 20), and the softer atlas has moved further.
        mre, atlas = (struct.unpack_from(">3f", body, 100) for _, _, body in first[:2])
        self.assertLess(max(abs(a - 20) for a in mre), 10)
        moved = [sum((a - 20) ** 2 for a in p) for p in (mre, atlas)]
        self.assertGreater(moved[1], moved[0])

    def test_streams_landmarks_of_both_stiffnesses_in_contact(self):
        first, last, record = self.stream(5)
        self.check(first)
        self.assertEqual(record["model"], "contact")
        self.assertEqual(record["frames"], 5)
        # The scene's own hoist is reached before anyone connects: 2 N towards anterior, and nothing moves any more.
        force = [float(x) for x in re.findall(rb"[-+.0-9e]+", first[3][2][4:])]
        self.assertAlmostEqual(force[1], 2.0, delta=0.02)
        self.assertLess(record["remaining_mm"], 0.05)
        self.assertEqual(first[0][2], last[0][2])

    def test_streams_the_condensed_answer_where_that_is_asked_for(self):
        first, _, record = self.stream(3, "--model", "condensed")
        self.check(first)
        self.assertEqual(record["model"], "condensed")
        self.assertEqual(record["remaining_mm"], 0)

    def headless(self, retractor, *options, frames=250):
        with tempfile.TemporaryDirectory() as temporary:
            scene = block(temporary, retractor)
            return json.loads(cli("live", scene, "--headless", "--frames", frames, "--json", *options).stdout)

    def test_measures_without_a_client_and_meets_a_small_force(self):
        for force in (0.05, 0.2, 2):
            record = self.headless({"force": force})
            self.assertEqual((record["frames"], record["headless"], record["poses"]), (250, True, 0))
            self.assertGreater(record["rate_hz"], 5)
            for who in ("mre", "atlas"):
                self.assertTrue(record[who]["at_rest"], (force, who, record[who]))
                self.assertFalse(record[who]["slips"])
                self.assertAlmostEqual(-record[who]["force_N"][1], force, delta=max(0.004 * force, 0.0015))
            self.assertEqual(record["slipping_frames"], 0)
            self.assertGreater(record["cell_mm"], 0)
            self.assertIsNone(record["discretisation_mm"])

    def test_goes_by_the_travel_of_the_scene(self):
        record = self.headless({"drive": {"travel_mm": 6}})
        for who in ("mre", "atlas"):
            self.assertTrue(record[who]["at_rest"])
            self.assertAlmostEqual(-record[who]["tool_mm"][1], 6, delta=0.01)
        self.assertGreater(-record["mre"]["force_N"][1], -record["atlas"]["force_N"][1])
        condensed = self.headless({"drive": {"travel_mm": 6}}, "--model", "condensed", frames=3)
        self.assertAlmostEqual(-condensed["mre"]["tool_mm"][1], 6, delta=1e-6)

    def test_says_that_a_bar_slips(self):
        record = self.headless({"force": 8}, frames=100)  # a run says that it slips at 5.9 N
        self.assertEqual((record["mre"]["slips"], record["atlas"]["slips"]), (False, True))
        self.assertGreater(record["slipping_frames"], 0)
        self.assertTrue(any("slips" in w for w in record["warnings"]))
        self.assertTrue(any("slips" in d["text"] for d in record["diagnostics"]))

    def test_tells_what_its_cells_cost_against_a_run(self):
        with tempfile.TemporaryDirectory() as temporary:
            scene = block(temporary, {"force": 2})
            out = pathlib.Path(temporary) / "run"
            cli("run", scene, "--output", out)
            arguments = ["live", scene, "--headless", "--frames", 5, "--run", out]
            record = json.loads(cli(*arguments, "--json").stdout)
            off = record["discretisation_mm"]
            self.assertLessEqual(0, off["mean"])
            self.assertLessEqual(off["mean"], off["max"])
            self.assertLess(off["max"], 2.0)
            self.assertIn("from where the run put them", cli(*arguments).stdout)
            (pathlib.Path(temporary) / "other").mkdir()
            other = block(pathlib.Path(temporary) / "other", {"force": 2})
            changed = json.loads(other.read_text())
            changed["outputs"] = [{"probe": [[-21, -20, 20]]}]
            other.write_text(json.dumps(changed))
            self.assertIn("not of this scene",
                          cli("live", other, "--headless", "--frames", 5, "--run", out, code=3).stderr)
            self.assertIn("--frames", cli("live", scene, "--headless", code=3).stderr)

    def test_says_what_is_missing(self):
        with tempfile.TemporaryDirectory() as temporary:
            scene = write_scene(temporary, {"geometry": {"kind": "box", "size_mm": [20, 20, 20]},
                                            "material": {"youngs_kPa": 12},
                                            "supports": [{"region": {"face": "x-"}, "kind": "fixed"}],
                                            "outputs": [{"probe": [[10, 10, 10]]}],
                                            "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -1]}]})
            self.assertIn("retractor", cli("live", scene, "--port", 0, "--frames", 1, code=3).stderr)


if __name__ == "__main__":
    unittest.main()
