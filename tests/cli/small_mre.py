# SPDX-License-Identifier: GPL-3.0-or-later
"""Small made-up elastography acquisitions, structure sets and segmentations, written with pydicom: 16 x 16 pixels of
4 mm, slices 8 mm apart. The region of most tests, x -16 to 16 and y -12 to 12 mm, holds 8 x 6 = 48 pixels of a slice."""
import hashlib
import struct

import pydicom
from pydicom.dataset import Dataset, FileDataset, FileMetaDataset
from pydicom.sequence import Sequence

MR, RTSS = "1.2.840.10008.5.1.4.1.1.4", "1.2.840.10008.5.1.4.1.1.481.3"
SEG, PMAP = "1.2.840.10008.5.1.4.1.1.66.4", "1.2.840.10008.5.1.4.1.1.30"
N, SPACING, STEP, FIRST = 16, 4.0, 8.0, -30.0
PER_SLICE = 48


def uid(name):
    return "2.25." + str(int.from_bytes(hashlib.sha256(name.encode()).digest()[:15], "big"))


def obj(sop, name, series, modality="MR"):
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID = sop, uid(name)
    meta.TransferSyntaxUID, meta.ImplementationClassUID = "1.2.840.10008.1.2.1", uid("implementation")
    d = FileDataset(None, {}, file_meta=meta, preamble=b"\0" * 128)
    d.is_little_endian, d.is_implicit_VR = True, False
    d.SOPClassUID, d.SOPInstanceUID = sop, uid(name)
    d.StudyDate, d.StudyTime, d.Modality = "20210304", "090000", modality
    d.PatientName, d.PatientID = "Made^Up", "MADE-UP"
    d.StudyInstanceUID, d.SeriesInstanceUID = uid("study"), uid(series)
    return d


def save(d, *parts):
    path = parts[0].joinpath(*parts[1:])
    path.parent.mkdir(parents=True, exist_ok=True)
    d.save_as(str(path), write_like_original=False)
    return path


def sides(left, right):
    """Rows of the left half of one value and the right half of another."""
    return [[left] * (N // 2) + [right] * (N // 2)] * N


def everywhere(value):
    return sides(value, value)


def slice_of(values, k, number, description, maker="GE MEDICAL SYSTEMS", sequence="epimre", frame="frame", series=None,
             shift=(0.0, 0.0, 0.0), image_type=("DERIVED", "PRIMARY", "OTHER"), rescale=None, name=None, add=(), **more):
    """add: elements that pydicom has no name for, as (tag, VR, value)."""
    series = series or f"series {number}"
    d = obj(MR, name or f"{series} {k}", series)
    d.Manufacturer, d.SeriesNumber, d.SeriesDescription, d.InstanceNumber = maker, number, description, k + 1
    d.ImageType = list(image_type)
    if frame:
        d.FrameOfReferenceUID = uid(frame)
    position = (FIRST + shift[0], FIRST + shift[1], STEP * k + shift[2])
    d.ImagePositionPatient = [str(v) for v in position]
    d.ImageOrientationPatient = ["1", "0", "0", "0", "1", "0"]
    d.PixelSpacing, d.SliceThickness = [str(SPACING)] * 2, str(STEP)
    d.SamplesPerPixel, d.PhotometricInterpretation = 1, "MONOCHROME2"
    d.Rows, d.Columns = len(values), len(values[0])
    d.BitsAllocated = d.BitsStored = 16
    d.HighBit, d.PixelRepresentation = 15, 0
    d.PixelData = b"".join(struct.pack(f"<{len(row)}H", *row) for row in values)
    if sequence:
        d.add_new(0x00190010, "LO", "GEMS_ACQU_01")
        d.add_new(0x0019109C, "LO", sequence)
    if rescale:
        d.RescaleSlope, d.RescaleIntercept, d.RescaleType = rescale
    for key, value in more.items():
        setattr(d, key, value)
    for element in add:
        d.add_new(*element)
    return d


def write(folder, number, values, description, slices=3, **more):
    """One series; values: rows, or a function of the slice. Returns its images."""
    images = []
    for k in range(slices):
        images.append(slice_of(values(k) if callable(values) else values, k, number, description, **more))
        save(images[-1], folder, f"{number}-{more.get('name', '')}{k}.dcm")
    return images


def siemens(folder, number, values, description, **more):
    return write(folder, number, values, description, maker="SIEMENS", sequence=None, **more)


def code(value, scheme, meaning):
    c = Dataset()
    c.CodeValue, c.CodingSchemeDesignator, c.CodeMeaning = value, scheme, meaning
    return c


def scale(slope, unit, first=0, last=65535, table=None, quantity=None):
    """An item of a real-world value map."""
    r = Dataset()
    r.LUTExplanation, r.LUTLabel = "scale", "SCALE"
    r.MeasurementUnitsCodeSequence = Sequence([code(unit, "UCUM", unit)])
    r.add_new(0x00409216, "US", first)
    r.add_new(0x00409211, "US", last)
    if table:
        r.add_new(0x00409212, "FD", table)
    else:
        r.RealWorldValueIntercept, r.RealWorldValueSlope = 0.0, slope
    if quantity:
        q = Dataset()
        q.ValueType = "CODE"
        q.ConceptNameCodeSequence = Sequence([code("246205007", "SCT", "Quantity")])
        q.ConceptCodeSequence = Sequence([quantity])
        r.QuantityDefinitionSequence = Sequence([q])
    return r


def box(z, half=16.0):
    return [(-half, -12, z), (half, -12, z), (half, 12, z), (-half, 12, z)]


def structures(path, rois, images=(), frames=("frame",), series="structures", date=None):
    """rois: (number, name, frame or None, [(points, image or None)]). frames: those the set lists."""
    d = obj(RTSS, str(path), series, "RTSTRUCT")
    d.SeriesNumber, d.StructureSetLabel, d.StructureSetDate = 900, "SET", date or "20210304"
    listed = []
    for frame in frames:
        item = Dataset()
        item.FrameOfReferenceUID = uid(frame)
        mine = [i for i in images if i.get("FrameOfReferenceUID") == uid(frame)]
        if mine:
            study, of = Dataset(), Dataset()
            study.ReferencedSOPClassUID, study.ReferencedSOPInstanceUID = "1.2.840.10008.3.1.2.3.1", mine[0].StudyInstanceUID
            of.SeriesInstanceUID = mine[0].SeriesInstanceUID
            of.ContourImageSequence = Sequence([reference(i) for i in mine])
            study.RTReferencedSeriesSequence = Sequence([of])
            item.RTReferencedStudySequence = Sequence([study])
        listed.append(item)
    if listed:
        d.ReferencedFrameOfReferenceSequence = Sequence(listed)
    about, drawn = [], []
    for number, name, frame, contours in rois:
        a, b = Dataset(), Dataset()
        a.ROINumber, a.ROIName, a.ROIGenerationAlgorithm = number, name, "MANUAL"
        if frame:
            a.ReferencedFrameOfReferenceUID = uid(frame)
        items = []
        for points, image in contours:
            c = Dataset()
            if image is not None:
                c.ContourImageSequence = Sequence([reference(image)])
            c.ContourGeometricType, c.NumberOfContourPoints = "CLOSED_PLANAR", len(points)
            c.ContourData = [f"{v:.10g}" for p in points for v in p]
            items.append(c)
        if items:
            b.ContourSequence = Sequence(items)
        b.ReferencedROINumber = number
        about.append(a)
        drawn.append(b)
    d.StructureSetROISequence, d.ROIContourSequence = Sequence(about), Sequence(drawn)
    return save(d, path)


def reference(image):
    r = Dataset()
    r.ReferencedSOPClassUID, r.ReferencedSOPInstanceUID = image.SOPClassUID, image.SOPInstanceUID
    return r


def liver(path, slices=3, images=None, **more):
    """The region of most tests; images: that the contours name."""
    contours = [(box(STEP * k), images[k] if images else None) for k in range(slices)]
    return structures(path, [(1, "Liver", "frame", contours)], images or (), **more)


def parametric_map(path, value, unit, quantity, description):
    d = obj(PMAP, str(path), "map")
    d.SeriesNumber, d.SeriesDescription, d.ImageType = 77, description, ["DERIVED", "PRIMARY", "STIFFNESS", "NONE"]
    d.FrameOfReferenceUID = uid("frame")
    d.SamplesPerPixel, d.PhotometricInterpretation, d.Rows, d.Columns, d.BitsAllocated = 1, "MONOCHROME2", N, N, 32
    d.NumberOfFrames = 3
    shared, measures, plane = Dataset(), Dataset(), Dataset()
    measures.PixelSpacing, measures.SliceThickness = [SPACING, SPACING], STEP
    plane.ImageOrientationPatient = [1, 0, 0, 0, 1, 0]
    shared.PixelMeasuresSequence, shared.PlaneOrientationSequence = Sequence([measures]), Sequence([plane])
    item = scale(1.0, unit, quantity=quantity)
    del item[0x00409216], item[0x00409211]
    item.DoubleFloatRealWorldValueFirstValueMapped, item.DoubleFloatRealWorldValueLastValueMapped = 0.0, 1e6
    shared.RealWorldValueMappingSequence = Sequence([item])
    d.SharedFunctionalGroupsSequence = Sequence([shared])
    frames = []
    for k in range(3):
        f, p = Dataset(), Dataset()
        p.ImagePositionPatient = [FIRST, FIRST, STEP * k]
        f.PlanePositionSequence = Sequence([p])
        frames.append(f)
    d.PerFrameFunctionalGroupsSequence = Sequence(frames)
    d.FloatPixelData = struct.pack(f"<{3 * N * N}f", *([value] * (3 * N * N)))
    return save(d, path)


def segmentation(path, slices, images, sources, frame="frame"):
    """Segment "liver" on 8 x 6 pixels of each slice; sources: which image each frame names."""
    d = obj(SEG, str(path), "segmentation", "SEG")
    d.SeriesNumber, d.ImageType, d.SegmentationType = 300, ["DERIVED", "PRIMARY"], "BINARY"
    if frame:
        d.FrameOfReferenceUID = uid(frame)
    d.SamplesPerPixel, d.PhotometricInterpretation, d.Rows, d.Columns = 1, "MONOCHROME2", N, N
    d.BitsAllocated = d.BitsStored = 1
    d.HighBit, d.PixelRepresentation, d.NumberOfFrames = 0, 0, len(slices)
    s = Dataset()
    s.SegmentNumber, s.SegmentLabel, s.SegmentAlgorithmType = 1, "liver", "MANUAL"
    s.SegmentedPropertyCategoryCodeSequence = Sequence([code("123037004", "SCT", "Anatomical Structure")])
    s.SegmentedPropertyTypeCodeSequence = Sequence([code("10200004", "SCT", "Liver")])
    d.SegmentSequence = Sequence([s])
    shared, measures, plane, which = Dataset(), Dataset(), Dataset(), Dataset()
    measures.PixelSpacing, measures.SliceThickness, measures.SpacingBetweenSlices = [SPACING, SPACING], STEP, STEP
    plane.ImageOrientationPatient = [1, 0, 0, 0, 1, 0]
    which.ReferencedSegmentNumber = 1
    shared.PixelMeasuresSequence, shared.PlaneOrientationSequence = Sequence([measures]), Sequence([plane])
    shared.SegmentIdentificationSequence = Sequence([which])
    d.SharedFunctionalGroupsSequence = Sequence([shared])
    frames, bits = [], []
    for k, source in zip(slices, sources):
        f, p, derived = Dataset(), Dataset(), Dataset()
        p.ImagePositionPatient = [FIRST, FIRST, STEP * k]
        f.PlanePositionSequence = Sequence([p])
        derived.SourceImageSequence = Sequence([reference(images[source])])
        f.DerivationImageSequence = Sequence([derived])
        frames.append(f)
        bits += [1 if 4 <= i < 12 and 5 <= j < 11 else 0 for j in range(N) for i in range(N)]
    d.PerFrameFunctionalGroupsSequence = Sequence(frames)
    packed = bytearray((len(bits) + 7) // 8)
    for n, bit in enumerate(bits):
        packed[n // 8] |= bit << (n % 8)
    d.PixelData = bytes(packed + b"\0" * (len(packed) % 2))
    d["PixelData"].VR = "OB"
    return save(d, path)
