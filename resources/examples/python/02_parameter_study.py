# SPDX-License-Identifier: GPL-3.0-or-later

# %% [markdown]
# # A parameter study: stiffness, cells, forces
#
# The cantilever of the study and a block under a bar, small enough that a loop takes seconds. Scenes are dictionaries; a study changes
# a value and makes the next scene.

# %%
import copy

import numpy as np

import glisson

beam: dict = {
    "schema": "glisson/scene/1",
    "geometry": {"kind": "box", "size_mm": [50, 10, 10], "cell_mm": 2.5},
    "material": {"youngs_kPa": 12, "poisson": 0.45},
    "supports": [{"region": {"face": "x-"}, "kind": "fixed"}],
    "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -128]}],
    "outputs": [{"probe": [[50, 5, 5]]}],
}


def tip_mm(words):
    """Deflection of the beam's end along z, mm."""
    run = glisson.run(glisson.Scene(words))
    assert run.converged
    return -run.primary.probes_mm[0, 2]


# %% [markdown]
# ## Stiffness
# Linear theory: the deflection is proportional to 1/E.

# %%
youngs_kPa = np.array([6.0, 12.0, 24.0])
tips = []
for E in youngs_kPa:
    words = copy.deepcopy(beam)
    words["material"]["youngs_kPa"] = E
    tips.append(tip_mm(words))
    print(f"E = {E:4.0f} kPa: {tips[-1]:.4f} mm")
assert np.allclose(np.array(tips) * youngs_kPa, tips[0] * youngs_kPa[0], rtol=1e-6)

# %% [markdown]
# ## Cells
# Error against cell size: the difference between grids falls, and the run's own estimate is larger than the change to the finest.

# %%
cells_mm = [5.0, 2.5, 1.25]
by_cell = []
for cell_mm in cells_mm:
    words = copy.deepcopy(beam)
    words["geometry"]["cell_mm"] = cell_mm
    by_cell.append(tip_mm(words))
    print(f"cells of {cell_mm:4.2f} mm: {by_cell[-1]:.4f} mm")
assert abs(by_cell[2] - by_cell[1]) < abs(by_cell[1] - by_cell[0])

# %% [markdown]
# ## Forces: the condensed live model
# A block on springs under a bar as a patch. Condensed to some points, a force is answered in microseconds, so that a study of
# thousands of forces is one product; linear, so that answers add up, and the same as the full solve where the force is the scene's.

# %%
block: dict = {
    "schema": "glisson/scene/1",
    "geometry": {"kind": "box", "size_mm": [80, 60, 40], "cell_mm": 5},
    "material": {"youngs_kPa": 6, "poisson": 0.45},
    "supports": [{"region": {"face": "y+"}, "kind": "spring", "stiffness_kPa_per_mm": 0.1}],
    "loads": [{"kind": "retractor", "diameter_mm": 10, "length_mm": 40, "at": [40, 30, 0], "direction": [0, 0, 1], "force": 0.2,
               "contact": "patch"}],
    "kinematics": "linear",
    "outputs": [{"probe": [[40, 30, 20], [20, 30, 20], [60, 10, 35]]}],
}
scene = glisson.Scene(block)
live = glisson.live(scene, model="condensed")
liver = live.measured
force_N = liver.scene_force_N
u_mm = liver.evaluate(force_N)
full = glisson.run(scene)
print("condensed", np.round(u_mm[0], 4), "full", np.round(full.primary.probes_mm[0], 4), "mm")
assert np.allclose(u_mm, full.primary.probes_mm, atol=1e-5)
assert np.allclose(liver.evaluate(2 * force_N), 2 * u_mm, atol=1e-9)
assert np.allclose(liver.tool_displacement_mm(liver.force_for([0, 0, 3])), [0, 0, 3], atol=1e-9)

forces = np.outer(np.linspace(0, 1, 1000), force_N)
lifted = np.array([liver.evaluate(f)[0, 2] for f in forces])
assert np.allclose(np.diff(lifted), lifted[1] - lifted[0], atol=1e-9)
print(f"1000 forces answered; {lifted[-1]:.3f} mm at {np.linalg.norm(force_N):.2f} N")

# %% [markdown]
# ## A scene that cannot be
# Errors say what is wrong and what to do; there is one class for each kind.

# %%
wrong = copy.deepcopy(beam)
wrong["material"]["youngs_kPa"] = -1
try:
    glisson.Scene(wrong)
    raise SystemExit("a negative stiffness was taken")
except glisson.BadInput as error:
    print(error)
