# SPDX-License-Identifier: GPL-3.0-or-later
"""A case as the workstation saves it, run by the command line; and what is said where it is not whole."""
import hashlib
import json
import pathlib
import shutil
import tempfile
import unittest

from support import cli, cli_json, write_scene

SCENE = {
    "schema": "glisson/scene/1",
    "geometry": {"kind": "box", "size_mm": [60, 12, 12], "cell_mm": [3, 3, 3]},
    "material": {"youngs_kPa": 12, "poisson": 0.45, "density_kg_m3": 1060},
    "supports": [{"region": {"face": "x-"}, "kind": "fixed"}],
    "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -40]}],
    "outputs": [{"probe": [[60, 6, 6]]}],
}
CONTOURS = {"schema": "glisson/contours/1", "name": "liver", "frame_of_reference_uid": "", "series_uid": "", "polygons": []}


def digest(text):
    return hashlib.sha256(text.encode()).hexdigest()


def seal(record):
    """The digest of a case is over all of it but itself: keys sorted, no white space."""
    record.pop("sha256", None)
    record["sha256"] = digest(json.dumps(record, sort_keys=True, separators=(",", ":"), ensure_ascii=False))
    return record


def write_case(folder, scene=None, contours=CONTOURS, version=1, patient=".."):
    """Writes a case as pipeline/case_folder does."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    texts = {"contours": json.dumps(contours), "scene": json.dumps(scene or SCENE)}
    for name, text in texts.items():
        (folder / f"{name}.json").write_text(text)
    record = seal({
        "schema": "glisson/case/1", "written_by": "0", "saved": "2026-01-01T00:00:00Z", "version": version,
        "patient": {"source": "/gone", "source_relative": patient, "series_uid": "", "roles": {}},
        **{name: {"file": f"{name}.json", "sha256": digest(text)} for name, text in texts.items()},
        "slices": [], "measure": {"inner_roi": False, "erosion_pixels": 3}, "parameters": {}})
    (folder / "case.json").write_text(json.dumps(record, indent=1))
    return folder / "case.json"


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def refused(self, *words, verb="run"):
        process = cli(verb, self.folder / "case" / "case.json", code=3)
        self.assertEqual(process.stdout, "")
        self.assertEqual(len(process.stderr.strip().splitlines()), 1, process.stderr)
        for word in words:
            self.assertIn(word, process.stderr)

    def test_a_case_runs_as_its_scene_does(self):
        case = write_case(self.folder / "case")
        scene = write_scene(self.folder, {k: v for k, v in SCENE.items() if k != "schema"})
        one = cli_json("run", case, "--output", self.folder / "a")
        other = cli_json("run", scene, "--output", self.folder / "b")
        self.assertEqual(one["results_sha256"], other["results_sha256"])
        self.assertEqual(one["probes"], other["probes"])
        # Its folder is as good as its file; other verbs that take a scene take a case.
        self.assertEqual(cli_json("plan", self.folder / "case")["plan"], cli_json("plan", scene)["plan"])

    def test_results_go_beside_the_case_where_no_folder_is_named(self):
        case = write_case(self.folder / "case")
        cli("run", case, "--quiet")
        self.assertTrue((self.folder / "case" / "glisson-run" / "run.json").exists())

    def test_a_case_that_is_not_there(self):
        self.refused("case.json")

    def test_what_is_no_json(self):
        write_case(self.folder / "case").write_text("{")
        self.refused("not valid JSON", "no older version")

    def test_another_schema(self):
        case = write_case(self.folder / "case")
        record = json.loads(case.read_text())
        record["schema"] = "glisson/case/9"
        case.write_text(json.dumps(seal(record)))
        self.refused("glisson/case/1", "another version")

    def test_an_edit_by_hand_is_seen(self):
        case = write_case(self.folder / "case")
        case.write_text(case.read_text().replace('"version": 1', '"version": 2'))
        self.refused("'case.json'", "SHA-256")
        write_case(self.folder / "case")
        (self.folder / "case" / "scene.json").write_text(json.dumps(SCENE).replace("12, 12", "12, 13"))
        self.refused("'scene.json'", "SHA-256", verb="plan")

    def test_a_missing_file_is_named(self):
        write_case(self.folder / "case")
        (self.folder / "case" / "contours.json").unlink()
        self.refused("contours.json", "missing")

    def test_the_newest_whole_version_is_named_and_runs(self):
        write_case(self.folder / "case" / "versions" / "000001", patient="../..")
        write_case(self.folder / "case", version=2)
        (self.folder / "case" / "contours.json").write_text("{}")
        self.refused("versions/000001")
        cli("run", self.folder / "case" / "versions" / "000001" / "case.json", "--output", self.folder / "a", "--quiet")

    def test_a_saving_broken_off_gives_the_case_before(self):
        case = write_case(self.folder / "case")
        kept = self.folder / "case" / "versions" / "000001"
        kept.mkdir(parents=True)
        for name in ("case.json", "contours.json", "scene.json"):
            shutil.copy(self.folder / "case" / name, kept / name)
        before = cli_json("run", case, "--output", self.folder / "a")
        heavier = {**SCENE, "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -80]}]}
        (self.folder / "case" / "scene.json").write_text(json.dumps(heavier))  # and no further
        after = cli_json("run", case, "--output", self.folder / "b")
        self.assertEqual(after["results_sha256"], before["results_sha256"])

    def test_a_patient_that_is_gone(self):
        write_case(self.folder / "case", patient="../nowhere")
        self.refused("images of this case")


if __name__ == "__main__":
    unittest.main()
