# SPDX-License-Identifier: GPL-3.0-or-later
"""Patient-specific biomechanics for image-guided liver surgery. Research use only, not for clinical use.

The functions are the verbs of glisson-cli, on the same core, with the same numbers to the last bit:

    scan(folder)            what a folder of DICOM files holds
    measure(mre, roi)       stiffness statistics of a region of interest
    invert(phases)          raw phase images to the complex shear modulus
    propose(image, seed)    a first outline of an organ, to be corrected
    plan(scene)             what a scene needs and what it leaves out
    run(scene)              everything that a scene needs
    live(scene)             livers that follow the tool, frame by frame
    cohort(patients, out)   the studies over a folder of patients
    phantom(out)            synthetic patients

Units are in the names: mm, kPa, N. Points and displacements are in LPS, DICOM's patient frame (x to the patient's left, y to
posterior, z to superior); every grid has affine_lps and, for NIfTI's frame, affine_ras. Arrays are views of core's memory:
read-only, without a copy, valid as long as they are held.

Functions that take long have progress=, called with (fraction, what) in the calling thread, and cancel=, a Cancel. They run
with the interpreter's lock released; Ctrl+C stops them with KeyboardInterrupt. What core throws is a subclass of Error.
"""
import pathlib as _pathlib

from . import _core
from ._core import (
    Acquisition, BadArgument, BadInput, BulkFilter, Cancel, Cancelled, CaseOutcome, Cohort, ComplexVolume, Contact, Diagnostic,
    Difference, DisplacementField, Error, Grid, Inverted, Live, LiveAnswer, LiveLiver, Mask, MeasuredRegion, Measurement, Model,
    PlanStep, Proposal, RenderUnavailable, Retraction, Run, Scan, Scene, Series, SkippedFile, SliceStatistics, Solver, SolverFailed,
    Statistics, Unwrapping, Volume, cohort, doubts, invert, live, measure, merge_cohort, phantom, plan, propose, read_mask, read_scene,
    read_volume, research_use_only, run, scan, set_threads, threads)

__version__: str = _core.version()

__all__ = [
    "Acquisition", "BadArgument", "BadInput", "BulkFilter", "Cancel", "Cancelled", "CaseOutcome", "Cohort", "ComplexVolume", "Contact",
    "Diagnostic", "Difference", "DisplacementField", "Error", "Grid", "Inverted", "Live", "LiveAnswer", "LiveLiver", "Mask",
    "MeasuredRegion", "Measurement", "Model", "PlanStep", "Proposal", "RenderUnavailable", "Retraction", "Run", "Scan", "Scene",
    "Series", "SkippedFile", "SliceStatistics", "Solver", "SolverFailed", "Statistics", "Unwrapping", "Volume", "cohort", "doubts",
    "invert", "live", "measure", "merge_cohort", "phantom", "plan", "propose", "read_mask", "read_scene", "read_volume",
    "research_use_only", "run", "scan", "set_threads", "threads"]


def _find_programs() -> None:
    """The programs that core starts, where they are installed or, in a tree of a build, built."""
    package = _pathlib.Path(__file__).resolve().parent
    prefix, build = package / "../../../..", package / "../.."
    for set_program, places in (
            (_core._set_reader_program, (prefix / "libexec/glisson/glisson-reader", build / "app/glisson-reader/glisson-reader")),
            (_core._set_command_line, (prefix / "bin/glisson-cli", build / "app/glisson-cli/glisson-cli"))):
        found = next((place for place in places if place.is_file()), None)
        if found is not None:
            set_program(found.resolve())


_find_programs()
