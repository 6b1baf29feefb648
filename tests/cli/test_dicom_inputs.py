# SPDX-License-Identifier: GPL-3.0-or-later
"""DICOM as it comes from disks and servers: archives, DICOMDIR, mosaics, thumbnails, roles by hand, mismatched series."""
import shutil
import struct
import unittest
import zipfile
import zlib

import pydicom

from support import DATA, cli, cli_json, folder_of_class, folder_of_test, read_nifti, write_nifti, write_scene


def png_pixels(path):
    """Checks the signature and the chunks; returns (width, height, text chunks)."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, texts, size = 8, [], None
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0]
        if kind == b"IHDR":
            size = struct.unpack(">II", body[:8])
        if kind in (b"tEXt", b"iTXt", b"zTXt"):
            texts.append(body)
        at += 12 + length
    return size, texts


class DicomInputs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.patients = folder_of_class(cls)
        cli("phantom", "--cases", 1, "--seed", 7, "--output", cls.patients, "--quiet")
        cls.patient = next(p.parent for p in cls.patients.rglob("scene.json"))

    def setUp(self):
        self.folder = folder_of_test(self)

    def measured(self, mre, *more, code=0):
        arguments = ("measure", "--mre", mre, "--roi", self.patient / "rtstruct.dcm", "--mri", self.patient / "mri", *more)
        return cli_json(*arguments) if code == 0 else cli(*arguments, "--quiet", code=code).stderr

    def test_several_labels_are_asked_about(self):
        size, spacing = (6, 5, 4), (2, 2, 5)
        values = [1000 + 10 * n for n in range(120)]
        write_nifti(self.folder / "map.nii", values, size, spacing)
        labels = [5 if n < 60 else 7 if n < 90 else 0 for n in range(120)]
        write_nifti(self.folder / "labels.nii", labels, size, spacing, kind="B")
        call = ("measure", "--mre", self.folder / "map.nii", "--roi", self.folder / "labels.nii", "--quantity", "shear",
                "--unit", "Pa")
        question = cli(*call, "--quiet", code=3).stderr
        self.assertIn("labels 5 7", question)
        self.assertIn("--label", question)
        one = cli_json(*call, "--label", 5)
        self.assertEqual(one["pooled"]["n"], 60)
        self.assertAlmostEqual(one["pooled"]["mean_kPa"], 1.295, places=6)
        both = cli_json(*call, "--label", 0)
        self.assertEqual(both["pooled"]["n"], 90)
        self.assertTrue(any("labels 5 7" in w for w in both["warnings"]))

    def test_a_series_that_is_not_the_only_or_no_stiffness_is_doubted(self):
        anatomy = cli_json("measure", "--mre", self.patient / "mri", "--roi", self.patient / "rtstruct.dcm", "--unit", "Pa")
        self.assertTrue(any("recognised as anatomical" in w for w in anatomy["warnings"]))
        once = self.measured(self.patient / "mre")
        self.assertFalse(any("stiffness series are here" in w for w in once["warnings"]))
        shutil.copytree(self.patient / "mre", self.folder / "both")
        shutil.copytree(self.patient / "mre" / "stiffness", self.folder / "both" / "again")
        uid, frames = pydicom.uid.generate_uid(), sorted((self.folder / "both" / "again").iterdir())
        for file in frames:
            image = pydicom.dcmread(file)
            image.SeriesInstanceUID, image.SOPInstanceUID = uid, pydicom.uid.generate_uid()
            image.SeriesNumber = 1701
            image.save_as(file)
        twice = self.measured(self.folder / "both")
        self.assertTrue(any("2 stiffness series are here" in w and "1701" in w for w in twice["warnings"]))
        self.assertEqual(twice["pooled"], once["pooled"])

    def test_voxels_without_stiffness_are_counted_aloud(self):
        size, spacing = (6, 5, 4), (2, 2, 5)
        values = [-1.0 if n < 4 else 0.0 if n < 7 else 2.0 for n in range(120)]
        write_nifti(self.folder / "map.nii", values, size, spacing)
        write_nifti(self.folder / "mask.nii", [255] * 120, size, spacing, kind="B")
        j = cli_json("measure", "--mre", self.folder / "map.nii", "--roi", self.folder / "mask.nii", "--quantity",
                     "shear", "--unit", "kPa")
        self.assertEqual((j["pooled"]["n"], j["pooled"]["n_before_mask"]), (113, 120))
        self.assertAlmostEqual(j["pooled"]["mean_kPa"], 2.0, places=6)
        self.assertTrue(any("7 of 120 voxels hold no stiffness" in w for w in j["warnings"]))

    def test_zip_gives_what_the_folder_gives(self):
        archive = self.folder / "study.zip"
        with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as out:
            for file in sorted((self.patient / "mre").rglob("*")):
                if file.is_file():
                    out.write(file, file.relative_to(self.patient))
            out.writestr("../escaped", "no")
        a, b = cli_json("scan", self.patient / "mre"), cli_json("scan", archive)
        self.assertEqual([s["uid"] for s in a["series"]], [s["uid"] for s in b["series"]])
        self.assertTrue(any("no plain path" in s["reason"] for s in b["skipped"]))
        self.assertEqual(self.measured(self.patient / "mre")["pooled"], self.measured(archive)["pooled"])
        scene = write_scene(self.patient, {"geometry": {"kind": "patient", "mri": "mri", "mre": str(archive), "roi": "rtstruct.dcm"},
                                           "material": "mre"}, "zip.json")
        self.assertTrue(cli_json("plan", scene)["plan"])

    def test_region_of_another_patient_is_refused_and_can_be_overridden(self):
        changed = pydicom.dcmread(self.patient / "rtstruct.dcm")
        changed.PatientID, changed.PatientName = "OTHER7", "PHI^CANARY"
        changed.save_as(self.folder / "other.dcm")
        measure = ("measure", "--mre", self.patient / "mre", "--roi", self.folder / "other.dcm")
        for more in ((), ("--mri", self.patient / "mri")):
            said = cli(*measure, *more, "--quiet", code=3).stderr
            self.assertIn("belong to different patients", said)
            self.assertIn("--override", said)
            self.assertNotIn("CANARY", said)
            self.assertNotIn("OTHER7", said)
        overridden = cli_json(*measure, "--override")
        self.assertTrue(any("overridden by the user" in w for w in overridden["warnings"]))
        self.assertEqual(overridden["pooled"], cli_json(*measure[:3], "--roi", self.patient / "rtstruct.dcm")["pooled"])
        both = (self.patient / "rtstruct.dcm", self.folder / "other.dcm", "--mri", self.patient / "mri")
        self.assertIn("different patients", cli("agree", *both, "--quiet", code=3).stderr)
        self.assertEqual(cli_json("agree", *both, "--override")["cases"][0]["with_first"][0]["dice"], 1.0)
        scene = {"geometry": {"kind": "patient", "mri": str(self.patient / "mri"), "mre": str(self.patient / "mre"),
                              "roi": str(self.folder / "other.dcm")}, "material": "mre"}
        self.assertIn("different patients", cli("export", write_scene(self.folder, scene), "--to", "seg", "--output",
                                                self.folder / "out", "--quiet", code=3).stderr)

    def test_region_of_another_frame_of_reference_is_warned_about(self):
        changed = pydicom.dcmread(self.patient / "rtstruct.dcm")
        for item in changed.ReferencedFrameOfReferenceSequence:
            item.FrameOfReferenceUID = "1.2.3.4"
        for item in changed.StructureSetROISequence:
            item.ReferencedFrameOfReferenceUID = "1.2.3.4"
        changed.save_as(self.folder / "other.dcm")
        said = cli_json("measure", "--mre", self.patient / "mre", "--roi", self.folder / "other.dcm", "--mri",
                        self.patient / "mri")["warnings"]
        self.assertTrue(any("the region of interest and the MRI have different frames of reference" in w for w in said))
        self.assertTrue(any("the elastogram have different frames of reference" in w for w in said))

    def test_convert_says_which_series_and_refuses_to_guess(self):
        out = self.folder / "out.nii"
        taken = cli_json("convert", self.patient, out)["series"]  # one anatomical series among others
        self.assertEqual(taken["role"], "anatomical")
        self.assertIn("anatomical, 256 x 256 x", cli("convert", self.patient, out, "--quiet").stdout)
        refused = cli("convert", self.patient / "mre", out, "--quiet", code=3).stderr
        self.assertIn("choose one with --series", refused)
        self.assertIn("stiffness, 256 x 256 x", refused)
        self.assertEqual(cli_json("convert", self.patient / "mre", out, "--series", "stiffness")["series"]["role"], "stiffness")
        self.assertIn("scan", cli("convert", self.patient / "mre", out, "--series", "99999", "--quiet", code=3).stderr)
        cli("phantom", "--cases", 1, "--seed", 8, "--output", self.folder / "other", "--quiet")
        shutil.copytree(self.patient / "mri", self.folder / "other" / "first")
        self.assertIn("2 series fit", cli("convert", self.folder / "other", out, "--quiet", code=3).stderr)

    def test_dicomdir_reads_what_it_lists(self):
        disc = self.folder / "disc"
        shutil.copytree(self.patient / "mre" / "stiffness", disc / "DICOM")
        names = []
        for n, file in enumerate(sorted((disc / "DICOM").iterdir())):
            names.append(f"IM{n:04}")
            file.rename(file.with_name(names[-1].lower()))
        shutil.copytree(self.patient / "mre" / "wave", disc / "OTHER")
        index = pydicom.Dataset()
        index.DirectoryRecordSequence = []
        for name in names + ["IM9999"]:
            record = pydicom.Dataset()
            record.DirectoryRecordType = "IMAGE"
            record.ReferencedFileID = ["DICOM", name]
            index.DirectoryRecordSequence.append(record)
        meta = pydicom.dataset.FileMetaDataset()
        meta.MediaStorageSOPClassUID = "1.2.840.10008.1.3.10"
        meta.MediaStorageSOPInstanceUID = "1.2.3"
        meta.TransferSyntaxUID = "1.2.840.10008.1.2.1"
        index.file_meta, index.is_little_endian, index.is_implicit_VR, index.preamble = meta, True, False, b"\0" * 128
        index.save_as(disc / "DICOMDIR", write_like_original=False)
        scan = cli_json("scan", disc / "DICOMDIR")
        self.assertEqual([s["role"] for s in scan["series"]], ["stiffness"])
        self.assertEqual([s["reason"] for s in scan["skipped"]], ["is listed in the DICOMDIR and missing"])
        everything = cli_json("scan", disc)["series"]
        self.assertEqual(sorted(s["role"] for s in everything), ["stiffness"] + 4 * ["wave"])

    def test_thumbnails_name_nobody(self):
        scan = cli_json("scan", self.patient, "--thumbnails", self.folder / "small")
        pictures = [s for s in scan["series"] if s.get("thumbnail")]
        self.assertGreaterEqual(len(pictures), 4)
        for s in pictures:
            size, texts = png_pixels(self.folder / "small" / s["thumbnail"])
            self.assertLessEqual(max(size), 128)
            self.assertRegex(s["thumbnail"], r"^series-\d+-\d+-[a-z-]+\.png$")
            self.assertFalse(any(b"Patient" in t or b"PHI" in t for t in texts))
        for s in scan["series"]:
            if s["role"] == "colour-copy":
                self.assertIn("colours", s["thumbnail_reason"])

    def test_roles_are_corrected_by_hand(self):
        series = {s["role"]: s for s in cli_json("scan", self.patient / "mre")["series"]}
        uid = series["magnitude"]["uid"]
        scan = cli_json("scan", self.patient / "mre", "--role", f"{uid}=stiffness")
        self.assertEqual([s["role_reason"] for s in scan["series"] if s["uid"] == uid], ["set by hand"])
        # Now the magnitude counts as the stiffness map; nobody says in which unit it is.
        self.assertIn("--unit", self.measured(self.patient / "mre", "--role", f"{uid}=stiffness", code=3))
        by_hand = self.measured(self.patient / "mre", "--role", f"{uid}=stiffness", "--unit", "kPa")
        self.assertTrue(any("Pa or kPa?" in w for w in by_hand["warnings"]))
        self.assertIn("no series", self.measured(self.patient / "mre", "--role", "1.2.3=stiffness", code=3))
        self.assertIn("no role", self.measured(self.patient / "mre", "--role", f"{uid}=stiff", code=3))

    def changed(self, name, **attributes):
        target = self.folder / name
        shutil.copytree(self.patient / "mre", target)
        for file in target.rglob("*"):
            if file.is_file():
                data = pydicom.dcmread(file)
                for key, value in attributes.items():
                    setattr(data, key, value)
                data.save_as(file)
        return target

    def test_other_patient_day_or_frame_of_reference(self):
        for name, attributes, words in (("patient", {"PatientID": "someone else"}, "different patients"),
                                        ("day", {"StudyDate": "20010203"}, "different days")):
            mre = self.changed(name, **attributes)
            said = self.measured(mre, code=3)
            self.assertIn(words, said)
            self.assertIn("--override", said)
            self.assertNotIn("20010203", said)
            warnings = self.measured(mre, "--override")["warnings"]
            self.assertTrue(any(words in w and "overridden by the user" in w for w in warnings), warnings)
        moved = self.changed("moved", FrameOfReferenceUID="1.2.3.4.5")
        self.assertTrue(any("different frames of reference" in w and "--override" in w for w in self.measured(moved)["warnings"]))

    @unittest.skipUnless((DATA / "siemens_mre_phase").exists(), "the folder of real data is not beside this checkout")
    def test_mosaics_are_volumes_with_their_step(self):
        folder = DATA / "siemens_mre_phase" / "phase_046"
        scan = cli_json("scan", folder)
        self.assertEqual([(s["encoding_direction"], s["time_step"]) for s in scan["series"]],
                         [(d, t) for d in range(3) for t in range(8)])
        self.assertEqual({(s["columns"], s["rows"], s["slices"]) for s in scan["series"]}, {(110, 108, 5)})
        uid = scan["series"][3]["uid"]
        cli("convert", folder, self.folder / "fourth.nii", "--series", uid, "--quiet")
        theirs = sorted((DATA / "siemens_mre_phase" / "nifti_spm").glob("f*.nii"))[3]
        stored = read_nifti(theirs)[2]
        self.assertEqual(sorted(read_nifti(self.folder / "fourth.nii")[2]), sorted(2.0 * v - 4096.0 for v in stored))


if __name__ == "__main__":
    unittest.main()
