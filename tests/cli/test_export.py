# SPDX-License-Identifier: GPL-3.0-or-later
"""Standard files out, read back by other people's programs; and a patient called CANARY of whom nothing may be seen."""
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree

from support import cli, cli_json, read_nifti, write_nifti, write_scene

import numpy
import pydicom


def tool(name, *arguments):
    """Runs a validator, returns its words; skips the test where it is not installed."""
    if shutil.which(name) is None:
        raise unittest.SkipTest(f"{name} is not installed")
    done = subprocess.run([name, *map(str, arguments)], capture_output=True, text=True, errors="replace")
    return done.stdout + done.stderr


class Export(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())
        cli("phantom", "--cases", 1, "--seed", 5, "--output", cls.folder / "in", "--quiet")
        cls.patient = cls.folder / "in" / "patient-001"
        # Larger cells: what is tested is the writing.
        scene = json.loads((cls.patient / "scene.json").read_text())
        scene["geometry"]["cell_mm"] = [9, 9, 10]
        scene["outputs"] = ["displacement-field"]
        (cls.patient / "scene.json").write_text(json.dumps(scene))
        cls.out = cls.folder / "out"
        cls.said = cli_json("export", cls.patient / "scene.json", "--to",
                            "rtstruct,seg,pmap,sr,contours,markups,nifti,seg-nrrd,field,vtu,mtx,csv,slicer",
                            "--output", cls.out, "--case", "case-1", "--reader", "reader-1")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def test_everything_said_is_there(self):
        self.assertGreater(len(self.said["files"]), 20)
        for name in self.said["files"]:
            self.assertGreater(os.path.getsize(name), 0, name)

    def test_validators_find_no_error(self):
        objects = sorted(self.out.glob("*.dcm")) + sorted(self.patient.rglob("IM-0001.dcm")) + [
            self.patient / "rtstruct.dcm"]
        for path in objects:
            said = tool("dciodvfy", path)
            self.assertNotIn("Error", said, f"{path.name}: {said}")

    def test_report_and_structure_set_are_read_by_dcmtk(self):
        said = tool("dsrdump", self.out / "sr.dcm")
        self.assertIn("Imaging Measurement Report", said)
        self.assertIn("Elasticity", said)
        self.assertNotIn("E: ", said)
        said = tool("drtdump", self.out / "rtstruct.dcm")
        self.assertIn("RT Structure Set object", said)
        self.assertIn("RESEARCH contours", said)
        for line in said.splitlines():
            self.assertFalse(line.startswith(("E: ", "F: ")), line)
        contours = pydicom.dcmread(self.out / "rtstruct.dcm").ROIContourSequence[0].ContourSequence
        self.assertEqual({c.ContourGeometricType for c in contours}, {"CLOSED_PLANAR"})
        self.assertTrue(all(len(c.ContourData) == 3 * c.NumberOfContourPoints for c in contours))

    def test_report_holds_what_measure_says(self):
        measured = cli_json("measure", "--mre", self.patient / "mre", "--roi", self.out / "sr-seg.dcm")
        report = pydicom.dcmread(self.out / "sr.dcm")
        group = report.ContentSequence[-1].ContentSequence[0]
        numbers = {}
        for item in group.ContentSequence:
            if item.ValueType != "NUM":
                continue
            value = item.MeasuredValueSequence[0]
            modifiers = [m.ConceptCodeSequence[0].CodeMeaning for m in item.get("ContentSequence", [])]
            numbers[modifiers[-1] if modifiers else item.ConceptNameCodeSequence[0].CodeMeaning] = (
                float(value.NumericValue), value.MeasurementUnitsCodeSequence[0].CodeValue)
            if modifiers:
                self.assertIn("Shear modulus", modifiers[0])
                self.assertEqual(item.ConceptNameCodeSequence[0].CodeValue, "110830")
        pooled = measured["pooled"]
        self.assertEqual(numbers["Number of voxels measured"][0], pooled["n"])
        for meaning, key in (("Mean", "mean_kPa"), ("Median", "median_kPa"), ("Standard Deviation", "sd_kPa")):
            self.assertAlmostEqual(numbers[meaning][0], pooled[key], delta=1e-9 * abs(pooled[key]))
            self.assertEqual(numbers[meaning][1], "kPa")

    def test_parametric_map_comes_back_to_the_same_values(self):
        listed = cli_json("scan", self.out / "pmap.dcm")["series"]
        self.assertEqual(len(listed), 1)
        self.assertEqual((listed[0]["role"], listed[0]["unit"]), ("stiffness", "kPa"))
        cli("convert", self.out / "pmap.dcm", self.folder / "pmap.nii.gz", "--quiet")
        cli("convert", self.patient / "mre" / "stiffness", self.folder / "map.nii.gz", "--quiet")
        size, spacing, exported = read_nifti(self.folder / "pmap.nii.gz")
        whole, step, measured = read_nifti(self.folder / "map.nii.gz")
        self.assertEqual((size, spacing), (whole, step))
        # Pa in the elastogram, kPa in the map: equal but for one rounding to single precision.
        in_kPa = (numpy.array(measured, "f8") * 0.001).astype("f4")
        self.assertTrue(numpy.array_equal(numpy.array(exported, "f4"), in_kPa))
        statistics = lambda path: cli_json("measure", "--mre", path, "--roi", self.out / "sr-seg.dcm")["pooled"]["n"]
        self.assertGreaterEqual(statistics(self.out / "pmap.dcm"), statistics(self.patient / "mre"))
        data = pydicom.dcmread(self.out / "pmap.dcm")
        stored = numpy.frombuffer(data.FloatPixelData, "<f4")
        slices = sorted((pydicom.dcmread(p) for p in (self.patient / "mre" / "stiffness").iterdir()),
                        key=lambda d: float(d.ImagePositionPatient[2]))
        source = numpy.concatenate([d.pixel_array.ravel() for d in slices])
        self.assertTrue(numpy.array_equal(stored, (source.astype("f8") * 0.001).astype("f4")))
        scale = data.SharedFunctionalGroupsSequence[0].RealWorldValueMappingSequence[0]
        self.assertEqual(scale.MeasurementUnitsCodeSequence[0].CodeValue, "kPa")
        self.assertIn("Shear", scale.QuantityDefinitionSequence[0].ConceptCodeSequence[0].CodeMeaning)
        self.assertEqual(data.ContentQualification, "RESEARCH")

    def test_segmentation_and_structure_set_hold_the_same_voxels(self):
        seg = pydicom.dcmread(self.out / "seg.dcm")
        bits = numpy.unpackbits(numpy.frombuffer(seg.PixelData, "u1"), bitorder="little")
        inside = int(bits[: seg.NumberOfFrames * seg.Rows * seg.Columns].sum())
        import gzip
        raw = gzip.open(self.out / "liver.nii.gz").read()
        self.assertEqual(int(numpy.frombuffer(raw[352:], "u1").sum()), inside)
        again = self.folder / "again"
        scene = json.loads((self.patient / "scene.json").read_text())
        scene["geometry"]["roi"] = str(self.out / "rtstruct.dcm")
        (self.patient / "again.json").write_text(json.dumps(scene))
        cli("export", self.patient / "again.json", "--to", "nifti", "--output", again, "--quiet")
        self.assertEqual(gzip.open(again / "liver.nii.gz").read(), raw)
        self.assertEqual(seg.SegmentSequence[0].SegmentedPropertyTypeCodeSequence[0].CodeValue, "10200004")
        for name in ("seg", "pmap", "sr", "rtstruct"):
            data = pydicom.dcmread(self.out / f"{name}.dcm")
            source = pydicom.dcmread(self.patient / "mri" / "IM-0001.dcm")
            self.assertEqual(data.StudyInstanceUID, source.StudyInstanceUID)
            self.assertEqual(data.PatientID, source.PatientID)
            self.assertTrue(data.SeriesDescription.startswith("RESEARCH"))

    def test_segmentation_is_accepted_as_region_of_interest(self):
        by_contours = cli_json("measure", "--mre", self.patient / "mre", "--roi", self.out / "nifti"
                               if (self.out / "nifti").exists() else self.out / "liver.nii.gz")
        by_segments = cli_json("measure", "--mre", self.patient / "mre", "--roi", self.out / "seg.dcm", "--label", 1)
        self.assertEqual(by_contours["pooled"], by_segments["pooled"])
        process = cli("measure", "--mre", self.patient / "mre", "--roi", self.out / "seg.dcm", "--label", 7, code=3)
        self.assertIn("1 'liver'", process.stderr)

    def test_matrices_are_the_system(self):
        def read(name):
            lines = [l for l in (self.out / name).read_text().splitlines() if not l.startswith("%")]
            size = int(lines[0].split()[0])
            entries = numpy.array([l.split() for l in lines[1:]], float)
            return size, entries[:, 0].astype(int) - 1, entries[:, 1].astype(int) - 1, entries[:, 2]

        size, row, column, value = read("M.mtx")
        total = value.sum() + value[row != column].sum()
        self.assertGreater(total, 3 * 0.3)  # kg, three axes, a liver
        # A translation moves no spring of the body: the rows of K sum to zero over one axis.
        size, row, column, value = read("K.mtx")
        sums = numpy.zeros((size, 3))
        numpy.add.at(sums, (row, column % 3), value)
        off = row != column
        numpy.add.at(sums, (column[off], row[off] % 3), value[off])
        self.assertLess(numpy.abs(sums).max(), 1e-9 * numpy.abs(value).max())

    def test_tidy_table(self):
        lines = (self.out / "measurements.csv").read_text().splitlines()
        self.assertEqual(lines[0], "case,reader,slice,roi,quantity,statistic,value,unit")
        self.assertTrue(all(line.count(",") == 7 for line in lines))
        self.assertTrue(any(line.startswith("case-1,reader-1,pooled,liver,shear modulus,mean,") for line in lines))

    def test_slicer_scene_names_files_that_are_there(self):
        root = xml.etree.ElementTree.parse(self.out / "scene.mrml").getroot()
        files = [node.get("fileName") for node in root if node.get("fileName")]
        self.assertGreaterEqual(len(files), 5)
        for name in files:
            self.assertNotIn("/", name)
            self.assertTrue((self.out / name).exists(), name)
        header = (self.out / "liver.seg.nrrd").read_bytes().split(b"\n\n")[0].decode()
        self.assertIn("space: left-posterior-superior", header)
        self.assertIn("Segment0_Name:=liver", header)
        markups = json.loads((self.out / "contours.mrk.json").read_text())
        self.assertTrue(all(m["coordinateSystem"] == "LPS" for m in markups["markups"]))

    def test_unknown_format_names_the_others(self):
        process = cli("export", self.patient / "scene.json", "--to", "word", "--output", self.folder / "x", code=3)
        self.assertIn("rtstruct, seg, pmap", process.stderr)


class OtherGeometries(unittest.TestCase):
    """What needs no patient is written of any scene; what does says so in one line and writes nothing."""

    REFER = ("rtstruct", "seg", "pmap", "sr")

    def formats(self, scene, good, refused):
        for name in good:
            with self.subTest(format=name), tempfile.TemporaryDirectory() as out:
                said = cli_json("export", scene, "--to", name, "--output", out)
                self.assertTrue(said["files"])
                for file in said["files"]:
                    self.assertGreater(os.path.getsize(file), 0, file)
        for name, word in refused.items():
            with self.subTest(format=name), tempfile.TemporaryDirectory() as out:
                process = cli("export", scene, "--to", name, "--output", out, code=3)
                self.assertEqual(process.stderr.count("\n"), 1, process.stderr)
                self.assertIn(word, process.stderr)
                self.assertEqual(os.listdir(out), [])

    def test_box(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = write_scene(folder, {
                "geometry": {"kind": "box", "size_mm": [30, 10, 10], "cell_mm": 2.5},
                "material": {"youngs_kPa": 12}, "supports": [{"region": {"face": "x-"}, "kind": "fixed"}],
                "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -40]}], "outputs": []})
            self.formats(scene, ("field", "vtu", "mtx", "csv", "slicer", "sofa"),
                         {**{f: "DICOM" for f in self.REFER},
                          **{f: "the scene is a box" for f in ("contours", "markups", "nifti", "seg-nrrd")},
                          "sc": "folder of a run"})

    def test_mask(self):
        with tempfile.TemporaryDirectory() as folder:
            size = (14, 12, 10)
            inside = [1 if 2 <= i < 12 and 2 <= j < 10 and 2 <= k < 8 else 0
                      for k in range(size[2]) for j in range(size[1]) for i in range(size[0])]
            write_nifti(pathlib.Path(folder) / "liver.nii.gz", inside, size, (4, 4, 5), kind="B")
            scene = write_scene(folder, {
                "geometry": {"kind": "mask", "file": "liver.nii.gz"}, "material": {"youngs_kPa": 12},
                "supports": [{"region": {"surface": "posterior"}, "kind": "fixed"}],
                "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -40]}], "outputs": []})
            self.formats(scene, ("contours", "markups", "nifti", "seg-nrrd", "field", "vtu", "mtx", "csv", "slicer",
                                 "sofa"), {**{f: "DICOM" for f in self.REFER}, "sc": "folder of a run"})
            out = pathlib.Path(folder) / "out"
            cli("export", scene, "--to", "nifti", "--output", out, "--quiet")
            self.assertEqual(list(read_nifti(out / "liver.nii.gz")[2]), inside)


PLANT = """
import sys, pathlib, pydicom
from pydicom.dataset import Dataset
from pydicom.sequence import Sequence
root = pathlib.Path(sys.argv[1])
for n, path in enumerate(sorted(root.rglob('*.dcm'))):
    d = pydicom.dcmread(path)
    # One patient throughout, in two character sets, as after a move between archives.
    d.SpecificCharacterSet = 'ISO_IR 100' if n % 2 else 'ISO_IR 192'
    d.PatientName = 'CANARY^J\\u00fcrgen'; d.PatientID = '../../CANARY$(id)'; d.PatientBirthDate = '19010203'
    d.OtherPatientNames = 'CANARY^OTHER'; d.OtherPatientIDs = 'CANARY-2'; d.PatientAddress = 'CANARY STREET'
    d.PatientComments = 'CANARY'; d.EthnicGroup = 'CANARY'; d.Occupation = 'CANARY'; d.PatientAge = '061Y'
    d.InstitutionName = 'CANARY HOSPITAL'; d.InstitutionAddress = 'CANARY'; d.StationName = 'CANARY'
    d.ReferringPhysicianName = 'CANARY^DOCTOR'; d.OperatorsName = 'CANARY^OP'; d.PerformingPhysicianName = 'CANARY'
    d.AccessionNumber = 'CANARY1'; d.StudyID = 'CANARY3'; d.DeviceSerialNumber = 'CANARY'
    d.AdditionalPatientHistory = 'CANARY'; d.RequestedProcedureDescription = 'CANARY'
    d.SeriesDescription = d.get('SeriesDescription', '') + ' CANARY'
    d.StudyDescription = 'CANARY'; d.ProtocolName = 'CANARY'; d.ImageComments = 'CANARY'
    d.add_new((0x0009, 0x0010), 'LO', 'CANARY CREATOR'); d.add_new((0x0009, 0x1001), 'LO', 'CANARY')
    item = Dataset(); item.PatientName = 'CANARY^SEQ'; item.RequestedProcedureDescription = 'CANARY'
    item.ReferencedSOPClassUID = '1.2.840.10008.5.1.4.1.1.4'; item.ReferencedSOPInstanceUID = '1.2.3.4'
    d.RequestAttributesSequence = Sequence([item])
    other = Dataset(); other.TextValue = 'CANARY'; other.PersonName = 'CANARY^X'
    other.ConceptNameCodeSequence = Sequence([Dataset()])
    other.ConceptNameCodeSequence[0].CodeValue = 'CANARY'
    other.ConceptNameCodeSequence[0].CodingSchemeDesignator = '99CANARY'
    other.ConceptNameCodeSequence[0].CodeMeaning = 'CANARY'
    d.add_new((0x0040, 0xA730), 'SQ', Sequence([other])) if d.Modality == 'SR' else None
    if d.Modality == 'RTSTRUCT':
        d.StructureSetLabel = 'CANARY'; d.StructureSetName = 'CANARY'; d.StructureSetDescription = 'CANARY'
        d.StructureSetROISequence[0].ROIDescription = 'CANARY'
        d.RTROIObservationsSequence[0].ROIObservationLabel = 'CANARY'
        d.RTROIObservationsSequence[0].ROIInterpreter = 'CANARY^I'
    d.save_as(path)
    if path.name.startswith('IM-'):
        path.rename(path.with_name('CANARY-' + path.name))
(root / 'mre' / 'CANARY-notes.txt').write_text('CANARY')
"""


class Canary(unittest.TestCase):
    """The patient's words are in capitals; folders given by this test are not."""

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())
        cli("phantom", "--cases", 1, "--seed", 6, "--output", cls.folder / "in", "--quiet")
        cls.patient = cls.folder / "in" / "patient-001"
        scene = json.loads((cls.patient / "scene.json").read_text())
        scene["geometry"]["cell_mm"] = [9, 9, 10]
        (cls.patient / "scene.json").write_text(json.dumps(scene))
        subprocess.run(["/usr/bin/python3", "-c", PLANT, str(cls.patient)], check=True)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def assertNoCanary(self, folder, text=""):
        self.assertNotIn("CANARY", text)
        for path in folder.rglob("*"):
            self.assertNotIn("CANARY", path.name)
            if path.is_file():
                data = path.read_bytes()
                self.assertNotIn(b"CANARY", data, path.name)
                self.assertNotIn("CANARY".encode("utf-16-le"), data, path.name)

    def test_outputs_do_not_name_the_patient(self):
        out = self.folder / "run"
        done = cli("run", self.patient / "scene.json", "--output", out)
        self.assertNoCanary(out, done.stdout + done.stderr)
        done = cli("measure", "--mre", self.patient / "mre", "--roi", self.patient / "rtstruct.dcm", "--json")
        self.assertNotIn("CANARY^", done.stdout + done.stderr)
        exported = self.folder / "exported"
        done = cli("export", out, "--to",
                   "contours,markups,nifti,seg-nrrd,field,vtu,mtx,csv,slicer,sofa", "--output", exported)
        self.assertNoCanary(exported, done.stdout + done.stderr)
        self.assertFalse((self.folder.parent / "CANARY$(id)").exists())

    def test_deidentified_copies_hold_nothing_and_still_work(self):
        cli("export", self.patient / "scene.json", "--to", "rtstruct,seg,sr,pmap", "--output", self.patient / "derived",
            "--quiet")
        before = cli_json("scan", self.patient / "mre")
        copies = self.folder / "copies"
        key = self.folder / "project.key"
        process = cli("deidentify", self.patient, copies, "--key", key, "--json", "--quiet", code=6)
        self.assertNoCanary(copies, process.stdout + process.stderr)
        said = json.loads(process.stdout)
        self.assertGreater(len(said["files"]), 10)
        self.assertEqual(len(said["files"]), len(list(copies.rglob("*.dcm"))))
        old = {pydicom.dcmread(p, stop_before_pixels=True, force=True).get("SOPInstanceUID")
               for p in self.patient.rglob("*.dcm")}
        series = {}
        for name in said["files"]:
            d = pydicom.dcmread(name)
            self.assertEqual(d.PatientIdentityRemoved, "YES")
            self.assertEqual(d.DeidentificationMethodCodeSequence[0].CodeValue, "113100")
            self.assertTrue(str(d.PatientName).startswith("G-"))
            self.assertNotIn(d.SOPInstanceUID, old)
            self.assertNotIn("PatientAge", d)
            series.setdefault(d.Modality, d)
        self.assertEqual(series["SEG"].StudyInstanceUID, series["MR"].StudyInstanceUID)
        self.assertEqual(series["RTSTRUCT"].StudyInstanceUID, series["MR"].StudyInstanceUID)
        known = {pydicom.dcmread(n).SOPInstanceUID for n in said["files"]}
        frame = series["SEG"].PerFrameFunctionalGroupsSequence[0]
        self.assertIn(frame.DerivationImageSequence[0].SourceImageSequence[0].ReferencedSOPInstanceUID, known)
        for d in series.values():
            said_ = tool("dciodvfy", d.filename)
            self.assertNotIn("Error", said_, d.Modality + said_)
        # Same roles, same units, same numbers.
        after = cli_json("scan", copies)
        roles = lambda s: sorted((x["role"], x.get("unit", "")) for x in s["series"] if x["role"] in
                                 ("stiffness", "confidence", "wave", "magnitude"))
        for one in roles(before):
            self.assertIn(one, roles(after))
        parts = self.folder / "parts"
        cli("deidentify", self.patient / "mre", parts / "mre", "--key", key, "--quiet", code=6)
        cli("deidentify", self.patient / "rtstruct.dcm", parts / "roi", "--key", key, "--quiet")
        outline = next((parts / "roi").rglob("*.dcm"))
        numbers = [cli_json("measure", "--mre", mre, "--roi", roi) for mre, roi in
                   ((self.patient / "mre", self.patient / "rtstruct.dcm"), (parts / "mre", outline))]
        for name in ("pooled", "slices", "quantity"):
            self.assertEqual(numbers[0][name], numbers[1][name])
        again = self.folder / "again"
        cli("deidentify", self.patient, again, "--key", key, "--quiet", code=6)
        self.assertEqual(sorted(p.relative_to(again) for p in again.rglob("*.dcm")),
                         sorted(p.relative_to(copies) for p in copies.rglob("*.dcm")))
        for path in again.rglob("*.dcm"):
            self.assertEqual(path.read_bytes(), (copies / path.relative_to(again)).read_bytes())

    def test_key_file_stays_apart(self):
        process = cli("deidentify", self.patient, self.folder / "c3", "--key", self.folder / "c3" / "k", code=3)
        self.assertIn("keep it apart", process.stderr)


if __name__ == "__main__":
    unittest.main()
