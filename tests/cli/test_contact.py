# SPDX-License-Identifier: GPL-3.0-or-later
"""The retractor as a rigid bar, through the command line: figures, slip, drives, and what is withheld."""
import math
import pathlib
import unittest

from support import cli, cli_json, SceneTest, write_scene

BAR = {"kind": "retractor", "at": [80, 60, 50], "force": 4.6}
BLOCK = {"geometry": {"kind": "box", "size_mm": [160, 60, 100], "cell_mm": 4},
         "material": {"youngs_kPa": 6.09, "poisson": 0.45},
         "supports": [{"region": {"face": "y-"}, "kind": "fixed"}],
         "loads": [BAR],
         "outputs": [{"probe": [[80, 60, 50], [80, 40, 50], [80, 20, 50]]}]}
#: A shelf 10 mm thick that gives way under the bar until it slides off.
SHELF = {"geometry": {"kind": "box", "size_mm": [60, 10, 40], "cell_mm": 2.5},
         "material": {"youngs_kPa": 10, "poisson": 0.4},
         "supports": [{"region": {"face": "x-"}, "kind": "fixed"}],
         "loads": [{"kind": "retractor", "at": [52, 10, 20], "axis": [0, 0, 1], "length_mm": 60, "force": 20}]}


class Contact(SceneTest):
    def test_a_rigid_bar_is_the_default_and_dents_a_block_as_calculix_says(self):
        r = self.run_scene(BLOCK)
        self.assertEqual(r["kinematics"]["asked"], "auto")
        self.assertEqual(r["kinematics"]["used"], "hyperelastic")
        for probe, expected in zip(r["probes"], (11.7, 5.27, 1.78)):
            self.assertAlmostEqual(-probe["u_mm"][1], expected, delta=0.06 * expected)
        contact = r["contact"]
        self.assertAlmostEqual(contact["force_N"][1], -4.6, delta=1e-4)
        self.assertFalse(contact["slipped"])
        self.assertIsNone(contact["capacity_N"])
        self.assertGreater(contact["travel_mm"], 10)
        self.assertLess(contact["penetration_max_mm"], 0.5)
        self.assertLess(contact["footprint_mm2"], contact["area_mm2"])
        self.assertLess(math.hypot(*contact["moment_Nm"]), 2e-3)
        self.assertAlmostEqual(r["reaction_N"][1], 4.6, delta=1e-3)
        self.assertTrue(r["kinematics_valid"])

    def test_travel_gives_the_force_and_the_other_way_round(self):
        by_force = self.run_scene({**BLOCK, "loads": [{**BAR, "force": 2.0}]})
        travel = by_force["contact"]["travel_mm"]
        drive = {k: v for k, v in BAR.items() if k != "force"}
        by_travel = self.run_scene({**BLOCK, "loads": [{**drive, "drive": {"travel_mm": travel}}]})
        self.assertAlmostEqual(by_travel["contact"]["force_N"][1], -2.0, delta=1e-3)

    def test_two_stiffnesses_under_one_bar_and_what_is_said_of_their_difference(self):
        r = self.run_scene({**BLOCK, "compare": {"against": "atlas", "youngs_kPa": 9.0}})
        d = r["difference"]
        self.assertAlmostEqual(d["travel_mm"], r["contact"]["travel_mm"] - r["atlas"]["contact"]["travel_mm"], places=9)
        self.assertGreater(d["travel_mm"], 0)  # the softer of the two gives way further
        # The tissue that the bar holds goes with it, so at the bar the difference is about that of the travel.
        self.assertAlmostEqual(d["at_retractor_mm"], d["travel_mm"], delta=0.2 * d["travel_mm"])
        self.assertLess(d["mean_mm"], d["at_retractor_mm"])
        self.assertGreater(d["equal_lift"]["atlas_force_N"], d["equal_lift"]["force_N"])
        self.assertIn("window_at_rest_mm", d)
        self.assertIn("contact_mean_mm", d)

    def test_what_a_place_does_not_bear_is_said_and_nothing_is_compared(self):
        r = self.run_scene({**SHELF, "compare": {"against": "atlas", "youngs_kPa": 12.0}}, code=4)
        self.assertTrue(r["contact"]["slipped"])
        self.assertGreater(r["contact"]["capacity_N"], 0)
        self.assertLess(r["contact"]["capacity_N"], 20)
        self.assertIsNone(r["difference"])
        codes = {d["code"] for d in r["diagnostics"]}
        self.assertTrue({"retractor-slips", "difference-withheld"} <= codes, codes)
        for d in r["diagnostics"]:
            self.assertEqual(set(d), {"code", "severity", "text", "arguments"})
            if d["severity"] != "note":
                self.assertIn(d["text"], r["warnings"])

    def test_a_force_that_a_soft_body_does_not_bear_ends_with_what_gave_way(self):
        # The surface beside the bar folds before 2 N are reached: on these cells no stable state bears them.
        soft = {"geometry": {"kind": "box", "size_mm": [80, 60, 40], "cell_mm": 2.5},
                "material": {"shear_kPa": 1.0, "poisson": 0.45}, "supports": [{"region": {"face": "z-"}, "kind": "fixed"}],
                "loads": [{"kind": "retractor", "at": [40, 30, 40], "axis": [0, 1, 0], "length_mm": 40, "direction": [0, 0, -1],
                           "force": 2}]}
        r = self.run_scene(soft, code=4)
        gave = [d for d in r["diagnostics"] if d["code"] in ("retractor-cuts", "retractor-folds")]
        self.assertEqual(len(gave), 1, r["diagnostics"])
        self.assertTrue(1 < gave[0]["arguments"]["capacity_N"] < 2)
        self.assertNotIn("not-converged", {d["code"] for d in r["diagnostics"]})

    def test_a_patch_is_still_there_where_it_is_asked_for_or_alone_is_offered(self):
        patch = self.run_scene({**BLOCK, "loads": [{**BAR, "contact": "patch"}], "kinematics": "linear"})
        self.assertNotIn("contact", patch)
        self.assertGreater(patch["contact_area_mm2"], 0)
        frames = self.run_scene({**BLOCK, "geometry": {**BLOCK["geometry"], "cell_mm": 10},
                                 "model": {"kind": "meshfree", "frames": 40}})
        self.assertNotIn("contact", frames)
        process = cli("run", write_scene(self.folder, {**BLOCK, "loads": [{**BAR, "contact": "rigid"}],
                                                       "model": {"kind": "meshfree", "frames": 40}}),
                      "--output", self.folder / "out", "--quiet", code=3)
        self.assertIn("fem-hex", process.stderr)

    def test_contradictions_are_refused(self):
        drive = {"drive": {"travel_mm": 5}}
        for load in ({**BAR, **drive},
                     {"kind": "retractor", "at": [80, 60, 50], "contact": "patch", **drive},
                     {**BAR, "at": [80, 60, 400]}):
            cli("run", write_scene(self.folder, {**BLOCK, "loads": [load]}), "--output", self.folder / "out", "--quiet",
                code=3)

    def test_a_bed_that_only_presses_lets_go(self):
        beam = {"geometry": {"kind": "box", "size_mm": [60, 10, 10], "cell_mm": 2.5},
                "material": {"youngs_kPa": 20, "poisson": 0.3}, "kinematics": "hyperelastic",
                "outputs": [{"probe": [[60, 5, 5]]}]}
        clamp = {"region": {"face": "x-"}, "kind": "fixed"}
        bed = {"region": {"face": "z-"}, "kind": "spring", "stiffness_kPa_per_mm": 0.2, "unilateral": True}

        def held(up, *supports, kinematics="hyperelastic"):
            load = {"kind": "traction", "region": {"face": "z+"}, "kPa": [0, 0, up]}
            return self.run_scene({**beam, "supports": list(supports), "loads": [load], "kinematics": kinematics})

        def tip(up, *supports):
            return held(up, *supports)["probes"][0]["u_mm"][2]

        free_up, free_down = tip(0.002, clamp), tip(-0.002, clamp)
        self.assertAlmostEqual(tip(0.002, clamp, bed), free_up, delta=0.02 * free_up)
        self.assertLess(abs(tip(-0.002, clamp, bed)), 0.3 * abs(free_down))
        chosen = held(-0.002, clamp, bed, kinematics="auto")  # linear theory has no such bed: it is not tried
        self.assertEqual(chosen["kinematics"]["used"], "hyperelastic")
        self.assertEqual(chosen["probes"], held(-0.002, clamp, bed)["probes"])
        process = cli("run", write_scene(self.folder, {**beam, "kinematics": "linear", "supports": [clamp, bed],
                                                       "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -10]}]}),
                      "--output", self.folder / "out", "--quiet", code=3)
        self.assertIn("unilateral", process.stderr)

    def test_a_body_that_only_pressing_springs_leave_free_is_refused(self):
        # They hold along their normal: pushed onto them, the block would drift sideways; with a tangential share it is held.
        bed = {"region": {"face": "z-"}, "kind": "spring", "stiffness_kPa_per_mm": 0.5, "unilateral": True}
        block = {"geometry": {"kind": "box", "size_mm": [40, 40, 20], "cell_mm": 10}, "material": {"youngs_kPa": 6, "poisson": 0.4},
                 "loads": [{"kind": "pressure", "region": {"face": "z+"}, "kPa": 0.05, "follows": True}], "kinematics": "auto"}
        process = cli("run", write_scene(self.folder, {**block, "supports": [bed]}), "--output", self.folder / "out", "--quiet",
                      code=3)
        self.assertIn("free rigid", process.stderr)
        held = self.run_scene({**block, "supports": [{**bed, "tangential": 0.1}]})
        self.assertTrue(held["solver"]["converged"])
        self.assertLess(math.hypot(*held["load_N"][:2]), 1e-3 * abs(held["load_N"][2]))

    def test_a_pressure_that_follows_turns_with_its_face(self):
        # A soft strip, pressed sideways on one face: a dead pressure bends it further than one that turns with it.
        strip = {"geometry": {"kind": "box", "size_mm": [60, 6, 6], "cell_mm": 2},
                 "material": {"youngs_kPa": 20, "poisson": 0.3}, "kinematics": "hyperelastic",
                 "supports": [{"region": {"face": "x-"}, "kind": "fixed"}], "outputs": [{"probe": [[60, 3, 3]]}]}

        def tip(kPa, follows):
            load = {"kind": "pressure", "region": {"face": "z+"}, "kPa": kPa, "follows": follows}
            r = self.run_scene({**strip, "loads": [load]})
            self.assertTrue(r["solver"]["converged"])
            return r["probes"][0]["u_mm"]

        small = [tip(2e-5, follows)[2] for follows in (False, True)]
        self.assertAlmostEqual(small[0], small[1], delta=0.01 * abs(small[0]))
        dead, following = tip(0.004, False), tip(0.004, True)
        self.assertLess(dead[2], 0)
        # What turns with the strip pulls its end back as it bends: the tip goes further along x.
        self.assertLess(following[0], dead[0])

    def test_loads_that_follow_are_in_the_balance(self):
        block = {**BLOCK, "geometry": {**BLOCK["geometry"], "cell_mm": 10}}
        pressed = {"kind": "pressure", "region": {"face": "z+"}, "kPa": 0.2, "follows": True}
        dragged = {"kind": "traction", "region": {"face": "x+"}, "kPa": [0, 0.05, 0], "follows": True}
        for loads in ([pressed], [BAR, pressed], [BAR, pressed, dragged]):
            r = self.run_scene({**block, "kinematics": "hyperelastic", "loads": loads})
            self.assertTrue(r["solver"]["converged"])
            size = math.hypot(*r["load_N"])
            self.assertGreater(abs(r["load_N"][2]), 0.5)
            self.assertLess(math.dist(r["load_N"], [-f for f in r["reaction_N"]]), 1e-5 * size)

    def test_what_linear_theory_misses_is_said_without_a_second_stiffness(self):
        block = {**BLOCK, "geometry": {**BLOCK["geometry"], "cell_mm": 10}}
        gap = self.run_scene(block)["linear_gap_mm"]
        self.assertGreater(gap["at_retractor"], 0.2)
        self.assertLessEqual(gap["mean"], gap["max"])
        beam = {"geometry": {"kind": "box", "size_mm": [60, 10, 10], "cell_mm": 5}, "kinematics": "hyperelastic",
                "material": {"youngs_kPa": 20, "poisson": 0.3}, "supports": [{"region": {"face": "x-"}, "kind": "fixed"}],
                "loads": [{"kind": "traction", "region": {"face": "x+"}, "kPa": [0, 0, 0.1]}]}
        self.assertGreater(self.run_scene(beam, "--strict")["linear_gap_mm"]["max"], 0.1)

    def test_strict_refuses_doubts_and_not_the_programs_own_choices(self):
        block = {**BLOCK, "geometry": {**BLOCK["geometry"], "cell_mm": 5}}
        self.assertEqual(self.run_scene(block, "--strict")["warnings"], [])
        for doubtful, code in (({**block, "capsule": True, "loads": [{**BAR, "contact": "patch"}]}, "capsule-not-used"),
                               ({**block, "material": {"youngs_kPa": 6, "poisson": -0.2}}, "poisson-negative")):
            r = self.run_scene(doubtful)
            self.assertIn(code, {d["code"] for d in r["diagnostics"]})
            cli("run", write_scene(self.folder, doubtful), "--output", self.folder / "out", "--strict", "--quiet", code=3)

    def test_ligaments_hold_what_a_bed_lets_go(self):
        # A block that lies on its bed and is hoisted by its own weight and more: the ligaments above it bear the rest.
        block = {**BLOCK, "geometry": {**BLOCK["geometry"], "cell_mm": 10}, "loads": [{**BAR, "force": 2.0}]}
        bed = {"region": {"face": "y-"}, "kind": "spring", "stiffness_kPa_per_mm": 0.1, "unilateral": True, "tangential": 0.1}

        def ligament(face, **more):
            return {"kind": "ligament", "name": "falciform", "region": {"face": face}, "stiffness_N_per_mm": 0.5, **more}

        lifted = {**BAR, "at": [80, 0, 50], "direction": [0, 1, 0], "force": 2.0}
        held = {**block, "loads": [lifted], "supports": [bed, ligament("x-"), ligament("x+"), ligament("y-")]}
        r = self.run_scene(held)
        self.assertTrue(r["solver"]["converged"])
        self.assertEqual([pull["name"] for pull in r["ligaments"]], ["falciform"] * 3)
        self.assertAlmostEqual(sum(pull["force_N"][1] for pull in r["ligaments"]), -2.0, delta=0.05)
        self.assertAlmostEqual(r["reaction_N"][1], -2.0, delta=1e-4)
        plan = {step["step"]: step for step in r["plan"]}
        self.assertTrue(plan["ligaments"]["needed"])
        estimated = self.run_scene({**held, "supports": [bed, *({**ligament(f), "stiffness_N_per_mm": 1.0} for f in ("x-", "x+")),
                                                         {"kind": "ligament", "name": "other", "region": {"face": "y-"}}]})
        self.assertIn("ligament-estimated", {d["code"] for d in estimated["diagnostics"]})
        linear = {**held, "kinematics": "linear", "supports": [ligament("x-"), *BLOCK["supports"]],
                  "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -10]}]}
        process = cli("run", write_scene(self.folder, linear), "--output", self.folder / "out", "--quiet", code=3)
        self.assertIn("ligament", process.stderr)
        self.assertFalse({s["step"]: s for s in self.run_scene(BLOCK)["plan"]}["ligaments"]["needed"])

    def test_exports_say_what_they_leave_out_and_strict_touches_nothing(self):
        block = {**BLOCK, "geometry": {**BLOCK["geometry"], "cell_mm": 10}}
        scene, out = write_scene(self.folder, block), self.folder / "export"
        said = cli_json("export", scene, "--to", "mtx,sofa", "--output", out)
        self.assertIn("contact-not-exported", {d["code"] for d in said["diagnostics"]})
        before = {f: f.read_bytes() for f in out.rglob("*") if f.is_file()}
        (out / "K.mtx").write_text("mine")
        cli("export", scene, "--to", "mtx", "--output", out, "--strict", "--quiet", code=3)
        self.assertEqual((out / "K.mtx").read_text(), "mine")
        self.assertEqual({f for f in out.rglob("*") if f.is_file()}, set(before))
        patch = write_scene(self.folder, {**block, "kinematics": "linear", "loads": [{**BAR, "contact": "patch"}]}, "patch.json")
        done = cli_json("export", patch, "--to", "mtx", "--output", out, "--strict")
        self.assertEqual((out / "K.mtx").read_bytes(), before[out / "K.mtx"])
        self.assertTrue(all(pathlib.Path(f).parent == out for f in done["files"]))

    #: A block held from below, pushed into from above.
    LOW = {"geometry": {"kind": "box", "size_mm": [80, 60, 40], "cell_mm": 5},
           "material": {"shear_kPa": 2, "poisson": 0.45},
           "supports": [{"region": {"face": "z-"}, "kind": "fixed"}]}

    def pushed(self, **more):
        return {"kind": "retractor", "diameter_mm": 10, "length_mm": 40, "at": [40, 30, 40], "axis": [0, 1, 0],
                "direction": [0, 0, -1], **more}

    def test_a_bar_on_the_far_side_or_where_nothing_resists_is_refused(self):
        for bar in (self.pushed(direction=[0, 0, 1], force=2), self.pushed(at=[40, 30, 90], force=2)):
            process = cli("run", write_scene(self.folder, {**self.LOW, "loads": [bar]}), "--output",
                          self.folder / "out", "--quiet", code=3)
            self.assertIn("no contact", process.stderr)
        slack = {**self.LOW, "loads": [self.pushed(force=2)], "supports": [
            {"region": {"face": "z-"}, "kind": "ligament", "name": "falciform"},
            {"region": {"face": "x-"}, "kind": "ligament", "name": "other", "two_sided": True}]}
        process = cli("run", write_scene(self.folder, slack), "--output", self.folder / "out", "--quiet", code=3)
        self.assertIn("nothing resists the bar", process.stderr)

    def test_bars_that_travelled_alike_are_compared_by_their_answers(self):
        r = self.run_scene({**self.LOW, "loads": [self.pushed(drive={"travel_mm": 8})],
                            "compare": {"against": "atlas", "shear_kPa": 1.0}})
        lift = r["difference"]["equal_lift"]
        self.assertEqual((lift["travel_mm"], lift["along"]), (8.0, "the answers"))
        self.assertEqual(lift["force_N"], r["contact"]["force_along_hoist_N"])
        self.assertEqual(lift["atlas_force_N"], r["atlas"]["contact"]["force_along_hoist_N"])
        self.assertNotIn("retractor-laid", {d["code"] for d in r["diagnostics"]})

    def test_a_travel_past_the_largest_force_tells_that_force(self):
        shelf = {"geometry": {"kind": "box", "size_mm": [100, 40, 20], "cell_mm": 5},
                 "material": {"shear_kPa": 2, "poisson": 0.45},
                 "supports": [{"region": {"face": "x-"}, "kind": "fixed"}],
                 "loads": [{"kind": "retractor", "at": [85, 20, 0], "axis": [0, 1, 0], "length_mm": 60,
                            "direction": [0, 0, 1], "drive": {"travel_mm": 60}}]}
        r = self.run_scene(shelf)
        past = [d for d in r["diagnostics"] if d["code"] == "retractor-past-limit"]
        self.assertEqual(len(past), 1)
        self.assertEqual(r["contact"]["capacity_N"], past[0]["arguments"]["capacity_N"])
        self.assertGreater(r["contact"]["capacity_N"], r["contact"]["force_along_hoist_N"])
        self.assertLess(r["contact"]["capacity_travel_mm"], 60)

    #: A block of 40 mm held from below, pushed into from above near an edge.
    CUBE = {"geometry": {"kind": "box", "size_mm": [40, 40, 40], "cell_mm": 5}, "material": {"shear_kPa": 1, "poisson": 0.3},
            "supports": [{"region": {"face": "z-"}, "kind": "fixed"}]}

    def test_a_bar_that_gave_way_on_its_way_and_crushed_tissue_are_said(self):
        bar = {"kind": "retractor", "diameter_mm": 16, "length_mm": 30, "at": [11, 27, 40], "axis": [0, 1, 0],
               "direction": [0, 0, -1], "drive": {"travel_mm": 40}}
        r = self.run_scene({**self.CUBE, "loads": [bar], "capsule": True})
        said = {d["code"]: d["arguments"] for d in r["diagnostics"]}
        jump = said["retractor-jumps"]
        path = r["contact"]["path"]
        largest = max(force for travel, force in path if travel <= jump["capacity_travel_mm"])
        self.assertEqual(jump["capacity_N"], largest)
        self.assertLess(min(force for travel, force in path if travel > jump["capacity_travel_mm"]), 0.95 * largest)
        self.assertGreater(jump["force_N"], largest)
        self.assertGreater(said["cells-crushed"]["percent"], 5)
        gentle = self.run_scene({**self.CUBE, "loads": [{**bar, "drive": {"travel_mm": 5}}], "capsule": True})
        self.assertFalse({"retractor-jumps", "cells-crushed"} & {d["code"] for d in gentle["diagnostics"]})

    def test_cells_that_are_too_coarse_for_what_they_say_are_doubted(self):
        coarse = self.run_scene({**BLOCK, "geometry": {**BLOCK["geometry"], "cell_mm": 10}})
        doubt = {d["code"]: d["arguments"] for d in coarse["diagnostics"]}["discretisation-large"]
        self.assertEqual(doubt["cell_mm"], 10)
        self.assertGreater(doubt["error_mm"], 0.2 * doubt["displacement_mm"])

    def test_what_is_told_of_a_bar_that_did_not_get_there_is_an_equilibrium(self):
        bar = {"kind": "retractor", "at": [40, 30, 40], "axis": [0, 1, 0], "length_mm": 40, "direction": [0, 0, -1]}
        r = self.run_scene({**self.LOW, "material": {"shear_kPa": 1, "poisson": 0.3}, "loads": [{**bar, "force": 3}]}, code=4)
        contact = r["contact"]
        self.assertLess(math.dist(contact["force_N"], [-f for f in r["reaction_N"]]), 2e-3 * contact["resultant_N"])
        # The same travel alone bears what is said to be borne.
        travel = contact["capacity_travel_mm"]
        held = self.run_scene({**self.LOW, "material": {"shear_kPa": 1, "poisson": 0.3},
                               "loads": [{**bar, "drive": {"travel_mm": travel}}]})
        self.assertAlmostEqual(held["contact"]["force_along_hoist_N"], contact["capacity_N"], delta=0.05 * contact["capacity_N"])

    def test_a_bar_of_a_millimetre_answers(self):
        r = self.run_scene({**self.CUBE, "material": {"shear_kPa": 2, "poisson": 0.45},
                            "loads": [{"kind": "retractor", "diameter_mm": 1, "length_mm": 20, "at": [20, 20, 40],
                                       "axis": [0, 1, 0], "direction": [0, 0, -1], "force": 0.3}]})
        self.assertAlmostEqual(r["contact"]["force_along_hoist_N"], 0.3, delta=1e-5)
        self.assertAlmostEqual(r["reaction_N"][2], 0.3, delta=1e-4)

    def test_loads_without_a_bar_that_are_not_borne_are_said(self):
        beam = {"geometry": {"kind": "box", "size_mm": [80, 20, 20], "cell_mm": 5}, "kinematics": "hyperelastic",
                "material": {"youngs_kPa": 6, "poisson": 0.45}, "supports": [{"region": {"face": "x-"}, "kind": "fixed"}],
                "loads": [{"kind": "traction", "region": {"face": "x+"}, "kPa": [0, 0, -500]}]}
        r = self.run_scene(beam, code=4)
        self.assertFalse(r["solver"]["converged"])
        self.assertEqual([d["code"] for d in r["diagnostics"] if d["severity"] == "error"], ["loads-not-borne"])

    def test_errors_of_linear_answers_are_refused_if_strict(self):
        scene = {**self.LOW, "loads": [self.pushed(force=2)], "kinematics": "linear"}
        r = self.run_scene(scene)
        self.assertIn("cells-inside-out", {d["code"] for d in r["diagnostics"]})
        cli("run", write_scene(self.folder, scene), "--output", self.folder / "out", "--quiet", "--strict", code=3)


if __name__ == "__main__":
    unittest.main()
