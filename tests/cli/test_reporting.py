# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run says of itself: codes and values beside the sentences, each fact once, nothing passed over in silence."""
import json
import math
import unittest

from support import cli, cli_json, folder_of_test, write_nifti, write_scene

BAR = {"kind": "retractor", "at": [80, 60, 50], "force": 4.6}
BLOCK = {"geometry": {"kind": "box", "size_mm": [160, 60, 100], "cell_mm": 10},
         "material": {"youngs_kPa": 6.09, "poisson": 0.45},
         "supports": [{"region": {"face": "y-"}, "kind": "fixed"}],
         "loads": [BAR]}
#: A shelf 10 mm thick that gives way under the bar until it slides off.
SHELF = {"geometry": {"kind": "box", "size_mm": [60, 10, 40], "cell_mm": 2.5},
         "material": {"youngs_kPa": 10, "poisson": 0.4},
         "supports": [{"region": {"face": "x-"}, "kind": "fixed"}],
         "loads": [{"kind": "retractor", "at": [52, 10, 20], "axis": [0, 0, 1], "length_mm": 60, "force": 20}]}
COMPARED = {"against": "atlas", "youngs_kPa": 9.0}


def said(record, code, where="diagnostics"):
    return [d for d in record[where] if d["code"] == code]


def on_path(path, travel):
    for (s, f), (t, g) in zip(path, path[1:]):
        if s <= travel <= t:
            return f + (travel - s) / (t - s) * (g - f)
    raise AssertionError(f"{travel} is not on the path")


class Reporting(unittest.TestCase):
    def setUp(self):
        self.folder = folder_of_test(self)

    def run_scene(self, scene, *arguments, code=0, out="out"):
        return cli_json("run", write_scene(self.folder, scene), "--output", self.folder / out, *arguments, code=code)

    def ball(self):
        """A small "liver": a ball of 60 mm in voxels of 6 mm, on a bed, under a bar."""
        n = 14
        values = [1 if sum((c - 6.5) ** 2 for c in (i % n, i // n % n, i // n**2)) < 25 else 0 for i in range(n**3)]
        write_nifti(self.folder / "ball.nii.gz", values, (n, n, n), (6, 6, 6), kind="B")
        return {"geometry": {"kind": "mask", "file": "ball.nii.gz"}, "material": {"shear_kPa": 4, "poisson": 0.45},
                "supports": [{"region": {"surface": "posterior"}, "kind": "spring", "stiffness_kPa_per_mm": 0.5}],
                "loads": [{"kind": "retractor", "force": 1.0, "length_mm": 40}]}

    def test_a_patch_that_nobody_asked_for_is_said_with_what_refuses_the_bar(self):
        refusing = (("model", {"model": {"kind": "fem-tet"}}), ("model", {"model": {"kind": "meshfree", "frames": 40}}),
                    ("time-steps", {"analysis": {"kind": "dynamic", "h_ms": 20, "end_s": 0.1, "rayleigh": [5, 0.02]}}),
                    ("corotational", {"kinematics": "corotational"}), ("condensed", {"solver": {"kind": "condensed"}}))
        for refuses, more in refusing:
            with self.subTest(refuses=refuses, more=more):
                scene = {**BLOCK, **more, "loads": [{**BAR, "force": 1.0}]}
                r = self.run_scene(scene)
                self.assertNotIn("contact", r)
                [taken] = said(r, "patch-taken")
                self.assertEqual(taken["severity"], "warning")
                self.assertEqual(taken["arguments"]["refuses"], refuses)
                self.assertEqual(r["warnings"].count(taken["text"]), 1)
                planned = cli_json("plan", write_scene(self.folder, scene))
                self.assertEqual(said(planned, "patch-taken"), [taken])
                words = " ".join(r["validity"]) + r.get("advice", "")
                if refuses == "corotational":
                    continue
                # Nothing is advised that this scene would refuse.
                self.assertEqual(r["kinematics"]["used"], "linear")
                self.assertNotIn('choose "kinematics"', words.lower())
                for gap in said(r, "linear-gap-large", "validity_diagnostics"):
                    self.assertIn({"model": '"fem-hex"', "time-steps": "static", "condensed": '"auto"'}[refuses],
                                  gap["arguments"]["instead"])
        meant = self.run_scene({**BLOCK, "model": {"kind": "fem-tet"}, "loads": [{**BAR, "contact": "patch"}]})
        self.assertEqual(said(meant, "patch-taken"), [])
        self.assertTrue(said(meant, "linear-gap-large", "validity_diagnostics"))
        self.assertIn('Take the model "fem-hex"', meant["advice"])

    def test_settings_without_use_are_noted_with_their_key(self):
        def keys(scene):
            r = self.run_scene(scene)
            again = cli_json("run", self.folder / "out/scene.json", "--output", self.folder / "again")
            self.assertEqual(again["results_sha256"], r["results_sha256"])
            notes = said(r, "setting-not-used")
            self.assertEqual({n["severity"] for n in notes} - {"note"}, set())
            return [n["arguments"]["key"] for n in notes]

        self.assertEqual(keys(BLOCK), [])
        self.assertEqual(keys({**BLOCK, "loads": [{**BAR, "spread_mm": 10}]}), ["spread_mm"])
        patch = {**BAR, "contact": "patch", "force": 0.5}
        self.assertEqual(keys({**BLOCK, "kinematics": "linear", "loads": [{**patch, "spread_mm": 5}]}), [])
        for shape in ("straight", "hook"):
            self.assertEqual(keys({**BLOCK, "kinematics": "linear", "loads": [{**patch, "shape": shape}]}), ["shape"])
        named = {"model": {"kind": "fem-hex", "element": "H8"},
                 "solver": {"kind": "cg", "iterations": 100, "tolerance": 1e-9, "preconditioner": "jacobi"}}
        self.assertEqual(keys({**BLOCK, **named}), ["model.element", "solver.kind", "solver.iterations",
                                                    "solver.preconditioner", "solver.tolerance"])

    def test_probes_outside_the_body_are_a_warning_that_names_them(self):
        scene = {**BLOCK, "outputs": [{"probe": [[80, 60, 50], [500, 0, 0], [80, 30, 50], [0, -90, 0]]}]}
        r = self.run_scene(scene)
        [outside] = said(r, "probes-outside")
        self.assertEqual(outside["severity"], "warning")
        self.assertEqual(outside["arguments"], {"count": 2, "of": 4, "probes": "1, 3"})
        self.assertEqual(r["probes"][1]["u_mm"], [None] * 3)
        self.assertIn(outside["text"], r["warnings"])

    def test_what_linear_theory_misses_under_a_bar(self):
        large = self.run_scene({**BLOCK, "compare": COMPARED})
        self.assertEqual(large["kinematics"]["used"], "hyperelastic")
        self.assertIn("only once that answer is there", large["kinematics"]["why"])
        for answer in (large, large["atlas"]):
            gap = answer["linear_gap_mm"]
            self.assertTrue(gap["known"])
            self.assertGreater(gap["at_retractor"], 0.2)
            self.assertLessEqual(gap["at_retractor"], gap["max"])
            self.assertIsNone(gap["landmarks_max"])
            self.assertFalse(answer["linear_valid"])
            self.assertTrue(answer["kinematics_valid"])
        plan = {s["step"]: s["why"] for s in large["plan"]}
        self.assertIn("does not fall back", plan["large-deformation"])
        self.assertIn("contact of bar and body", plan["solve"])
        small = self.run_scene({**BLOCK, "loads": [{**BAR, "force": 1e-3}]})
        self.assertEqual(small["kinematics"]["used"], "hyperelastic")
        self.assertLess(small["linear_gap_mm"]["max"], 0.2)
        self.assertTrue(small["linear_valid"])
        linear = self.run_scene({**BLOCK, "kinematics": "linear", "compare": COMPARED})
        for answer, other in ((linear, large), (linear["atlas"], large["atlas"])):
            for key in ("mean", "max", "at_retractor"):
                self.assertAlmostEqual(answer["linear_gap_mm"][key], other["linear_gap_mm"][key], delta=1e-3)
        self.assertFalse(linear["kinematics_valid"])
        [told] = said(linear, "linear-gap-large", "validity_diagnostics")
        self.assertEqual(told["arguments"]["instead"], 'choose "kinematics": "hyperelastic"')

    def test_a_slip_is_told_once_with_the_travel_at_its_largest_force(self):
        r = self.run_scene({**SHELF, "compare": {"against": "atlas", "youngs_kPa": 12.0}}, code=4)
        slips = {d["arguments"]["stiffness"]: d for d in said(r, "retractor-slips")}
        self.assertEqual(set(slips), {"own", "atlas"})
        for stiffness, answer in (("own", r), ("atlas", r["atlas"])):
            contact, told = answer["contact"], slips[stiffness]
            self.assertEqual(answer["validity_diagnostics"][0]["code"], "retractor-slips")
            self.assertEqual([d["text"] for d in answer["validity_diagnostics"]], answer["validity"])
            self.assertEqual(told["arguments"]["capacity_N"], contact["capacity_N"])
            self.assertEqual(told["arguments"]["capacity_travel_mm"], contact["capacity_travel_mm"])
            self.assertLessEqual(contact["capacity_travel_mm"], contact["travel_mm"] + 1e-9)
            most = max(force for _, force in contact["path"])
            # States of the path are loose; what is said to be borne is looked for between them, to a closer answer.
            self.assertAlmostEqual(on_path(contact["path"], contact["capacity_travel_mm"]), contact["capacity_N"],
                                   delta=0.03 * contact["capacity_N"])
            self.assertLess(contact["capacity_N"], 1.03 * most)
            self.assertEqual(sum("slips" in w and told["text"] in w for w in r["warnings"]), 1)
        self.assertEqual(sum("the bar slips at" in w for w in r["warnings"]), 2)

    def test_a_linear_bar_that_turns_cells_inside_out_gives_no_difference(self):
        fine = {**BLOCK, "geometry": {**BLOCK["geometry"], "cell_mm": 4}}
        r = self.run_scene({**fine, "kinematics": "linear", "compare": COMPARED})
        self.assertTrue(r["solver"]["converged"])
        self.assertLessEqual(r["contact"]["least_volume_ratio"], 0)
        self.assertIsNone(r["difference"])
        self.assertFalse(r["kinematics_valid"])
        self.assertIn("a cell is turned inside out", {d["arguments"]["reason"] for d in said(r, "difference-withheld")})
        self.assertTrue({"cells-inside-out", "bar-folds-surface"} & {d["code"] for d in r["validity_diagnostics"]})

    def test_every_sentence_on_validity_has_its_code(self):
        strained = self.run_scene({**BLOCK, "kinematics": "linear", "loads": [{**BAR, "contact": "patch", "force": 20}]})
        self.assertEqual([d["text"] for d in strained["validity_diagnostics"]], strained["validity"])
        codes = [d["code"] for d in strained["validity_diagnostics"]]
        self.assertIn("linear-gap-large", codes)
        self.assertTrue({"rotation-beyond-linear", "strain-beyond-linear"} & set(codes), codes)
        for d in strained["validity_diagnostics"]:
            if d["code"] == "rotation-beyond-linear":
                self.assertAlmostEqual(d["arguments"]["degrees"], strained["max_rotation_deg"], places=9)

    def test_figures_of_contact_say_what_they_are(self):
        r = self.run_scene(BLOCK)
        contact = r["contact"]
        self.assertAlmostEqual(contact["force_along_hoist_N"], 4.6, delta=1e-4)
        self.assertAlmostEqual(contact["resultant_N"], math.hypot(*contact["force_N"]), places=9)
        self.assertEqual(r["contact_area_mm2"], contact["footprint_mm2"])
        [note] = said(r, "contact-by-cells")
        self.assertEqual((note["severity"], note["arguments"]), ("note", {"cell_mm": 10.0}))
        self.assertEqual(r["strain_measured"], {"least_covered_fraction": 0.5, "cells_left_out": 0})
        text = cli("run", self.folder / "scene.json", "--output", self.folder / "out").stdout
        self.assertIn("4.6 N along its hoist (resultant", text)

    def test_forces_at_equal_lift_agree_with_the_answers(self):
        r = self.run_scene({**BLOCK, "compare": COMPARED})
        lift = r["difference"]["equal_lift"]
        self.assertEqual(lift["along"], "path on coarse cells")
        travel, stiffer = r["contact"]["travel_mm"], r["atlas"]["contact"]["travel_mm"]
        self.assertLess(stiffer, travel)
        self.assertAlmostEqual(lift["travel_mm"], stiffer, places=9)
        self.assertAlmostEqual(lift["atlas_force_N"], 4.6, delta=1e-4)  # there the stiffer body bears its own force
        # The softer one's path, brought to its answer: its coarse cells bear 4.6 N at another travel.
        path = r["contact"]["path"]
        there = next(a[0] + (4.6 - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) for a, b in zip(path, path[1:]) if b[1] >= 4.6)
        self.assertAlmostEqual(lift["force_N"], on_path(path, stiffer * there / travel), delta=1e-4)
        self.assertGreater(lift["atlas_force_N"], lift["force_N"])

    def test_one_answer_is_drawn_as_one_and_runs_are_named_by_folder_or_record(self):
        out = self.folder / "out"
        r = self.run_scene({**self.ball(), "outputs": ["overlay", "report"]})
        names = {f for f in r["files"] if f.endswith(".png")}
        self.assertTrue({"overlay-largest-displacement.png", "contact-pressure.png", "force-travel.png"} <= names, names)
        self.assertFalse([n for n in names if "difference" in n or "mre" in n or "atlas" in n], names)
        self.assertIn("One stiffness (uniform)", (out / "pictures.glisson").read_bytes()[:4096].decode(errors="replace"))
        page = (out / "report.html").read_text()
        self.assertNotIn("textbook in", page)
        self.assertIn("N along the hoist (resultant", page)
        drawn = [{f["file"]: f["sha256"] for f in cli_json("render", run, "--output", self.folder / name)["files"]}
                 for run, name in ((out, "by-folder"), (out / "run.json", "by-record"))]
        self.assertEqual(drawn[0], drawn[1])
        self.assertEqual(set(drawn[0]), names)
        one = cli_json("render", out / "run.json", "--slice", 6, "--output", self.folder / "slice")["files"]
        self.assertEqual([f["file"] for f in one], ["overlay-slice-6.png"])
        for run in (out, out / "run.json"):
            self.assertTrue(cli_json("replay", run)["identical"])
        cli("render", self.folder / "nowhere", "--quiet", code=3)

    def test_cells_with_little_tissue_do_not_count_as_turned(self):
        scene = self.ball()
        scene["geometry"]["cell_mm"] = 5
        r = self.run_scene(scene)
        self.assertEqual(r["strain_measured"]["least_covered_fraction"], 0.5)
        self.assertGreater(r["strain_measured"]["cells_left_out"], 0)
        self.assertLess(r["max_rotation_deg"], 90)


if __name__ == "__main__":
    unittest.main()
