#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Records what a program computes, so that a change which must not change results can be held against the program before it.

usage: record_runs.py CLI FOLDER [--only REGEX]     runs a set of scenes with CLI (glisson-cli), writes FOLDER/record.json
       record_runs.py --compare BEFORE AFTER        two such folders (or files); says what differs, exit code 1 where something does

Recorded of each run: exit code, the JSON on standard output, the last line on standard error, and the SHA-256 of every file
written. Times, memory, versions and places on the computer are left out; text that holds them (reports) is too. Standard library
only. About ten minutes on two cores; most of it are the patient and the trade-off.
"""
import argparse
import hashlib
import json
import pathlib
import re
import subprocess
import sys
import tempfile

# What differs from run to run, or from build to build, of one program.
CHANGING = {"seconds", "peak_MB", "commit", "version", "build_s", "solve_s", "step_ms", "reference_s", "run_s", "pareto", "threads",
            "evaluate_us", "rate_hz"}
TEXT_WITH_TIMES = {"report.html", "report.pdf", "timings.csv", "tradeoff.csv", "validation.csv"}

CLAMP = {"region": {"face": "x-"}, "kind": "fixed"}
WEIGHT = {"kind": "body_force", "N_per_m3": [0, 0, -128]}
BEAM = {"geometry": {"kind": "box", "size_mm": [50, 10, 10], "cell_mm": 2.5}, "material": {"youngs_kPa": 12, "poisson": 0.45},
        "supports": [CLAMP], "loads": [WEIGHT], "outputs": [{"probe": [[25, 5, 5], [50, 5, 5]]}, "displacement-field"]}
BLOCK = {"geometry": {"kind": "box", "size_mm": [60, 40, 40], "cell_mm": 5}, "material": {"youngs_kPa": 6, "poisson": 0.45},
         "supports": [{"region": {"face": "z+"}, "kind": "spring", "stiffness_kPa_per_mm": 0.3},
                      {"region": {"face": "x-"}, "kind": "fixed", "axes": ["x"]}],
         "loads": [{"kind": "traction", "region": {"face": "x+"}, "kPa": [0.2, 0, -0.1]}, WEIGHT],
         "outputs": [{"probe": [[60, 20, 20]]}]}


def scenes():
    """Name and scene of every box."""
    for element in ("H8", "H8-Bbar", "H8-incompatible"):
        for solver in ("auto", "cg", "factorised", "multigrid"):
            yield f"hex {element} {solver}", {**BLOCK, "model": {"kind": "fem-hex", "element": element}, "solver": {"kind": solver}}
    for element in ("T4", "T10"):
        yield f"tet {element}", {**BLOCK, "model": {"kind": "fem-tet", "element": element}}
    for kernel in ("voronoi", "wendland", "mls"):
        for order in (1, 2):
            yield f"meshfree {kernel} {order}", {**BEAM, "model": {"kind": "meshfree", "kernel": kernel, "order": order, "frames": 40}}
    for kinematics in ("auto", "linear", "corotational", "hyperelastic"):
        yield f"kinematics {kinematics}", {**BEAM, "kinematics": kinematics}
    for law in ("neo-hookean-polynomial", "neo-hookean-log"):
        yield f"law {law}", {**BLOCK, "kinematics": "hyperelastic", "material": {**BLOCK["material"], "law": law}}
    yield "following pressure", {**BEAM, "kinematics": "hyperelastic",
                                 "loads": [{"kind": "pressure", "region": {"face": "z+"}, "kPa": 0.01, "follows": True}]}
    yield "condensed", {**BLOCK, "solver": {"kind": "condensed"}}
    yield "compared", {**BLOCK, "compare": {"against": "atlas"}}
    yield "compared, scaled", {**BEAM, "compare": {"against": "atlas"}}
    for scheme in ("implicit-euler", "newmark", "generalised-alpha"):
        yield f"dynamic {scheme}", {**BEAM, "analysis": {"kind": "dynamic", "h_ms": 2, "end_s": 0.05, "rayleigh": [1, 0.001],
                                                         "scheme": scheme}}
    yield "patch", {**BLOCK, "loads": [{"kind": "retractor", "at": [30, 0, 20], "axis": [0, 0, 1], "direction": [0, 1, 0], "force": 0.2,
                                        "contact": "patch", "length_mm": 30}]}
    yield "rigid bar", {**BLOCK, "loads": [{"kind": "retractor", "at": [30, 0, 20], "axis": [0, 0, 1], "direction": [0, 1, 0],
                                            "drive": {"travel_mm": 3}, "length_mm": 80}]}
    yield "no supports", {**BEAM, "supports": []}
    yield "unknown key", {**BEAM, "gravity": 9.81}


OF_PATIENTS = ("scan", "measure", "measure on the MRI", "measure, nothing there", "invert", "agree", "plan of a patient", "a patient",
               "a patient, linear", "export", "cohort")


class Recorder:
    def __init__(self, cli, folder, only):
        self.cli, self.folder, self.only, self.record = cli, folder, re.compile(only or ""), {}

    def plain(self, value):
        """Without what changes, and without places on the computer."""
        if isinstance(value, dict):
            return {k: self.plain(v) for k, v in value.items() if k not in CHANGING}
        if isinstance(value, list):
            return [self.plain(v) for v in value]
        return value.replace(str(self.folder), "(folder)") if isinstance(value, str) else value

    def digest(self, path):
        if path.suffix == ".json":
            try:
                # A digest of a report is a digest of its times.
                text = json.dumps(self.plain(json.loads(path.read_text())), sort_keys=True)
                return hashlib.sha256(re.sub(r'"file": "report[^}]*', "", text).encode()).hexdigest()
            except ValueError:
                pass
        return hashlib.sha256(path.read_bytes()).hexdigest()

    def run(self, name, *arguments, files=None):
        """Runs one command; files: the folder that it writes."""
        if not self.only.search(name):
            return
        done = subprocess.run([self.cli, *map(str, arguments), "--json", "--quiet"], capture_output=True, text=True)
        try:
            out = self.plain(json.loads(done.stdout))
        except ValueError:
            out = self.plain(done.stdout)
        if isinstance(out, dict) and "outputs" in out:
            out["outputs"] = [o for o in out["outputs"] if o["file"] not in TEXT_WITH_TIMES]
        said = self.plain(done.stderr.strip().splitlines()[-1]) if done.returncode and done.stderr.strip() else ""
        entry = {"exit": done.returncode, "said": said, "json": out, "files": {}}
        if files and files.is_dir():
            entry["files"] = {str(p.relative_to(files)): self.digest(p) for p in sorted(files.rglob("*"))
                              if p.is_file() and p.name not in TEXT_WITH_TIMES}
        self.record[name] = entry
        print(f"{name}: exit {done.returncode}, {len(entry['files'])} files", flush=True)

    def scene(self, name, scene):
        path = self.folder / f"{re.sub('[^a-zA-Z0-9]+', '-', name)}.json"
        path.write_text(json.dumps({"schema": "glisson/scene/1", **scene}))
        output = self.folder / path.stem
        self.run(f"plan {name}", "plan", path)
        self.run(name, "run", path, "--output", output, files=output)

    def patients(self):
        patients = self.folder / "patients"
        self.run("phantom", "phantom", "--cases", 2, "--seed", 1, "--output", patients, files=patients)
        one = patients / "patient-001"
        if not one.is_dir():
            if not any(map(self.only.search, OF_PATIENTS)):
                return
            subprocess.run([self.cli, "phantom", "--cases", "2", "--seed", "1", "--output", str(patients), "--quiet"], check=True)
        parts = ("--mre", one / "mre", "--roi", one / "rtstruct.dcm")
        self.run("scan", "scan", one)
        self.run("measure", "measure", *parts)
        self.run("measure on the MRI", "measure", *parts, "--mri", one / "mri", "--erode", 1, "--confidence", 0.9)
        self.run("measure, nothing there", "measure", *parts, "--erode-mm", 100)
        self.run("invert", "invert", "--phase", one / "mre" / "wave", "--frequency", 60)
        self.run("agree", "agree", one / "rtstruct.dcm", one / "rtstruct.dcm", "--mri", one / "mri", "--mre", one / "mre",
                 "--output", self.folder / "agree", files=self.folder / "agree")
        coarse = json.loads((one / "scene.json").read_text())
        coarse["geometry"]["cell_mm"] = 6
        for case in (one, patients / "patient-002"):
            (case / "scene.json").write_text(json.dumps(coarse))
        self.run("plan of a patient", "plan", one / "scene.json")
        self.run("a patient", "run", one / "scene.json", "--output", self.folder / "patient", files=self.folder / "patient")
        linear = {**coarse, "kinematics": "linear", "outputs": ["vessels", "overlay"], "solver": {"kind": "cg"}}
        linear["loads"] = [{**coarse["loads"][0], "contact": "patch"}]
        (one / "linear.json").write_text(json.dumps(linear))
        self.run("a patient, linear", "run", one / "linear.json", "--output", self.folder / "linear", files=self.folder / "linear")
        self.run("export", "export", one / "scene.json", "--output", self.folder / "export", "--to",
                 "rtstruct,seg,pmap,contours,nifti,vtu,csv", files=self.folder / "export")
        self.run("cohort", "cohort", patients, "--output", self.folder / "cohort", "--no-sensitivity", files=self.folder / "cohort")

    def studies(self):
        beam = self.folder / "beam.json"
        beam.write_text(json.dumps({"schema": "glisson/scene/1", **BEAM}))
        self.run("tradeoff", "tradeoff", beam, "--quick", "--output", self.folder / "tradeoff")
        self.run("validate", "validate", "--quick", "--output", self.folder / "validate")


def differences(before, after, at=""):
    """Where two records differ, as lines."""
    if isinstance(before, dict) and isinstance(after, dict):
        for key in sorted(before.keys() | after.keys()):
            if key not in before or key not in after:
                yield f"{at}/{key}: only {'after' if key in after else 'before'}"
            else:
                yield from differences(before[key], after[key], f"{at}/{key}")
    elif isinstance(before, list) and isinstance(after, list) and len(before) == len(after):
        for n, (a, b) in enumerate(zip(before, after)):
            yield from differences(a, b, f"{at}/{n}")
    elif before != after:
        yield f"{at}: {str(before)[:160]} | {str(after)[:160]}"


def load(place):
    path = pathlib.Path(place)
    return json.loads((path / "record.json" if path.is_dir() else path).read_text())


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("places", nargs=2, metavar="PLACE")
    options.add_argument("--compare", action="store_true")
    options.add_argument("--only", help="runs whose name this pattern is found in")
    given = options.parse_args()
    if given.compare:
        found = list(differences(*map(load, given.places)))
        print("\n".join(found) if found else "no difference")
        return 1 if found else 0
    folder = pathlib.Path(given.places[1])
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as work:
        recorder = Recorder(given.places[0], pathlib.Path(work), given.only)
        for name, scene in scenes():
            recorder.scene(name, scene)
        recorder.patients()
        recorder.studies()
    (folder / "record.json").write_text(json.dumps(recorder.record, indent=1, sort_keys=True) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
