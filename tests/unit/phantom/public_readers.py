# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a written phantom patient with public tools only (pydicom, dcm2niix) and compares with its truth.

usage: public_readers.py PATIENT_FOLDER        exit code 77: the tools are not installed
"""
import glob
import gzip
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile

try:
    import numpy
    import pydicom
except ImportError:
    print("pydicom or numpy is not installed")
    sys.exit(77)

folder = sys.argv[1]
failures = []


def check(condition, message):
    if not condition:
        failures.append(message)


def series(name):
    files = [pydicom.dcmread(f) for f in glob.glob(os.path.join(folder, name, "*.dcm"))]
    files.sort(key=lambda f: float(f.ImagePositionPatient[2]))
    return files


truth = json.load(open(os.path.join(folder, "truth.json")))
names = ["mri", "mre/magnitude", "mre/stiffness", "mre/wave", "mre/confidence", "mre/colour"]
all_series = {name: series(name) for name in names}

frames, series_uids, sop_uids = set(), set(), set()
for name, files in all_series.items():
    check(len(files) > 5, f"{name}: {len(files)} slices")
    frames.update(f.FrameOfReferenceUID for f in files)
    series_uids.update(f.SeriesInstanceUID for f in files)
    sop_uids.update(f.SOPInstanceUID for f in files)
    steps = len({f.get("TemporalPositionIdentifier") for f in files})
    check(steps == (4 if name == "mre/wave" else 1), f"{name}: {steps} time steps")
    z = numpy.array([float(f.ImagePositionPatient[2]) for f in files])[::steps]
    check(len(z) * steps == len(files), f"{name}: every step has every slice")
    spacing = float(files[0].SpacingBetweenSlices)
    check(numpy.allclose(numpy.diff(z), spacing, atol=1e-6), f"{name}: uneven slices")
    for f in files:
        check(f.Manufacturer == "GE MEDICAL SYSTEMS" and f.ManufacturerModelName == "DISCOVERY MR750", f"{name}: maker")
        check(f.PatientName.family_name == "PHANTOM", f"{name}: patient")
        for tag in ("PixelSpacing", "ImagePositionPatient", "ImageOrientationPatient"):
            raw = f.get(tag)
            check(all(len(str(v)) <= 16 for v in raw), f"{name}: {tag} too long")
        check(f.pixel_array.shape[:2] == (256, 256), f"{name}: pixels")
check(len(frames) == 1, "one frame of reference")
check(len(series_uids) == len(names), "one series UID per series")
check(len(sop_uids) == sum(len(f) for f in all_series.values()), "SOP instance UIDs are unique")

stiffness = all_series["mre/stiffness"]
confidence = all_series["mre/confidence"]
check(stiffness[0].SeriesNumber % 100 == 1 and confidence[0].SeriesNumber % 100 == 7, "series numbers")
check(all_series["mre/wave"][0].SeriesNumber % 100 == 5, "series number of the wave")
check(stiffness[0][0x0019, 0x0010].value == "GEMS_ACQU_01", "private creator")
check(str(stiffness[0][0x0019, 0x109C].value) == "fgremre", "pulse sequence")
check(all_series["mre/colour"][0].PhotometricInterpretation == "RGB", "colour copy")
wave = all_series["mre/wave"][0]
check(int(wave.NumberOfTemporalPositions) == 4, "time steps of the wave")
check(abs(float(wave.WindowWidth) - 6283) < 1e-9 and float(wave.WindowCenter) == 0, "wave window")

# The mean that a reader measures with the confidence mask inside the structure's contours is the truth, to the noise.
rtstruct = os.path.join(folder, "rtstruct.dcm")
check(os.path.exists(rtstruct), "rtstruct.dcm is missing")
if os.path.exists(rtstruct):
    structures = pydicom.dcmread(rtstruct)
    known = {f.SOPInstanceUID: f for f in all_series["mri"]}
    planes = {round(float(f.ImagePositionPatient[2]), 3): i for i, f in enumerate(stiffness)}
    inside = numpy.zeros((len(stiffness), 256, 256), bool)
    rows, columns = numpy.mgrid[0:256, 0:256]
    for contour in structures.ROIContourSequence[0].ContourSequence:
        image = known.get(contour.ContourImageSequence[0].ReferencedSOPInstanceUID)
        check(image is not None, "a contour refers to no MRI slice")
        points = numpy.array([float(v) for v in contour.ContourData]).reshape(-1, 3)
        check(image is not None and abs(points[0, 2] - float(image.ImagePositionPatient[2])) < 1e-3, "contour off its slice")
        plane = planes.get(round(points[0, 2], 3))
        if plane is None:
            continue
        origin = [float(v) for v in stiffness[plane].ImagePositionPatient]
        px, py = (points[:, 0] - origin[0]) / 1.64, (points[:, 1] - origin[1]) / 1.64
        odd = numpy.zeros((256, 256), bool)
        for i in range(len(px)):
            x0, y0, x1, y1 = px[i - 1], py[i - 1], px[i], py[i]
            if y0 == y1:
                continue
            crosses = (y0 > rows) != (y1 > rows)
            odd ^= crosses & (columns < x0 + (rows - y0) * (x1 - x0) / (y1 - y0))
        inside[plane] ^= odd
    values = numpy.stack([f.pixel_array for f in stiffness]) / 1000.0
    good = inside & (numpy.stack([f.pixel_array for f in confidence]) >= 950)
    mean = values[good].mean()
    check(abs(mean - truth["shear_kPa"]) < 0.005 * truth["shear_kPa"], f"measured {mean:.4f}, truth {truth['shear_kPa']:.4f} kPa")

if shutil.which("dcm2niix"):
    with tempfile.TemporaryDirectory() as out:
        done = subprocess.run(["dcm2niix", "-z", "y", "-f", "out", "-o", out, os.path.join(folder, "mri")], capture_output=True, text=True)
        niftis = glob.glob(os.path.join(out, "*.nii.gz"))
        check(len(niftis) == 1, f"dcm2niix made {len(niftis)} volumes of the MRI")
        if len(niftis) == 1:
            raw = gzip.open(niftis[0]).read()
            dim = struct.unpack("<8h", raw[40:56])
            srow = numpy.array(struct.unpack("<12f", raw[280:328])).reshape(3, 4)
            check(dim[1:4] == (256, 256, len(all_series["mri"])), f"dcm2niix: size {dim[1:4]}")
            # The centre of the volume in RAS is (-x, -y, z) of that in LPS, whichever way the rows are stored.
            middle = srow @ numpy.array([127.5, 127.5, (dim[3] - 1) / 2, 1.0])
            first, last = (numpy.array([float(v) for v in all_series["mri"][i].ImagePositionPatient]) for i in (0, -1))
            lps = (first + last) / 2 + numpy.array([127.5 * 1.64, 127.5 * 1.64, 0])
            check(numpy.allclose(middle, lps * [-1, -1, 1], atol=1e-3), f"dcm2niix: centre {middle}")
            size = numpy.linalg.norm(srow[:, :3], axis=0)
            check(numpy.allclose(size, [1.64, 1.64, 2.5], atol=1e-4), f"dcm2niix: voxel {size}")

for message in failures[:20]:
    print(message)
sys.exit(1 if failures else 0)
