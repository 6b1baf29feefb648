# SPDX-License-Identifier: GPL-3.0-or-later
"""Made-up elastography acquisitions drawn at random, with the answer known: vendors, scales and units, padding, what
pairs the products of one acquisition, what is missing, orientations, styles of outlines."""
import dataclasses
import math
import random

from pydicom.dataset import Dataset
from pydicom.sequence import Sequence

import small_mre as small
from small_mre import N, SPACING, STEP

SLICES = 4
PADDING = 60000
LEFT, RIGHT = range(N // 2), range(N // 2, N)


@dataclasses.dataclass
class Case:
    """What was written and what is right. said: codes (or words of a remark) one of which must be told, for each doubt;
    or_refused: words of refusals that are as right as the answer."""
    folder: object
    roi: object = None
    arguments: list = dataclasses.field(default_factory=list)
    voxels: list = dataclasses.field(default_factory=list)  # kPa of the shear modulus, of each voxel that counts
    unmasked: list = dataclasses.field(default_factory=list)  # the same where no confidence map is used
    said: list = dataclasses.field(default_factory=list)
    or_refused: list = dataclasses.field(default_factory=list)
    only_refused: bool = False
    story: list = dataclasses.field(default_factory=list)
    odd: int = -1  # the slice in another unit than the others

    def tell(self, *codes):
        self.said.append(set(codes))


def rotation(r):
    """Row, column and normal of the slices: along the patient's axes, mirrored to either side, or oblique."""
    axes = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
    kind = r.choice(["axial", "axial", "turned", "oblique"])
    if kind == "turned":
        r.shuffle(axes)
        axes = [tuple(r.choice([-1, 1]) * v for v in a) for a in axes]
    if kind == "oblique":
        q = [r.gauss(0, 1) for _ in range(4)]
        length = math.sqrt(sum(v * v for v in q))
        w, x, y, z = (v / length for v in q)
        axes = [(1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
                (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x))]
    row, column = axes[0], axes[1]
    normal = tuple(row[(a + 1) % 3] * column[(a + 2) % 3] - row[(a + 2) % 3] * column[(a + 1) % 3] for a in range(3))
    return row, column, normal


class Place:
    """Where voxels lie in the patient."""

    def __init__(self, r):
        self.row, self.column, self.normal = rotation(r)
        self.first = [r.uniform(-100, 100) for _ in range(3)]

    def point(self, i, j, k):
        return tuple(self.first[a] + SPACING * (i * self.row[a] + j * self.column[a]) + STEP * k * self.normal[a]
                     for a in range(3))

    def fields(self, k, shift=(0, 0), digits=6):
        return {"ImagePositionPatient": [f"{v:.{digits}f}" for v in self.point(shift[0], shift[1], k)],
                "ImageOrientationPatient": [f"{v:.9f}" for v in (*self.row, *self.column)]}


def scaled(r, case, vendor):
    """A way of writing values: (stored value of kPa and slice, fields of the slice, word of the description)."""
    def rescale(slope, kind):
        return lambda k: {"rescale": (f"{slope(k):.10g}", "0", kind)}

    def maps(*items, us=False):
        return lambda k: {"RealWorldValueMappingSequence": Sequence(list(items)),
                          **({"rescale": ("1", "0", "US")} if us else {})}

    ways = ["Pa", "kPa", "slopes", "mixed", "map", "map and rescale", "table", "youngs", "speed", "words", "nothing"]
    way = r.choice(ways)
    case.story.append("written as " + way)
    milli = lambda v, k: round(1000 * v)
    if way == "Pa":
        return milli, rescale(lambda k: 1, "Pa"), ""
    if way == "kPa":
        return milli, rescale(lambda k: 0.001, r.choice(["kPa", "KPA", "kilopascal"])), ""
    if way == "slopes":
        return lambda v, k: round(1000 * v / (k + 1)), rescale(lambda k: 0.001 * (k + 1), "kPa"), ""
    if way == "mixed":
        odd = r.randrange(SLICES)
        case.odd = odd
        return milli, lambda k: rescale(lambda _: 1, "Pa")(k) if k == odd else rescale(lambda _: 0.001, "kPa")(k), ""
    if way in ("map", "map and rescale"):
        return milli, maps(small.scale(0.001, "kPa"), us=way != "map"), ""
    if way == "table":
        table = small.scale(None, "kPa", 900, 6100, [0.001 * n for n in range(900, 6101)])
        return milli, maps(table), ""
    if way == "youngs":
        quantity = small.code("E", "99OTHER", "Young's modulus")
        return lambda v, k: round(3000 * v), maps(small.scale(0.001, "kPa", quantity=quantity)), ""
    if way == "speed":
        case.tell("speed-turned-into-shear")
        return lambda v, k: round(1000 * math.sqrt(v)), rescale(lambda k: 0.001, "m/s"), ""
    if way == "words":
        if vendor == "GE":
            case.tell("unit-by-words")
        return milli, lambda k: {"rescale": ("0.001", "0", "US")}, " [kPa]"
    if vendor == "GE":  # its own way: Pa
        return milli, lambda k: {}, ""
    case.or_refused, case.only_refused = ["does not say in which unit"], True
    return milli, lambda k: {}, ""


MAKERS = {"GE": "GE MEDICAL SYSTEMS", "Siemens": "SIEMENS", "Philips": "Philips Medical Systems", "other": "ACME"}


class Writer:
    """One examination: acquisitions of one vendor, in files of no order."""

    def __init__(self, r, folder):
        self.r, self.case, self.place = r, Case(folder), Place(r)
        self.vendor = r.choice(list(MAKERS))
        self.files = 0
        self.count = r.choice([1, 1, 2, 3])
        self.taken = r.randrange(self.count)
        numbered = ["numbers"] if self.vendor in ("GE", "Philips") else []
        self.tie = r.choice(numbered or ["acquisition", "uid", "time", "frame", "references", "order"])
        self.case.story.append(f"{self.vendor}, {self.count} acquisitions tied by {self.tie}, {self.taken} taken")

    def number(self, acquisition, product):
        if self.tie == "numbers":
            return 100 * (acquisition + 3) + product
        return 10 * (acquisition + 1) + product

    def tied(self, acquisition, k):
        if self.tie == "acquisition":
            return {"AcquisitionNumber": acquisition + 1}
        if self.tie == "uid":
            return {"add": [(0x00080017, "UI", small.uid(f"acquisition {acquisition}"))]}
        if self.tie == "time":
            return {"AcquisitionTime": f"10{10 + 7 * acquisition:02d}{k:02d}"}
        return {}

    def frame(self, acquisition):
        return f"frame {acquisition}" if self.tie == "frame" else "frame"

    def save(self, values, k, number, description, acquisition, frame=None, shift=(0, 0), **more):
        self.files += 1
        d = small.slice_of(values, k, number, description, maker=MAKERS[self.vendor],
                           sequence="epimre" if self.vendor == "GE" else None, frame=frame or self.frame(acquisition),
                           **{**self.place.fields(k, shift), **self.tied(acquisition, k), **more})
        name = f"{self.r.randrange(10 ** 6):06d}-{self.files}.dcm"
        small.save(d, self.case.folder / "mre", name)
        return d

    def stiffness(self, a, values, stored, fields, word, missing):
        images = {}
        for k in range(SLICES):
            if k in missing:
                continue
            rows = [[PADDING if values[j][i] is None else stored(values[j][i], k) for i in range(N)] for j in range(N)]
            more = fields(k)
            if any(v is None for line in values for v in line):
                more = {**more, **self.r.choice([{"PixelPaddingValue": PADDING},
                                                 {"PixelPaddingValue": PADDING + 99, "PixelPaddingRangeLimit": PADDING - 99}])}
            if missing == {SLICES - 1}:
                more["ImagesInAcquisition"] = SLICES
            images[k] = self.save(rows, k, self.number(a, 1), "MRE stiffness" + word, a, **more)
        return images

    def confidence(self, a, values, images, missing, full, **more):
        for k in range(SLICES):
            if k in missing:
                continue
            rows = [[full if v > 0.9 else full // 3 for v in line] for line in values]
            named = more
            if self.tie == "references" and k in images:
                named = {**more, "SourceImageSequence": Sequence([small.reference(images[k])])}
            self.save(rows, k, self.number(a, 7), "MRE confidence map", a, **named)


def pattern(r, of):
    """One value for either half of the columns and rows."""
    a = [[of() for _ in range(2)] for _ in range(2)]
    return [[a[j * 2 // N][i * 2 // N] for i in range(N)] for j in range(N)]


def acquisitions(w):
    """Writes them; returns values, confidence and slices of the one that is asked for, and its images."""
    r, case = w.r, w.case
    stored, fields, word = scaled(r, case, w.vendor)
    answer = None
    if w.tie == "references" and w.count == 1:
        w.tie = "order"
    for a in range(w.count):
        mine = a == w.taken
        values = pattern(r, lambda: r.randrange(1000, 6000) / 1000)
        if r.random() < 0.25:
            columns = r.choice([range(0, 5), range(11, N)])
            values = [[None if i in columns else v for i, v in enumerate(line)] for line in values]
        sure = pattern(r, lambda: r.choice([1.0, 1.0, 0.3]))
        gap = r.choice([set(), set(), set(), {1}, {SLICES - 1}]) if mine else set()
        if mine and gap:
            case.story.append(f"slices {gap} missing")
            case.tell("slices-uneven" if gap == {1} else "images-missing")
        lost, full = set(gap), 999
        whole = all(v == 0.3 for line in sure for v in line)
        kind = r.choice(["right", "right", "right", "shorter", "frame", "bytes", "none"]) if mine else "right"
        if whole and kind != "none":
            sure = [[1.0] * N for _ in range(N)]
        if kind in ("shorter", "frame") and (gap or w.tie == "frame"):
            kind = "right"
        if kind == "shorter":
            lost = {0}
            case.tell("confidence-covers-less")
        if kind == "bytes":
            full = 255
            case.tell("confidence-scale-taken")
        if kind == "frame":
            case.tell("partner-doubtful", "partner-contradicted", "partner-elsewhere")
        if kind == "none":
            case.tell("no-confidence-map")
        case.story.append(f"confidence of {a}: {kind}")
        images = w.stiffness(a, values, stored, fields, word, gap)
        if kind != "none":
            w.confidence(a, sure, images, lost, full, **({"frame": "elsewhere"} if kind == "frame" else {}))
        if mine:
            trusted = [[kind == "none" or v > 0.9 for v in line] for line in sure]
            there = set(range(SLICES)) - gap - (lost if kind != "none" else set())
            answer = values, trusted, there, images
    if case.odd in answer[3]:
        case.tell("units-differ")
    if w.count > 1:
        case.arguments += ["--role", f"{w.number(w.taken, 1)}=stiffness"]
        # Where a slice of one is missing, its place tells the acquisitions apart.
        if w.tie == "order" and len(answer[3]) == SLICES:
            case.tell("partner-by-order", "partner-ambiguous", "no-confidence-map", "partner-elsewhere")
    return answer


def ring(i0, i1, j0, j1):
    return [(i0 - 0.5, j0 - 0.5), (i1 - 0.5, j0 - 0.5), (i1 - 0.5, j1 - 0.5), (i0 - 0.5, j1 - 0.5)]


def turned(r, points):
    at = r.randrange(len(points))
    points = points[at:] + points[:at]
    return points[::-1] if r.random() < 0.5 else points


def outlines(r, case, k, style, kinds):
    """Rings of slice k (of pixels, the height in slices), of the region that is drawn; and its pixels."""
    i0, i1, j0, j1 = 2, 14, 3, 13
    inside = {(i, j) for i in range(i0, i1) for j in range(j0, j1)}
    outer, hole = ring(i0, i1, j0, j1), ring(5, 8, 5, 9)
    pixels = {(i, j) for i in range(5, 8) for j in range(5, 9)}
    rings = [(outer, 0.0)]
    if style == "repeated" and k == 1:
        rings.append((turned(r, list(outer)), 0.0))
    if style == "nearly repeated" and k == 1:
        rings.append(([(i + 0.02, j - 0.01) for i, j in outer], 0.0))
    if style == "overlapping" and k != 2:
        rings = [(ring(i0, 9, j0, j1), 0.0), (ring(6, i1, j0, j1), 0.0)]
    if style == "touching":
        rings = [(ring(i0, 8, j0, j1), 0.0), (ring(8, i1, j0, j1), 0.0)]
    if style == "two heights" and k == 1:
        rings = [(ring(i0, 7, j0, j1), 0.0), (ring(9, i1, j0, j1), 0.15)]
        inside -= {(i, j) for i in (7, 8) for j in range(j0, j1)}
    if style == "inclusion" or style == "parity":
        rings.append((hole, 0.0))
        inside -= pixels
    if style == "keyhole":
        rings = [(outer[:1] + hole[:1] + hole[:0:-1] + hole[:1] + outer[:1] + outer[1:], 0.0)]
        inside -= pixels
    if style == "speck":
        rings.append(([(0.2, 0.2), (0.3, 0.2), (0.3, 0.3), (0.2, 0.3)], 0.0))
    kinds.add("CLOSEDPLANAR_XOR" if style == "parity" else "CLOSED_PLANAR")
    return [(turned(r, list(points)), up) for points, up in rings], inside


STYLES = {"one": None, "repeated": "outlines-repeated", "nearly repeated": "outlines-repeated",
          "overlapping": "outlines-overlap", "touching": None, "two heights": "outlines-off-plane", "inclusion": None,
          "parity": None, "keyhole": None, "speck": None}


def region(w, images, there):
    """Writes the structure set; returns the pixels of each slice."""
    r, case = w.r, w.case
    style = r.choice(list(STYLES))
    doubt = r.choice([None, None, None, "reversed", "no frame", "other frame", "sparse"])
    frame = w.frame(w.taken)
    case.story.append(f"outlines: {style}, {doubt}")
    if STYLES[style]:
        case.tell(STYLES[style])
    kinds, contours, pixels = set(), [], {}
    for k in range(SLICES):
        if k not in images or (doubt == "sparse" and k == 2):
            continue
        rings, pixels[k] = outlines(r, case, k, style, kinds)
        named = images[max(images) - k + min(images)] if doubt == "reversed" and max(images) - k + min(images) in images \
            else images[k]
        contours += [([w.place.point(i, j, k + up) for i, j in points], named) for points, up in rings]
    if style in ("repeated", "nearly repeated", "two heights") and 1 not in pixels:
        case.said = [s for s in case.said if s != {STYLES[style]}]
    if doubt == "reversed":
        case.tell("off-the-named-image")
    if doubt == "no frame":
        case.tell("outline-frame-missing")
    if doubt == "other frame":
        case.tell("different frames of reference")
    if doubt == "sparse" and 2 in images and max(images) > 2 and min(images) < 2:
        # Slices that lie unevenly are taken one by one: none of them lies between outlines.
        case.tell("slices-without-outline")
    own = {"no frame": None, "other frame": "another frame"}.get(doubt, frame)
    rois = [(1, "Spleen", own, contours[:1]), (2, "Liver", own, contours)]
    path = small.structures(case.folder / "roi.dcm", rois, list(images.values()), [own] if own else [])
    case.roi = rewritten(path, kinds.pop())
    return pixels


def rewritten(path, kind):
    if kind == "CLOSED_PLANAR":
        return path
    import pydicom
    d = pydicom.dcmread(path)
    for structure in d.ROIContourSequence:
        for contour in structure.ContourSequence:
            contour.ContourGeometricType = kind
    d.save_as(path, write_like_original=False)
    return path


def draw(seed, folder):
    """The case of a seed, written below the folder."""
    r = random.Random(seed)
    w = Writer(r, folder)
    values, trusted, there, images = acquisitions(w)
    pixels = region(w, images, there)
    for k in sorted(pixels):
        for i, j in sorted(pixels[k]):
            if values[j][i] is None:
                continue
            w.case.unmasked.append(values[j][i])
            if k in there and trusted[j][i]:
                w.case.voxels.append(values[j][i])
    return w.case
