# SPDX-License-Identifier: GPL-3.0-or-later
"""Elastography drawn at random (vendors, units, padding, pairings, gaps, orientations, styles of outlines) with a known
answer: each is measured right, and what is doubtful about it is told. GLISSON_RANDOM_CASES: how many (10,000 in all)."""
import concurrent.futures
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import random_acquisitions
from support import CLI

CASES = int(os.environ.get("GLISSON_RANDOM_CASES", "200"))
FIRST = int(os.environ.get("GLISSON_RANDOM_FIRST", "0"))


def fault(seed):
    """What is wrong with the answer to a case; None where nothing is."""
    with tempfile.TemporaryDirectory() as name:
        case = random_acquisitions.draw(seed, pathlib.Path(name))
        run = subprocess.run([CLI, "measure", "--mre", str(case.folder / "mre"), "--roi", str(case.roi), *case.arguments,
                              "--json", "--quiet"], capture_output=True, text=True)
    about = "; ".join(case.story)
    if run.returncode != 0:
        allowed = case.or_refused + ([] if case.voxels else ["no voxel", "none of"])
        if run.returncode == 3 and any(words in run.stderr for words in allowed):
            return None
        return f"case {seed} ({about}): code {run.returncode}: {run.stderr.strip()}"
    if case.only_refused:
        return f"case {seed} ({about}): was not refused"
    answer = json.loads(run.stdout)
    counted = ("voxels count", "hold no stiffness")  # of what is left out for a good reason
    told = [(d["code"], d["text"]) for d in answer["diagnostics"]
            if d["severity"] != "note" and not any(words in d["text"] for words in counted)]
    for codes in case.said:
        if not any(code in codes or any(" " in word and word in text for word in codes) for code, text in told):
            return f"case {seed} ({about}): none of {sorted(codes)} is told, but {told}"
    # Where a confidence map was asked about rather than taken, every voxel of the region counts.
    asked = answer["sources"]["confidence"] is None and {"partner-ambiguous", "partner-elsewhere"} & {c for c, _ in told}
    voxels = case.unmasked if asked else case.voxels
    n, mean = answer["pooled"]["n"], answer["shear_mean_kPa"]
    right = sum(voxels) / len(voxels) if voxels else None
    if n != len(voxels) or (right and abs(mean - right) > 2e-3 * right):
        return f"case {seed} ({about}): n {n}, mean {mean}; {len(voxels)}, {right} are right; told: {told}"
    if not case.said and told:
        return f"case {seed} ({about}): nothing is doubtful, but {told} is told"
    return None


class RandomAcquisitions(unittest.TestCase):
    def test_each_is_measured_right_and_its_doubts_are_told(self):
        with concurrent.futures.ProcessPoolExecutor(max_workers=2) as pool:
            faults = [f for f in pool.map(fault, range(FIRST, FIRST + CASES), chunksize=8) if f]
        self.assertFalse(faults, f"{len(faults)} of {CASES}:\n" + "\n".join(faults[:10]))


if __name__ == "__main__":
    unittest.main()
