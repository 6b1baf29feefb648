# SPDX-License-Identifier: GPL-3.0-or-later
"""What the command-line tests share: running the program, minimal NIfTI files. Standard library only."""
import gzip
import json
import os
import pathlib
import struct
import subprocess
import tempfile
import unittest

CLI = os.environ["GLISSON_CLI"]
ROOT = pathlib.Path(os.environ["GLISSON_ROOT"])
DATA = pathlib.Path(os.environ["GLISSON_SHARED_DATA"])


def cli(*arguments, code=0, env=None):
    """Runs the program, checks the exit code, returns the finished process."""
    process = subprocess.run([CLI, *map(str, arguments)], capture_output=True, text=True,
                             env={**os.environ, **(env or {})})
    assert process.returncode == code, f"exit {process.returncode}, not {code}: {process.stderr}"
    return process


def cli_json(*arguments, code=0, env=None):
    """Runs with --json --quiet; stdout must be one JSON object and nothing else."""
    return json.loads(cli(*arguments, "--json", "--quiet", code=code, env=env).stdout)


def folder_of_class(cls):
    """A folder that goes away with the tests of a class: call it in setUpClass."""
    folder = tempfile.TemporaryDirectory()
    cls.addClassCleanup(folder.cleanup)
    return pathlib.Path(folder.name)


def folder_of_test(test):
    """A folder that goes away with a test: call it in setUp or in the test."""
    folder = tempfile.TemporaryDirectory()
    test.addCleanup(folder.cleanup)
    return pathlib.Path(folder.name)


def write_scene(folder, scene, name="scene.json"):
    path = pathlib.Path(folder) / name
    path.write_text(json.dumps({"schema": "glisson/scene/1", **scene}))
    return path


class SceneTest(unittest.TestCase):
    """Tests that run scenes in a folder of their own."""

    def setUp(self):
        self.folder = folder_of_test(self)

    def run_scene(self, scene, *arguments, code=0):
        return cli_json("run", write_scene(self.folder, scene), "--output", self.folder / "out", *arguments, code=code)


def write_nifti(path, values, size, spacing, origin_ras=(0, 0, 0), kind="f"):
    """values: flat, x fastest; axes along R, A, S; kind 'f' float32 or 'B' uint8."""
    datatype, bits = {"f": (16, 32), "B": (2, 8)}[kind]
    header = struct.pack("<i10s18sihBB", 348, b"", b"", 0, 0, 0, 0)
    header += struct.pack("<8h", 3, *size, 1, 1, 1, 1)
    header += struct.pack("<3fhhhh", 0, 0, 0, 0, datatype, bits, 0)
    header += struct.pack("<8f", 1, *spacing, 0, 0, 0, 0)
    header += struct.pack("<f2fhBB4f2i", 352, 1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0)
    header += struct.pack("<80s24s2h", b"", b"", 0, 1)
    header += struct.pack("<6f", 0, 0, 0, 0, 0, 0)
    header += struct.pack("<4f", spacing[0], 0, 0, origin_ras[0])
    header += struct.pack("<4f", 0, spacing[1], 0, origin_ras[1])
    header += struct.pack("<4f", 0, 0, spacing[2], origin_ras[2])
    header += struct.pack("<16s4s", b"", b"n+1\0")
    assert len(header) == 348
    body = header + b"\0" * 4 + struct.pack(f"<{len(values)}{kind}", *values)
    opener = gzip.open if str(path).endswith(".gz") else open
    with opener(path, "wb") as out:
        out.write(body)


def read_nifti(path):
    """Returns (size, spacing, values) of a float32, int16, uint8 or int32 file."""
    opener = gzip.open if str(path).endswith(".gz") else open
    with opener(path, "rb") as source:
        data = source.read()
    size = struct.unpack_from("<8h", data, 40)[1:4]
    datatype = struct.unpack_from("<h", data, 70)[0]
    spacing = struct.unpack_from("<8f", data, 76)[1:4]
    offset = int(struct.unpack_from("<f", data, 108)[0])
    kind = {16: "f", 4: "h", 2: "B", 8: "i", 64: "d", 512: "H"}[datatype]
    count = size[0] * size[1] * size[2]
    return size, spacing, struct.unpack_from(f"<{count}{kind}", data, offset)
