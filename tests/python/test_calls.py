# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress, cancelling, Ctrl+C, threads, and errors as exceptions."""
import locale
import os
import pathlib
import signal
import tempfile
import threading
import time
import unittest

import numpy as np

import glisson
from scenes import beam, long_run


class Watching(unittest.TestCase):
    def test_progress_is_told_in_the_calling_thread_and_ends_at_one(self):
        said = []
        glisson.run(glisson.Scene(beam()), progress=lambda f, what: said.append((f, what, threading.current_thread())))
        fractions = [f for f, _, _ in said]
        self.assertEqual(fractions[-1], 1.0)
        self.assertTrue(all(0 <= f <= 1 for f in fractions))
        self.assertIn("solve", [what for _, what, _ in said])
        self.assertEqual({t for _, _, t in said}, {threading.main_thread()})

    def test_an_exception_of_the_callback_stops_the_work_and_is_raised(self):
        class Enough(Exception):
            pass

        def stop(fraction, what):
            raise Enough(what)

        began = time.monotonic()
        with self.assertRaises(Enough):
            glisson.run(glisson.Scene(long_run()), progress=stop)
        self.assertLess(time.monotonic() - began, 10)

    def test_what_is_no_function_is_refused(self):
        with self.assertRaises(TypeError):
            glisson.run(glisson.Scene(beam()), progress=3)

    def test_cancel_from_another_thread(self):
        cancel = glisson.Cancel()
        timer = threading.Timer(0.5, cancel.cancel)
        began = time.monotonic()
        timer.start()
        with self.assertRaises(glisson.Cancelled):
            glisson.run(glisson.Scene(long_run()), cancel=cancel)
        self.assertLess(time.monotonic() - began, 10)
        self.assertTrue(cancel.cancelled)
        # It stays cancelled: nothing begins with it.
        with self.assertRaises(glisson.Cancelled):
            glisson.run(glisson.Scene(beam()), cancel=cancel)

    def test_ctrl_c_is_a_keyboard_interrupt_and_the_next_call_works(self):
        timer = threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT))
        began = time.monotonic()
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            glisson.run(glisson.Scene(long_run()))
        self.assertLess(time.monotonic() - began, 10)
        self.assertTrue(glisson.run(glisson.Scene(beam())).converged)

    def test_other_threads_go_on_while_core_works(self):
        """The lock is released: a thread that sleeps 1 ms at a time would else not run once."""
        cancel = glisson.Cancel()
        turns = 0
        done = threading.Event()

        def count():
            nonlocal turns
            until = time.monotonic() + 1.5
            while time.monotonic() < until:
                turns += 1
                time.sleep(0.001)
            cancel.cancel()
            done.set()

        threading.Thread(target=count).start()
        with self.assertRaises(glisson.Cancelled):
            glisson.run(glisson.Scene(long_run()), cancel=cancel)
        self.assertTrue(done.is_set())
        self.assertGreater(turns, 50)

    def test_two_runs_at_a_time_give_the_bits_of_one(self):
        alone = glisson.run(glisson.Scene(beam())).results_sha256
        found = []
        threads = [threading.Thread(target=lambda: found.append(glisson.run(glisson.Scene(beam())).results_sha256)) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(found, [alone] * 4)

    def test_bits_do_not_depend_on_threads(self):
        before = glisson.threads()
        try:
            glisson.set_threads(1)
            one = glisson.run(glisson.Scene(beam())).results_sha256
        finally:
            glisson.set_threads(0)
        self.assertEqual(one, glisson.run(glisson.Scene(beam())).results_sha256)
        self.assertEqual(glisson.threads(), before)

    def test_numbers_do_not_depend_on_the_country(self):
        plain = glisson.run(glisson.Scene(beam())).results_sha256
        for name in ("de_DE.UTF-8", "fr_FR.UTF-8", "C.UTF-8"):
            try:
                locale.setlocale(locale.LC_ALL, name)
            except locale.Error:
                continue
            try:
                self.assertEqual(glisson.run(glisson.Scene(beam())).results_sha256, plain)
            finally:
                locale.setlocale(locale.LC_ALL, "C")


class Errors(unittest.TestCase):
    def test_every_class_is_an_error_of_glisson(self):
        for name in ("BadInput", "BadArgument", "SolverFailed", "RenderUnavailable", "Cancelled"):
            self.assertTrue(issubclass(getattr(glisson, name), glisson.Error), name)
            self.assertEqual(getattr(glisson, name).__module__, "glisson")
        self.assertTrue(issubclass(glisson.Error, Exception))

    def test_bad_input_names_what_is_wrong(self):
        wrong = beam()
        wrong["material"]["youngs_kPa"] = -1
        with self.assertRaisesRegex(glisson.BadInput, "youngs_kPa"):
            glisson.Scene(wrong)
        wrong = beam()
        wrong["lods"] = []
        with self.assertRaisesRegex(glisson.BadInput, "lods"):
            glisson.Scene(wrong)
        for call in (lambda: glisson.scan("/nowhere"), lambda: glisson.measure("/nowhere", "/nowhere"),
                     lambda: glisson.invert(["/nowhere"]), lambda: glisson.propose("/nowhere", [0, 0, 0]),
                     lambda: glisson.plan("/nowhere/scene.json"), lambda: glisson.run("/nowhere/scene.json"),
                     lambda: glisson.live("/nowhere/scene.json"), lambda: glisson.cohort("/nowhere", "/nowhere"),
                     lambda: glisson.read_volume("/nowhere.nii"), lambda: glisson.phantom("x", shape="cube"),
                     lambda: glisson.measure("/", "/", confidence=2), lambda: glisson.scan("/", roles={"1": "stifness"}),
                     lambda: glisson.live(glisson.Scene(beam()))):
            with self.assertRaises(glisson.BadInput):
                call()

    def test_bad_argument_is_a_class_of_its_own(self):
        with self.assertRaises(glisson.BadArgument):
            glisson.set_threads(-1)
        with self.assertRaises(glisson.BadArgument):
            glisson.run(None)

    def test_a_condensed_column_that_does_not_converge_is_solver_failed(self):
        scene = glisson.Scene(dict(Live.SCENE, solver={"kind": "cg", "iterations": 2}))
        with self.assertRaises(glisson.SolverFailed) as caught:
            glisson.live(scene, model="condensed")
        self.assertGreater(caught.exception.iterations, 0)
        self.assertGreater(caught.exception.residual, caught.exception.tolerance)
        self.assertIsInstance(caught.exception, glisson.Error)

    def test_a_run_without_an_answer_says_so(self):
        scene = beam()
        scene["solver"] = {"kind": "cg", "iterations": 2}
        run = glisson.run(glisson.Scene(scene))
        self.assertFalse(run.converged)
        self.assertFalse(run.primary.solver.converged)


class Scenes(unittest.TestCase):
    def test_to_dict_is_the_scene_with_every_default(self):
        scene = glisson.Scene(beam())
        words = scene.to_dict()
        self.assertEqual(words["material"]["youngs_kPa"], 12)
        self.assertEqual(glisson.Scene(words).to_dict(), words)
        self.assertEqual(glisson.run(glisson.Scene(words)).results_sha256, glisson.run(scene).results_sha256)

    def test_plan_and_doubts(self):
        steps = {step.step: step for step in glisson.plan(glisson.Scene(beam()))}
        self.assertTrue(steps["solve"].needed)
        self.assertFalse(steps["read-mri"].needed)
        self.assertTrue(all(step.why for step in steps.values()))
        words = beam()
        words["material"]["law"] = "neo-hookean-log"
        words["kinematics"] = "linear"
        said = glisson.doubts(glisson.Scene(words))
        self.assertIn("setting-not-used", [d.code for d in said])
        self.assertTrue(all(d.text and d.severity in ("note", "warning", "error") for d in said))


class Live(unittest.TestCase):
    SCENE = {
        "schema": "glisson/scene/1", "geometry": {"kind": "box", "size_mm": [80, 60, 40], "cell_mm": 10},
        "material": {"youngs_kPa": 6, "poisson": 0.45},
        "supports": [{"region": {"face": "y+"}, "kind": "spring", "stiffness_kPa_per_mm": 0.1}],
        "loads": [{"kind": "retractor", "diameter_mm": 10, "length_mm": 40, "at": [40, 30, 0], "direction": [0, 0, 1], "force": 0.2,
                   "contact": "patch"}],
        "kinematics": "linear", "compare": {"against": "atlas"}, "outputs": [{"probe": [[40, 30, 20], [60, 10, 35]]}]}

    def test_condensed_follows_a_force_and_a_place(self):
        scene = glisson.Scene(self.SCENE)
        live = glisson.live(scene, model="condensed")
        self.assertEqual(live.kind, "condensed")
        np.testing.assert_array_equal(live.points_mm, [[40, 30, 20], [60, 10, 35]])
        run = glisson.run(scene)
        for liver, result in ((live.measured, run.primary), (live.atlas, run.atlas)):
            answer = liver.follow()
            self.assertTrue(answer.at_rest)
            self.assertEqual(answer.outcome, "borne")
            np.testing.assert_allclose(liver.displacements(), result.probes_mm, atol=1e-5)
            np.testing.assert_allclose(answer.force_N, liver.scene_force_N)
            place = liver.follow(tool_mm=[0, 0, 2])
            np.testing.assert_allclose(place.tool_mm, [0, 0, 2], atol=1e-9)
            np.testing.assert_allclose(place.force_N, liver.force_for([0, 0, 2]), atol=1e-12)
            np.testing.assert_array_equal(liver.displacements(), liver.evaluate(place.force_N))
        with self.assertRaises(glisson.BadArgument):
            live.measured.follow(force_N=[0, 0, 1], tool_mm=[0, 0, 1])

    def test_points_of_ones_own_are_watched(self):
        points = np.array([[10.0, 10, 10], [70, 50, 30], [40, 30, 20]])
        live = glisson.live(glisson.Scene(self.SCENE), model="condensed", points_mm=points)
        self.assertEqual(live.measured.displacements().shape, (3, 3))
        run = glisson.run(glisson.Scene(self.SCENE))
        live.measured.follow()
        np.testing.assert_allclose(live.measured.displacements(), run.displacement_at(points), atol=1e-5)

    def test_a_liver_outlives_what_it_was_taken_from(self):
        liver = glisson.live(glisson.Scene(self.SCENE), model="condensed").measured
        u = liver.evaluate([0, 0, 0.1])
        kept = u.copy()
        for _ in range(50):
            liver.evaluate([0, 0, 0.2])
        np.testing.assert_array_equal(u, kept)

    def test_contact_follows_the_bar(self):
        scene = dict(self.SCENE, loads=[{"kind": "retractor", "diameter_mm": 10, "length_mm": 40, "at": [40, 30, 0],
                                         "direction": [0, 0, 1], "drive": {"travel_mm": 3}}])
        del scene["kinematics"], scene["compare"]
        live = glisson.live(glisson.Scene(scene))
        self.assertEqual(live.kind, "contact")
        self.assertIsNone(live.atlas)
        for _ in range(200):
            answer = live.measured.follow()
            if answer.at_rest:
                break
        self.assertTrue(answer.at_rest)
        self.assertGreater(answer.force_N[2], 0)
        with self.assertRaises(glisson.BadArgument):
            live.measured.evaluate([0, 0, 1])


class Scanning(unittest.TestCase):
    def test_series_outlive_the_scan_and_read_their_voxels(self):
        with tempfile.TemporaryDirectory() as folder:
            patient = glisson.phantom(folder, seed=2)[0]
            self.assertEqual(patient, pathlib.Path(folder) / "patient-001")
            stiffness = glisson.scan(patient / "mre").acquisitions[0].stiffness
            self.assertEqual(stiffness.role, "stiffness")
            volume = stiffness.read()
            self.assertEqual(volume.values.shape, stiffness.grid.size)
            np.testing.assert_allclose(volume.affine_lps, stiffness.grid.affine_lps)
            self.assertGreater(volume.values.max(), 500)  # Pa
            named = glisson.scan(patient / "mre", roles={str(stiffness.number): "other"})
            self.assertEqual(next(s for s in named.series if s.uid == stiffness.uid).role, "other")
            with self.assertRaises(glisson.BadInput):
                glisson.scan(patient / "mre", roles={"77777": "other"})
            (patient / "mre" / "note.txt").write_text("no image")
            self.assertEqual([s.file.name for s in glisson.scan(patient / "mre").skipped], ["note.txt"])


if __name__ == "__main__":
    unittest.main()
