# SPDX-License-Identifier: GPL-3.0-or-later
"""How sure: intervals, probability and sources of a run, in JSON, vessels.csv and the report; nothing of them unasked."""
import csv
import hashlib
import json
import math
import pathlib
import tempfile
import unittest

from support import cli, cli_json, SceneTest, write_scene
from test_contact import BAR, BLOCK, SHELF

COMPARED = {**BLOCK, "geometry": {**BLOCK["geometry"], "cell_mm": 5}, "compare": {"against": "atlas", "youngs_kPa": 9.0}}


class Uncertainty(SceneTest):
    def test_unasked_there_is_none(self):
        r = self.run_scene(COMPARED)
        self.assertNotIn("uncertainty", r)
        self.assertNotIn("interval95", r["difference"])
        step = next(s for s in r["plan"] if s["step"] == "uncertainty")
        self.assertFalse(step["needed"])

    def test_intervals_hold_the_figures_and_sources_are_named(self):
        r = self.run_scene({**COMPARED, "outputs": ["report"]}, "--uncertainty")
        d, u = r["difference"], r["uncertainty"]
        self.assertTrue(u["known"])
        for key in ("mean_mm", "at_retractor_mm", "travel_mm"):
            low, high = d["interval95"][key]
            self.assertLess(low, d[key], key)
            self.assertGreater(high, d[key], key)
        self.assertTrue(0 <= d["probability_beyond_5mm"] <= 1)
        names = [s["name"] for s in u["sources"]]
        # A box is exact, its stiffness was not measured, and its force was given.
        self.assertEqual(names, ["poisson", "force", "bar-place", "bar-direction", "solver", "cells", "beyond-first-order"])
        for s in u["sources"]:
            self.assertGreaterEqual(s["sd_mm"], 0)
            self.assertTrue(s["spread"] and s["reference"])
        self.assertIn("probability", u["sentence"])
        self.assertIn("How sure?", (self.folder / "out/report.html").read_text())
        written = json.loads((self.folder / "out/scene.json").read_text())
        self.assertEqual(written["uncertainty"]["checks"], 2)
        again = self.run_scene({**COMPARED, "outputs": ["report"], "uncertainty": written["uncertainty"]})
        self.assertEqual(again["difference"]["interval95"], d["interval95"])

    def test_it_is_shown_in_pictures_and_beside_every_figure(self):
        r = self.run_scene({**COMPARED, "outputs": ["report"]}, "--uncertainty")
        step = next(s for s in r["plan"] if s["step"] == "uncertainty-pictures")
        self.assertTrue(step["needed"])
        # A box has no vessels: neither their chart nor their 3-D picture.
        shown = {f for f in r["files"] if f.startswith(("tornado", "probability", "how-sure"))}
        self.assertEqual(shown, {"tornado-retractor.png", "probability-map.png"})
        report = (self.folder / "out/report.html").read_text()
        low, high = r["difference"]["interval95"]["at_retractor_mm"]
        self.assertIn(f"(95 %: {low:.3g} to {high:.3g} mm)", report)
        self.assertIn(r["uncertainty"]["for_surgeons"]["en"], report)
        self.assertIn("mit 95 % Wahrscheinlichkeit", r["uncertainty"]["for_surgeons"]["de"])
        self.assertEqual(r["language"], "en")

    def test_without_it_there_is_no_picture_of_it(self):
        r = self.run_scene({**COMPARED, "outputs": ["report"]})
        step = next(s for s in r["plan"] if s["step"] == "uncertainty-pictures")
        self.assertFalse(step["needed"])
        self.assertIn("does not say how sure", step["why"])
        self.assertFalse([f for f in r["files"] if f.startswith(("tornado", "probability", "how-sure"))])

    def test_german_pictures_come_from_run_render_and_replay_alike(self):
        scene = {**COMPARED, "outputs": ["report"], "uncertainty": {"checks": 0}}
        self.run_scene(scene)
        digest = lambda folder, name: hashlib.sha256((folder / name).read_bytes()).hexdigest()
        names = ("tornado-retractor.png", "probability-map.png")
        english = {n: digest(self.folder / "out", n) for n in names}
        drawn = {f["file"]: f["sha256"] for f in cli_json("render", self.folder / "out", "--language", "de", "--output",
                                                          self.folder / "de")["files"]}
        r = self.run_scene(scene, "--language", "de")
        self.assertEqual(r["language"], "de")
        for n in names:
            self.assertNotEqual(drawn[n], english[n], n)
            self.assertEqual(drawn[n], digest(self.folder / "out", n), n)
        self.assertIn(r["uncertainty"]["for_surgeons"]["de"], (self.folder / "out/report.html").read_text())
        again = cli_json("replay", self.folder / "out")
        self.assertTrue(again["numbers_identical"])
        self.assertTrue(all(f["identical"] for f in again["outputs"]), again["outputs"])

    def test_what_the_stiffness_does_is_what_stiffer_and_softer_blocks_do(self):
        u = self.run_scene({**COMPARED, "uncertainty": {"checks": 0}})["uncertainty"]
        leverage = u["stiffness_leverage"]
        self.assertEqual(leverage["figure"], u["sd_of"])
        by = 1.02
        apart = [self.run_scene({**COMPARED, "material": {"youngs_kPa": 6.09 * f, "poisson": 0.45}})["difference"]["at_retractor_mm"]
                 for f in (by, 1 / by)]
        self.assertAlmostEqual(leverage["per_10_percent_mm"], 0.1 * (apart[0] - apart[1]) / (2 * math.log(by)),
                               delta=0.03 * abs(leverage["per_10_percent_mm"]))
        self.assertTrue(0 < leverage["half_mL"] < 0.5 * 960)  # of a block of 960 mL
        self.assertTrue(10 < leverage["half_within_mm"] < 80)

    def test_a_source_that_is_left_out_is_not_there_and_a_wider_one_widens(self):
        narrow = self.run_scene({**COMPARED, "uncertainty": {"bar_mm": 0, "bar_deg": 0, "poisson": 0, "checks": 0}})
        names = [s["name"] for s in narrow["uncertainty"]["sources"]]
        self.assertEqual(names, ["force", "solver", "cells"])
        wide = self.run_scene({**COMPARED, "uncertainty": {"bar_mm": 0, "bar_deg": 0, "poisson": 0, "checks": 0,
                                                           "force_percent": 30}})
        width = lambda r: r["difference"]["interval95"]["travel_mm"][1] - r["difference"]["interval95"]["travel_mm"][0]
        self.assertAlmostEqual(width(wide), 3 * width(narrow), delta=0.1 * width(wide))

    def test_what_is_no_answer_has_none_and_a_patch_is_told(self):
        slipped = self.run_scene({**SHELF, "compare": {"against": "atlas", "youngs_kPa": 12.0}, "uncertainty": True}, code=4)
        self.assertNotIn("uncertainty", slipped)
        self.assertIsNone(slipped["difference"])
        patch = self.run_scene({**COMPARED, "loads": [{**BAR, "contact": "patch"}], "kinematics": "linear",
                                "uncertainty": True})
        self.assertNotIn("uncertainty", patch)
        self.assertIn("uncertainty-not-offered", {d["code"] for d in patch["diagnostics"]})

    def test_bad_spreads_are_refused(self):
        for bad in ({"force_percent": -1}, {"fields": 2}, {"poisson": 0.4}, {"colour": 1}, "yes"):
            cli("plan", write_scene(self.folder, {**COMPARED, "uncertainty": bad}), "--quiet", code=3)


class Patient(unittest.TestCase):
    def test_every_vessel_has_its_spread(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            cli("phantom", "--cases", 1, "--seed", 3, "--output", folder, "--quiet")
            path = folder / "patient-001/scene.json"
            scene = json.loads(path.read_text())
            scene["geometry"]["cell_mm"] = 8
            scene["outputs"] = ["vessels", "report"]
            scene["uncertainty"] = {"fields": 8, "checks": 1}
            path.write_text(json.dumps(scene))
            r = cli_json("run", path, "--output", folder / "out")
            u = r["uncertainty"]
            if not u["known"]:
                self.fail(u["why"])
            self.assertEqual([s["name"] for s in u["sources"]][:3],
                             ["elastogram-noise", "elastogram-repeatability", "outline"])
            for key in ("vessels_mean_mm", "vessels_max_mm"):
                low, high = r["difference"]["interval95"][key]
                figure = r["difference"]["vessels"]["max_mm" if "max" in key else "mean_mm"]
                self.assertTrue(low <= figure <= high, key)
            low, high = r["difference"]["interval95"]["vessels_fraction_beyond_5mm"]
            self.assertTrue(0 <= low <= r["difference"]["vessels"]["fraction_beyond_5mm"] <= high <= 1)
            for name in ("tornado-retractor.png", "tornado-vessel.png", "probability-map.png"):
                self.assertIn(name, r["files"])
            tip = u["vessel_tip"]
            self.assertTrue(0 < tip["within95_mm"] < 100)
            for number in (tip["moves_mm"], tip["difference"]["mm"]):
                written = f"{number:.1f}" if number < 9.95 else f"{number:.0f}"
                self.assertIn(written + " mm", u["for_surgeons"]["en"])
                self.assertIn(written.replace(".", ",") + " mm", u["for_surgeons"]["de"])
            with open(folder / "out/vessels.csv") as f:
                rows = [row for row in csv.DictReader(f) if row["difference_mm"]]
            self.assertGreater(len(rows), 100)
            inside = 0
            for row in rows:
                self.assertGreater(float(row["sd_mm"]), 0)
                self.assertGreater(float(row["atlas_sd_mm"]), 0)
                self.assertTrue(0 <= float(row["probability_beyond_5mm"]) <= 1)
                low, high = float(row["difference_low_mm"]), float(row["difference_high_mm"])
                self.assertLessEqual(low, high)
                inside += low <= float(row["difference_mm"]) <= high
                if row["landmark"] == str(tip["landmark"]):
                    self.assertAlmostEqual(float(row["difference_mm"]), tip["difference"]["mm"], delta=1e-3)
                    self.assertAlmostEqual(float(row["probability_beyond_5mm"]), tip["difference"]["probability_beyond_5mm"])
                    # Of one direction to all alike.
                    self.assertTrue(1.5 * float(row["sd_mm"]) < tip["within95_mm"] < 2.1 * float(row["sd_mm"]))
            self.assertGreater(inside, 0.9 * len(rows))


if __name__ == "__main__":
    unittest.main()
