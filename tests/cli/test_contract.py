# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line as the contract has it: scenes on boxes and masks against closed forms, errors, exit codes."""
import json
import unittest

from support import cli, cli_json, SceneTest, write_nifti, write_scene

BEAM = {"geometry": {"kind": "box", "size_mm": [50, 10, 10], "cell_mm": 1.6667},
        "material": {"youngs_kPa": 12, "poisson": 0.3},
        "supports": [{"region": {"face": "x-"}, "kind": "fixed"}],
        "outputs": [{"probe": [[50, 5, 5]]}]}


class Contract(SceneTest):
    def refused(self, scene, *words):
        process = cli("run", write_scene(self.folder, scene), "--output", self.folder / "out", "--quiet", code=3)
        self.assertEqual(process.stdout, "")
        self.assertEqual(len(process.stderr.strip().splitlines()), 1, process.stderr)
        for word in words:
            self.assertIn(word, process.stderr)

    def test_beam_bends_as_the_converged_solution(self):
        # Body force with an Euler-Bernoulli tip of 1 mm: f = 8 E I / (L^4 A) per volume; converged 3-D tip 1.0239 mm.
        I, A, L = 10e-3 * (10e-3) ** 3 / 12, 1e-4, 50e-3
        force = 1e-3 * 8 * 12e3 * I / L**4 / A
        r = self.run_scene({**BEAM, "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -force]}]})
        self.assertAlmostEqual(r["probes"][0]["u_mm"][2], -1.0239, delta=0.0164)
        self.assertTrue(r["solver"]["converged"])
        self.assertAlmostEqual(r["reaction_N"][2], -r["load_N"][2], delta=1e-6 * abs(r["load_N"][2]))
        self.assertAlmostEqual(r["load_N"][2], -force * 5e-6, delta=1e-9)
        for key in ("plan", "model", "solver", "steps", "probes", "energy_J", "max_strain", "max_rotation_deg", "validity"):
            self.assertIn(key, r)
        for key in ("dofs", "cells", "volume_mL", "mass_kg"):
            self.assertIn(key, r["model"])
        self.assertAlmostEqual(r["model"]["volume_mL"], 5.0, places=9)

    def test_linear_answers_say_in_mm_what_linear_theory_misses(self):
        load = {"kind": "traction", "region": {"face": "x+"}, "kPa": [0, 0, -0.002]}
        small = self.run_scene({**BEAM, "loads": [load]})
        gap = small["linear_gap_mm"]
        self.assertTrue(gap["known"] and gap["stable"])
        self.assertLess(gap["mean"], gap["max"])
        self.assertLess(gap["max"], 0.2)
        self.assertTrue(small["kinematics_valid"])
        large = self.run_scene({**BEAM, "loads": [{**load, "kPa": [0, 0, -0.02]}]})
        self.assertAlmostEqual(large["linear_gap_mm"]["max"] / gap["max"], 100, delta=40)
        self.assertGreater(large["linear_gap_mm"]["max"], 0.2)
        self.assertFalse(large["kinematics_valid"])
        self.assertTrue(any("linear theory misses" in line for line in large["validity"]), large["validity"])

    def test_bars_that_no_instrument_is_are_refused(self):
        bar = {"kind": "retractor", "at": [40, 10, 5]}
        self.refused({**BEAM, "loads": [{**bar, "force": -10}]}, "force", "direction")
        self.refused({**BEAM, "loads": [{**bar, "length_mm": 500}]}, "length_mm", "300")
        self.refused({**BEAM, "loads": [{**bar, "diameter_mm": 0.1}]}, "diameter_mm", "between 1 and 100")

    def test_hanging_bar(self):
        r = self.run_scene({**BEAM, "material": {"youngs_kPa": 12, "poisson": 0.0},
                            "loads": [{"kind": "body_force", "N_per_m3": [1060 * 9.81, 0, 0]}]})
        self.assertAlmostEqual(r["probes"][0]["u_mm"][0], 1060 * 9.81 * 0.05**2 / (2 * 12e3) * 1e3, places=6)

    def test_moving_least_squares_says_how_many_frames_had_room(self):
        I, A, L = 10e-3 * (10e-3) ** 3 / 12, 1e-4, 50e-3
        force = 1e-3 * 8 * 12e3 * I / L**4 / A
        load = [{"kind": "body_force", "N_per_m3": [0, 0, -force]}]
        model = {"kind": "meshfree", "kernel": "mls", "order": 2, "frames": 200}
        r = self.run_scene({**BEAM, "loads": load, "model": model})
        self.assertAlmostEqual(r["probes"][0]["u_mm"][2], -1.0239, delta=0.0164)
        self.assertTrue(r["discretisation_error"]["known"], r["discretisation_error"]["note"])
        self.assertEqual(r["model"]["dofs"], 3 * r["model"]["frames"])
        self.assertEqual(r["model"]["frames_asked"], 200)
        clamped = self.run_scene({**BEAM, "loads": load, "model": {**model, "frames": 5000}})
        self.assertLess(clamped["model"]["frames"], 5000)
        self.assertTrue(any("instead of 5000" in line for line in clamped["validity"]), clamped["validity"])
        why = [step["why"] for step in clamped["plan"] if step["step"] == "mesh-free-frames"][0]
        self.assertIn("5000", why)

    def test_tradeoff_has_every_key_and_no_row_twice(self):
        scene = {**BEAM, "geometry": {**BEAM["geometry"], "cell_mm": 2.5},
                 "loads": [{"kind": "traction", "region": {"face": "x+"}, "kPa": [0, 0, -0.005]}]}
        r = cli_json("tradeoff", write_scene(self.folder, scene), "--quick", "--output", self.folder / "out")
        seen = set()
        for row in r["rows"]:
            self.assertLessEqual({"method", "resolution", "dofs", "build_s", "solve_s", "step_ms", "max_error_mm",
                                  "tip_error_mm", "reference", "pareto"}, set(row))
            self.assertNotIn((row["method"], row["resolution"]), seen)
            seen.add((row["method"], row["resolution"]))
        self.assertLessEqual({"T4", "T10", "MLS quadratic", "Condensed", "Corotational"}, {m for m, _ in seen})
        self.assertTrue((self.folder / "out/tradeoff.png").is_file())

    def test_second_order_schemes_damp_nothing_and_the_trade_off_shows_it(self):
        load = [{"kind": "body_force", "N_per_m3": [0, 0, -400]}]
        moving = {**BEAM, "loads": load, "geometry": {**BEAM["geometry"], "cell_mm": 5}}

        def tip(scheme, h_ms):
            analysis = {"kind": "dynamic", "h_ms": h_ms, "end_s": 0.24, "stop_when_steady": 0, **scheme}
            return self.run_scene({**moving, "analysis": analysis})["probes"][0]["u_mm"][2]

        alpha = {"scheme": "generalised-alpha", "spectral_radius": 0.9}
        truth = tip(alpha, 0.5)
        second, euler = abs(tip({"scheme": "newmark"}, 4) - truth), abs(tip({}, 4) - truth)
        self.assertLess(second, 0.2 * euler)
        self.assertLess(abs(tip(alpha, 4) - truth), 0.2 * euler)
        bad = {**moving, "analysis": {"kind": "dynamic", "scheme": "generalised-alpha", "spectral_radius": 1.5}}
        self.refused(bad, "spectral_radius", "0 to 1")
        condensed = {**moving, "analysis": {"kind": "dynamic", "scheme": "newmark"}, "solver": {"kind": "condensed"}}
        self.refused(condensed, "newmark", "scheme")
        study = cli_json("tradeoff", write_scene(self.folder, {**moving, "analysis": {
            "kind": "dynamic", "h_ms": 8, "end_s": 0.24}}), "--quick", "--output", self.folder / "study")
        errors = {}
        for row in study["rows"]:
            if "on the same cells" in row["reference"] and "steps of 8 ms" in row["resolution"]:
                errors[row["method"]] = row["max_error_mm"]
        self.assertEqual(len(errors), 3, errors)
        self.assertEqual([f["name"] for f in study["families"]], ["time"])
        self.assertTrue((self.folder / "study/tradeoff-time.png").is_file())
        self.assertLess(errors["Newmark, average acceleration"], 0.5 * errors["Implicit Euler"])
        self.assertLess(errors["Generalised alpha"], 0.5 * errors["Implicit Euler"])

    def test_dynamic_settles_at_the_static_answer(self):
        load = [{"kind": "traction", "region": {"face": "x+"}, "kPa": [0.1, 0, 0]}]
        static = self.run_scene({**BEAM, "loads": load, "geometry": {**BEAM["geometry"], "cell_mm": 5}})
        dynamic = self.run_scene({**BEAM, "loads": load, "geometry": {**BEAM["geometry"], "cell_mm": 5},
                                  "analysis": {"kind": "dynamic", "h_ms": 20, "end_s": 20, "rayleigh": [5, 0.02],
                                               "stop_when_steady": 1e-8}})
        self.assertGreater(dynamic["steps"], 1)
        u, v = static["probes"][0]["u_mm"][0], dynamic["probes"][0]["u_mm"][0]
        self.assertAlmostEqual(u, v, delta=1e-6 * u)

    def test_mask_and_map_are_the_box_that_they_describe(self):
        # The same bar as a box and as a mask with a map in Pa: RAS axes in the file, LPS in the scene.
        n = (10, 4, 4)
        write_nifti(self.folder / "m.nii.gz", [5] * 160, n, (5, 5, 5), (0, 0, 0), "B")
        write_nifti(self.folder / "E.nii.gz", [12000.0] * 160, n, (5, 5, 5))
        box = self.run_scene({"geometry": {"kind": "box", "size_mm": [50, 20, 20], "cell_mm": 5},
                              "material": {"youngs_kPa": 12, "poisson": 0.4}, "supports": BEAM["supports"],
                              "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -500]}],
                              "outputs": [{"probe": [[50, 10, 10]]}]})
        # File x grows to the right, so the LPS x- face is the file's last layer; the free end is at LPS x = 2.5.
        mask = self.run_scene({"geometry": {"kind": "mask", "file": "m.nii.gz", "label": 5},
                               "material": {"map": "E.nii.gz", "quantity": "youngs", "unit": "Pa", "poisson": 0.4},
                               "supports": BEAM["supports"],
                               "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -500]}],
                               "outputs": [{"probe": [[2.5, -7.5, 7.5]]}]})
        for a, b in zip(box["probes"][0]["u_mm"], mask["probes"][0]["u_mm"]):
            self.assertAlmostEqual(a, b, delta=1e-7)
        self.assertEqual(box["model"]["cells"], mask["model"]["cells"])

    def test_load_scales_and_zero_load_is_exactly_zero(self):
        def tip(f):
            return self.run_scene({**BEAM, "geometry": {**BEAM["geometry"], "cell_mm": 5},
                                   "loads": [{"kind": "body_force", "N_per_m3": [0, 0, f]}]})["probes"][0]["u_mm"][2]
        one = tip(-1.0)
        self.assertEqual(tip(0.0), 0.0)
        for factor in (1e-15, 1e15):
            self.assertAlmostEqual(tip(-factor) / (one * factor), 1.0, delta=1e-10)

    def test_cg_stopped_at_its_limit_says_so(self):
        r = self.run_scene({**BEAM, "material": {"youngs_kPa": 12, "poisson": 0.49},
                            "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -40]}],
                            "solver": {"kind": "cg", "iterations": 200, "tolerance": 1e-8, "preconditioner": "none"}}, code=4)
        self.assertFalse(r["solver"]["converged"])
        self.assertEqual(r["solver"]["iterations"], 200)
        self.assertGreater(r["solver"]["residual"], 1e-8)

    def test_refusals_name_the_cause(self):
        load = [{"kind": "body_force", "N_per_m3": [0, 0, -40]}]
        self.refused({**BEAM, "supports": [], "loads": load}, "free", "6")
        self.refused({**BEAM, "loads": load, "colour": 1}, "colour", "line")
        self.refused({**BEAM, "loads": load, "material": {"youngs_kPa": 0}}, "youngs_kPa")
        self.refused({**BEAM, "loads": load, "material": {"youngs_kPa": 12, "poisson": 0.5}}, "poisson")
        self.refused({**BEAM, "loads": load, "supports": [{"region": {"box_mm": [[90, 0, 0], [99, 9, 9]]}, "kind": "fixed"}]},
                     "box_mm")
        self.refused({**BEAM, "loads": [{"kind": "pressure", "region": {"surface": "inner"}, "kPa": 1}]}, "cavity")

    def test_plan_gives_reasons_and_run_measures(self):
        scene = {**BEAM, "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -40]}]}
        for step in cli_json("plan", write_scene(self.folder, scene))["plan"]:
            self.assertTrue(step["why"], step)
        r = self.run_scene(scene)
        needed = {s["step"]: s["needed"] for s in r["plan"]}
        self.assertFalse(needed["mass-matrix"])
        self.assertFalse(needed["3d-overlay"])
        self.assertTrue(needed["solve"])

    def test_usage_errors_are_2_and_help_is_0(self):
        cli("run", code=2)
        cli("no-such-verb", code=2)
        cli("--help")
        cli("run", "--help")
        self.assertIn("glisson-cli", cli("--version").stdout)
        cli("run", self.folder / "none.json", code=3)

    def test_threads_do_not_change_a_bit(self):
        scene = {**BEAM, "loads": [{"kind": "body_force", "N_per_m3": [3, 0, -40]}]}
        answers = [json.dumps([r["probes"], r["energy_J"], r["reaction_N"]]) for r in
                   (self.run_scene(scene, "--threads", t) for t in (1, 2, 4))]
        self.assertEqual(len(set(answers)), 1)

    def test_numbers_are_written_alike_in_every_locale(self):
        scene = write_scene(self.folder, {**BEAM, "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -40]}]})
        plain = cli_json("run", scene, "--output", self.folder / "a")["probes"]
        for locale in ("de_DE.UTF-8", "tr_TR.UTF-8"):
            self.assertEqual(plain, cli_json("run", scene, "--output", self.folder / "b", env={"LC_ALL": locale, "LANG": locale})["probes"])

    def test_measure_reads_pa_kpa_and_hundredths(self):
        n = (8, 6, 3)
        mask = [1 if 2 <= i % 8 < 6 and 1 <= i // 8 % 6 < 5 else 0 for i in range(144)]
        write_nifti(self.folder / "roi.nii.gz", mask, n, (1.5, 1.5, 10), kind="B")
        values = [2.0 + 0.01 * (i % 7) for i in range(144)]
        inside = [v for v, m in zip(values, mask) if m]
        for factor, unit in ((1000.0, "Pa"), (1.0, "kPa"), (100.0, "0.01kPa")):
            write_nifti(self.folder / "mu.nii", [factor * v for v in values], n, (1.5, 1.5, 10))
            r = cli_json("measure", "--mre", self.folder / "mu.nii", "--roi", self.folder / "roi.nii.gz", "--quantity", "shear",
                         "--unit", unit)
            self.assertEqual(r["quantity"], "shear")
            self.assertEqual(r["pooled"]["n"], len(inside))
            self.assertEqual(r["pooled"]["n_before_mask"], len(inside))
            self.assertAlmostEqual(r["pooled"]["mean_kPa"], sum(inside) / len(inside), places=5)
            self.assertAlmostEqual(r["pooled"]["area_mm2"], len(inside) * 2.25, places=6)
            self.assertEqual(len(r["slices"]), 3)
            self.assertAlmostEqual(r["youngs_mean_kPa"], 3 * sum(inside) / len(inside), places=4)
        process = cli("measure", "--mre", self.folder / "mu.nii", "--roi", self.folder / "roi.nii.gz", code=3)
        self.assertIn("quantity", process.stderr)


if __name__ == "__main__":
    unittest.main()
