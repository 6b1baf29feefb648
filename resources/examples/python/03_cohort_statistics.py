# SPDX-License-Identifier: GPL-3.0-or-later

# %% [markdown]
# # A cohort's statistics
#
# Three synthetic patients, measured and retracted; then questions that the report does not ask. `cohort` goes on where it was stopped:
# run the cell again after adding patients.

# %%
import csv
import json
import pathlib

import numpy as np

import glisson

patients = pathlib.Path("python-cohort-patients")
glisson.phantom(patients, cases=3, seed=11, paper=True)
for file in sorted(patients.glob("*/scene.json")):
    words = json.loads(file.read_text())
    words["geometry"]["cell_mm"] = 8  # coarse cells, so that this takes a minute; leave them out for a study
    file.write_text(json.dumps(words))

# %%
result = glisson.cohort(patients, "python-cohort", sensitivity=False, progress=lambda fraction, what: print(f"{fraction:4.0%}  {what}"))
for case in result.cases:
    print(case.id, case.status, case.reason)
assert result.record is not None and len(result.cases) == 3

# %% [markdown]
# ## One row per patient
# `patients.csv` has the numbers of every patient, by number; no row names anyone.

# %%
with open("python-cohort/patients.csv", newline="", encoding="utf-8") as table:
    rows = [row for row in csv.DictReader(table) if row["status"] == "done"]


def column(name):
    return np.array([float(row[name]) for row in rows])


shear_kPa = column("shear_kPa")
apart_mm = column("at_retractor_mm")
for kPa, mm in zip(shear_kPa, apart_mm):
    print(f"shear modulus {kPa:.2f} kPa: {mm:.2f} mm apart at the bar")
assert len(rows) >= 2
known = {case["id"]: case for case in result.record["cases"]}
assert all(np.isclose(known[row["case"]]["shear_kPa"], float(row["shear_kPa"]), rtol=1e-9) for row in rows)

# %% [markdown]
# ## Does the distance from the textbook value explain the difference?
# Rank correlation, and the mean difference with an interval by bootstrap (a fixed seed, so that it is the same every time). Three patients
# prove nothing: this shows how, not what.

# %%
def ranks(values):
    return np.argsort(np.argsort(values)).astype(float)


off_kPa = np.abs(shear_kPa - 2.1)
rho = np.corrcoef(ranks(off_kPa), ranks(apart_mm))[0, 1] if len(rows) > 2 else np.nan
random = np.random.default_rng(1)
draws = random.choice(apart_mm, size=(5000, len(apart_mm))).mean(axis=1)
low, high = np.percentile(draws, [2.5, 97.5])
print(f"rank correlation {rho:.2f}; mean difference at the bar {apart_mm.mean():.2f} mm (95 %: {low:.2f} to {high:.2f} mm)")
assert low <= apart_mm.mean() <= high

# %% [markdown]
# ## Shared out
# Shards may run on several machines; their merge gives the bytes that one machine would have written.

# %%
for i in (1, 2):
    glisson.cohort(patients, f"python-shard-{i}", shard=(i, 2), sensitivity=False)
glisson.merge_cohort(["python-shard-1", "python-shard-2"], "python-merged", patients=patients, sensitivity=False)
assert pathlib.Path("python-merged/cohort.json").read_bytes() == pathlib.Path("python-cohort/cohort.json").read_bytes()
