#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# A DICOM segmentation that leaves empty slices out: one file, two ITK readers, thirty times the volume between them.
#
# Expected: a SEG states its pixel spacing and slice spacing once for all frames, and the position of every frame. A reader that
#   does not know the object would refuse it, or at worst lose the empty slices; millimetres would stay millimetres.
# Seen (@itk-wasm/image-io 1.6.1 and @itk-wasm/dicom 7.6.4, both ITK 5; node 20), one liver label on the slices at 0, 10 and 40 mm:
#     readSegmentation (dcmqi)  size 10x8x5  spacing 2 1.5 10  volume 1080 mm3
#     readImage (GDCM)          size 10x8x3  spacing 1 1 1     volume   36 mm3
#   readImage gives no warning. Gaps between frames make GDCM doubt the regular grid, and it then drops the in-plane spacing too,
#   although that is written in the file. The same object with frames at 0, 10, 20 mm is read with 2 1.5 10 by both. A SEG of two
#   segments does the same, since its frames repeat positions.
# Matters: leaving empty frames out is what dcmqi and others do by default, so a label that touches every slice reads well and the
#   next patient's does not. Volume, overlap and distance in "mm" are then in voxels, and the label lies elsewhere.
# Do: read SEG only with a reader of SEG (dcmqi, highdicom), and distrust an image of spacing exactly 1 1 1.
#
# Needs node, npm and python3. Exit 0: as described; 1: changed; 2: could not be tried.
set -euo pipefail
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
cd "$tmp"
npm install --silent --no-audit --no-fund --ignore-scripts itk-wasm@1.0.0-b.201 @itk-wasm/image-io@1.6.1 @itk-wasm/dicom@7.6.4 \
  >npm.log 2>&1 || { cat npm.log; echo "packages could not be installed"; exit 2; }

python3 - <<'PY'
import struct

def el(group, element, vr, value):
    """One data element, explicit VR little endian; a sequence takes a list of items in bytes."""
    if vr == 'SQ':
        body = b''.join(b'\xfe\xff\x00\xe0' + struct.pack('<I', len(item)) + item for item in value)
    elif vr == 'US':
        body = struct.pack('<H', value)
    else:
        body = value if isinstance(value, bytes) else value.encode()
    body += (b'\0' if vr in ('UI', 'OB') else b' ') * (len(body) % 2)
    length = b'\0\0' + struct.pack('<I', len(body)) if vr in ('SQ', 'OB') else struct.pack('<H', len(body))
    return struct.pack('<HH', group, element) + vr.encode() + length + body

def code(value, scheme, meaning):
    return el(8, 0x100, 'SH', value) + el(8, 0x102, 'SH', scheme) + el(8, 0x104, 'LO', meaning)

SEG = '1.2.840.10008.5.1.4.1.1.66.4'

def write(name, z_mm, serial):
    rows, cols = 8, 10
    frame = bytes(int(2 <= r < 5 and 3 <= c < 7) for r in range(rows) for c in range(cols))  # 12 pixels
    bits = frame * len(z_mm)
    packed = bytes(sum(b << i for i, b in enumerate(bits[k:k + 8])) for k in range(0, len(bits), 8))
    measures = el(0x18, 0x50, 'DS', '10') + el(0x18, 0x88, 'DS', '10') + el(0x28, 0x30, 'DS', '1.5\\2')
    shared = el(0x20, 0x9116, 'SQ', [el(0x20, 0x37, 'DS', '1\\0\\0\\0\\1\\0')]) + el(0x28, 0x9110, 'SQ', [measures])
    frames = [el(0x20, 0x9111, 'SQ', [el(0x20, 0x9157, 'UL', struct.pack('<2I', 1, k + 1))]) +
              el(0x20, 0x9113, 'SQ', [el(0x20, 0x32, 'DS', f'-100\\-90\\{z}')]) +
              el(0x62, 0xA, 'SQ', [el(0x62, 0xB, 'US', 1)]) for k, z in enumerate(z_mm)]
    uid = f'2.25.{serial}'
    index = [el(0x20, 0x9164, 'UI', uid + '.4') + el(0x20, 0x9165, 'AT', struct.pack('<2H', *pointer)) +
             el(0x20, 0x9167, 'AT', struct.pack('<2H', *group))
             for pointer, group in (((0x62, 0xB), (0x62, 0xA)), ((0x20, 0x32), (0x20, 0x9113)))]
    segment = (el(0x62, 3, 'SQ', [code('85756007', 'SCT', 'Tissue')]) + el(0x62, 4, 'US', 1) + el(0x62, 5, 'LO', 'Liver') +
               el(0x62, 8, 'CS', 'MANUAL') + el(0x62, 0xF, 'SQ', [code('10200004', 'SCT', 'Liver')]))
    data = b''.join([
        el(8, 8, 'CS', 'DERIVED\\PRIMARY'), el(8, 0x16, 'UI', SEG), el(8, 0x18, 'UI', uid + '.1'), el(8, 0x20, 'DA', '20200101'),
        el(8, 0x23, 'DA', '20200101'), el(8, 0x30, 'TM', '120000'), el(8, 0x33, 'TM', '120000'), el(8, 0x50, 'SH', ''),
        el(8, 0x60, 'CS', 'SEG'), el(8, 0x70, 'LO', 'None'), el(8, 0x90, 'PN', ''), el(8, 0x1090, 'LO', 'None'),
        el(0x10, 0x10, 'PN', 'Phantom'), el(0x10, 0x20, 'LO', '0'), el(0x10, 0x30, 'DA', ''), el(0x10, 0x40, 'CS', ''),
        el(0x18, 0x1000, 'LO', '1'), el(0x18, 0x1020, 'LO', '1'), el(0x20, 0xD, 'UI', uid + '.2'), el(0x20, 0xE, 'UI', uid + '.3'),
        el(0x20, 0x10, 'SH', '1'), el(0x20, 0x11, 'IS', '1'), el(0x20, 0x13, 'IS', '1'), el(0x20, 0x52, 'UI', uid + '.5'),
        el(0x20, 0x1040, 'LO', ''), el(0x20, 0x9221, 'SQ', [el(0x20, 0x9164, 'UI', uid + '.4')]), el(0x20, 0x9222, 'SQ', index),
        el(0x28, 2, 'US', 1), el(0x28, 4, 'CS', 'MONOCHROME2'), el(0x28, 8, 'IS', str(len(z_mm))), el(0x28, 0x10, 'US', rows),
        el(0x28, 0x11, 'US', cols), el(0x28, 0x100, 'US', 1), el(0x28, 0x101, 'US', 1), el(0x28, 0x102, 'US', 0),
        el(0x28, 0x103, 'US', 0), el(0x28, 0x2110, 'CS', '00'), el(0x62, 1, 'CS', 'BINARY'), el(0x62, 2, 'SQ', [segment]),
        el(0x70, 0x80, 'CS', 'LIVER'), el(0x70, 0x81, 'LO', ''), el(0x70, 0x84, 'PN', ''), el(0x5200, 0x9229, 'SQ', [shared]),
        el(0x5200, 0x9230, 'SQ', frames), el(0x7FE0, 0x10, 'OB', packed)])
    meta = (el(2, 1, 'OB', b'\0\1') + el(2, 2, 'UI', SEG) + el(2, 3, 'UI', uid + '.1') + el(2, 0x10, 'UI', '1.2.840.10008.1.2.1') +
            el(2, 0x12, 'UI', '2.25.1'))
    open(name, 'wb').write(b'\0' * 128 + b'DICM' + el(2, 0, 'UL', struct.pack('<I', len(meta))) + meta + data)

write('every.dcm', (0, 10, 20), 1001)
write('gap.dcm', (0, 10, 40), 1002)
PY

cat >read.mjs <<'JS'
import { readImageNode } from '@itk-wasm/image-io'
import { readSegmentationNode } from '@itk-wasm/dicom'
const say = (image) => {
  const set = Array.from(image.data).filter((v) => v > 0).length
  const spacing = Array.from(image.spacing)
  return `${Array.from(image.size).join('x')} spacing ${spacing.join(' ')} volume ${set * spacing.reduce((a, b) => a * b)}`
}
for (const file of ['every.dcm', 'gap.dcm']) {
  const path = `${process.cwd()}/${file}`
  console.log(`SEEN ${file} readSegmentation ${say((await readSegmentationNode(path)).segImage)}`)
  console.log(`SEEN ${file} readImage ${say(await readImageNode(path))}`)
}
process.exit(0)
JS
node read.mjs >said 2>&1 || true
grep '^SEEN' said | tee seen || { cat said; exit 2; }
diff seen - <<'SEEN' || { echo "changed"; exit 1; }
SEEN every.dcm readSegmentation 10x8x3 spacing 2 1.5 10 volume 1080
SEEN every.dcm readImage 10x8x3 spacing 2 1.5 10 volume 1080
SEEN gap.dcm readSegmentation 10x8x5 spacing 2 1.5 10 volume 1080
SEEN gap.dcm readImage 10x8x3 spacing 1 1 1 volume 36
SEEN
echo "as described"
