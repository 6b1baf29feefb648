# SPDX-License-Identifier: GPL-3.0-or-later

# %% [markdown]
# # A patient: from DICOM to the difference between two predictions
#
# Runs as a script, or cell by cell in Jupyter (jupytext) and editors that know `# %%`. Everything is written below the folder where
# it is run. The patient is synthetic, so that the truth is known; put a folder of your own in its place.

# %%
import json
import pathlib

import numpy as np

import glisson

folder = glisson.phantom("python-patients", seed=3)[0]
truth = json.loads((folder / "truth.json").read_text())

# %% [markdown]
# ## What lies in the folder
# Every series with its role and the reason; what belongs to one elastography acquisition.

# %%
found = glisson.scan(folder)
for series in found.series:
    print(f"{series.number:5} {series.role:12} {series.grid.size} {series.role_reason}")
acquisition = found.acquisitions[0]
assert acquisition.stiffness is not None and acquisition.confidence is not None

# %% [markdown]
# Voxels are arrays `[i, j, k]`, seen in core's own memory; affines say where they lie, in LPS (DICOM) and RAS (NIfTI, nibabel).

# %%
mri = next(series for series in found.series if series.role == "anatomical").read()
print(mri.values.shape, mri.values.dtype, mri.values.flags.writeable)
corner_lps = mri.affine_lps @ [0, 0, 0, 1]
corner_ras = mri.affine_ras @ [0, 0, 0, 1]
assert np.array_equal(corner_ras, corner_lps * [-1, -1, 1, 1])

# %% [markdown]
# ## Stiffness of the outlined liver
# The shear modulus in kPa, over the voxels whose confidence is 0.95 or more.

# %%
measured = glisson.measure(folder / "mre", folder / "rtstruct.dcm", mri=folder / "mri")
numbers = measured.measurement
low, high = numbers.mean_ci95_kPa
print(f"{numbers.quantity} modulus {numbers.pooled.mean_kPa:.3f} kPa (95 %: {low:.3f} to {high:.3f}), true {truth['shear_kPa']:.3f} kPa")
assert abs(numbers.pooled.mean_kPa / truth["shear_kPa"] - 1) < 0.01

# The same mean by hand: the arrays are those that were measured.
assert measured.confidence is not None
counts = measured.region.values & (measured.confidence.values >= np.float32(0.95)) & (measured.stiffness.values > 0)
assert np.count_nonzero(counts) == numbers.pooled.n
assert np.isclose(measured.stiffness.values[counts].mean(dtype=float), numbers.pooled.mean_kPa, rtol=1e-12)

# %% [markdown]
# ## A first outline from one point
# A proposal to be corrected, never a result. The seed is the middle of the outlined region, in LPS mm.

# %%
middle = np.argwhere(measured.region.values).mean(axis=0)
proposal = glisson.propose(folder / "mri", (measured.region.affine_lps @ [*middle, 1])[:3])
print(f"{proposal.volume_mL:.0f} mL proposed, {truth['volume_mL']:.0f} mL true; {len(proposal.contours['polygons'])} polygons")
assert abs(proposal.volume_mL / truth["volume_mL"] - 1) < 0.15

# %% [markdown]
# ## The retraction
# The patient's scene as a dictionary, changed and made a scene again: coarse cells and a bar that travels 20 mm, so that it takes
# seconds. Its paths are relative to the folder. `plan` says what will be done and why.

# %%
words = glisson.read_scene(folder / "scene.json").to_dict()
words["geometry"]["cell_mm"] = 8
words["loads"][0].pop("force", None)
words["loads"][0]["drive"] = {"travel_mm": 20}
words["outputs"] = ["vessels"]
scene = glisson.Scene(words, folder)
for step in glisson.plan(scene):
    if step.needed:
        print(f"  {step.step}: {step.why}")

# %%
run = glisson.run(scene, progress=lambda fraction, what: print(f"{100 * fraction:3.0f} %  {what}"))
assert run.converged and run.difference is not None and run.atlas is not None
print(f"{run.primary.dofs} unknowns; mean difference {run.difference.mean_mm:.2f} mm, at the bar {run.difference.at_retractor_mm:.2f} mm")
for said in run.diagnostics:
    print(f"  {said.severity} {said.code}: {said.text}")

# %% [markdown]
# Fields and landmarks are arrays. `displacement_at` answers for any point, with either stiffness.

# %%
moved = np.linalg.norm(run.primary.displacement_mm.values, axis=-1)
print(f"largest displacement of a cell {moved.max():.1f} mm")
assert 10 < moved.max() <= run.primary.max_displacement_mm + 1e-3
own = run.displacement_at(run.landmarks_mm)
textbook = run.displacement_at(run.landmarks_mm, atlas=True)
apart = np.linalg.norm(own - textbook, axis=1)
inside = np.isfinite(apart)
assert np.allclose(apart[inside], run.difference.vessel_mm[inside], atol=1e-9)
print(f"{inside.sum()} vessel landmarks, {np.mean(apart[inside] >= 5):.0%} of them 5 mm apart or more")

# %% [markdown]
# The record is what `run.json` holds; its digest tells whether two runs are the same to the last bit, here and on the command line.

# %%
print(run.results_sha256)
