# SPDX-License-Identifier: GPL-3.0-or-later
"""Small DICOM objects made by the tests themselves: slices, multi-frame images, structure sets, segmentations."""
import hashlib

import pydicom
from pydicom.dataset import Dataset, FileDataset, FileMetaDataset
from pydicom.sequence import Sequence
from pydicom.uid import ExplicitVRLittleEndian

MR, ENHANCED = "1.2.840.10008.5.1.4.1.1.4", "1.2.840.10008.5.1.4.1.1.4.1"
STRUCTURES, LABEL_MAP = "1.2.840.10008.5.1.4.1.1.481.3", "1.2.840.10008.5.1.4.1.1.66.7"
ROWS, COLUMNS, PIXEL = 24, 30, 2.0
ORIGIN = (-29.0, -23.0)  # centre of the first pixel: the field spans -30 .. 30 and -24 .. 24 mm


def uid(name):
    return "2.25." + str(int.from_bytes(hashlib.sha256(name.encode()).digest()[:15], "big"))


def words(values):
    return b"".join(int(v).to_bytes(2, "little") for v in values)


def items(**fields):
    one = Dataset()
    for key, value in fields.items():
        setattr(one, key, value)
    return Sequence([one])


def base(sop_class, name, series, modality="MR"):
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID = sop_class, uid(name)
    meta.TransferSyntaxUID = ExplicitVRLittleEndian
    d = FileDataset(None, {}, file_meta=meta, preamble=b"\0" * 128)
    d.is_little_endian, d.is_implicit_VR = True, False
    d.SOPClassUID, d.SOPInstanceUID, d.Modality = sop_class, uid(name), modality
    d.PatientID, d.PatientName, d.StudyDate = "T-1", "Test^One", "20240102"
    d.StudyInstanceUID, d.SeriesInstanceUID, d.FrameOfReferenceUID = uid("study"), uid(series), uid("frame")
    return d


def grey(d, pixels, bits=16):
    d.SamplesPerPixel, d.PhotometricInterpretation, d.Rows, d.Columns = 1, "MONOCHROME2", ROWS, COLUMNS
    d.BitsAllocated = d.BitsStored = bits
    d.HighBit, d.PixelRepresentation, d.PixelData = bits - 1, 0, pixels
    d["PixelData"].VR = "OW" if bits > 8 else "OB"


def image(folder, k, z, value=2000, series="stiffness", number=401, description="MRE stiffness (Pa)", name=None, **more):
    """One slice at height z; value: of all pixels, or of the left (x < 0) and right half."""
    left, right = value if isinstance(value, tuple) else (value, value)
    d = base(MR, f"{series}{k}", series)
    d.SeriesNumber, d.InstanceNumber, d.SeriesDescription = number, k + 1, description
    d.ImageType, d.SliceThickness, d.PixelSpacing = ["DERIVED", "PRIMARY", "OTHER"], "10", [PIXEL, PIXEL]
    d.ImageOrientationPatient = [1, 0, 0, 0, 1, 0]
    d.ImagePositionPatient = [ORIGIN[0], ORIGIN[1], round(z, 6)]
    grey(d, words(([left] * (COLUMNS // 2) + [right] * (COLUMNS // 2)) * ROWS))
    if "(Pa)" in description:
        d.RescaleSlope, d.RescaleIntercept, d.RescaleType = "1", "0", "Pa"
    for key, v in more.items():
        setattr(d, key, v)
    folder.mkdir(parents=True, exist_ok=True)
    d.save_as(folder / (name or f"{series}{k:02d}.dcm"), write_like_original=False)
    return d


def stiffness(folder, heights=(0.0, 10.0, 20.0, 30.0), **more):
    return [image(folder, k, z, value=(2000, 4000), **more) for k, z in enumerate(heights)]


def rectangle(x0, x1, y0, y1, z):
    return [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)]


def outlines(path, contours, kind="CLOSED_PLANAR"):
    """contours: lists of points, all of one structure called Liver."""
    d = base(STRUCTURES, path.name, "structures", "RTSTRUCT")
    del d.FrameOfReferenceUID
    d.StructureSetLabel = "T"
    d.ReferencedFrameOfReferenceSequence = items(FrameOfReferenceUID=uid("frame"))
    d.StructureSetROISequence = items(ROINumber=1, ReferencedFrameOfReferenceUID=uid("frame"), ROIName="Liver")
    all_ = []
    for points in contours:
        one = Dataset()
        one.ContourGeometricType, one.NumberOfContourPoints = kind, len(points)
        one.ContourData = [f"{v:.10g}" for p in points for v in p]
        all_.append(one)
    roi = Dataset()
    roi.ContourSequence, roi.ReferencedROINumber = Sequence(all_), 1
    d.ROIContourSequence = Sequence([roi])
    d.save_as(path, write_like_original=False)
    return path


def multi_frame(path, frames, sop_class=ENHANCED, series="enhanced", modality="MR", bits=16, pointers=(), **more):
    """frames: (z, pixels as bytes, fields of the frame content, further functional groups)."""
    d = base(sop_class, path.name, series, modality)
    d.SeriesNumber, d.InstanceNumber, d.SeriesDescription, d.NumberOfFrames = 7, 1, "T1 axial", len(frames)
    d.ImageType = ["ORIGINAL", "PRIMARY", "VOLUME", "NONE"]
    d.SharedFunctionalGroupsSequence = items(
        PixelMeasuresSequence=items(PixelSpacing=[PIXEL, PIXEL], SliceThickness=10),
        PlaneOrientationSequence=items(ImageOrientationPatient=[1, 0, 0, 0, 1, 0]))
    per_frame = []
    for z, _, content, groups in frames:
        f = Dataset()
        f.PlanePositionSequence = items(ImagePositionPatient=[ORIGIN[0], ORIGIN[1], z])
        f.FrameContentSequence = items(**content)
        for key, value in groups.items():
            setattr(f, key, value)
        per_frame.append(f)
    d.PerFrameFunctionalGroupsSequence = Sequence(per_frame)
    if pointers:
        dimensions = []
        for pointer in pointers:
            one = Dataset()
            one.DimensionIndexPointer = pointer
            dimensions.append(one)
        d.DimensionIndexSequence = Sequence(dimensions)
    grey(d, b"".join(f[1] for f in frames), bits)
    for key, value in more.items():
        setattr(d, key, value)
    path.parent.mkdir(parents=True, exist_ok=True)
    d.save_as(path, write_like_original=False)
    return path


def read(path):
    return pydicom.dcmread(path)
