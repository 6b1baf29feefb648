#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# NIfTI with two affines: the two xform codes, not the affines, decide which one ITK and nifti-reader-js (NiiVue) use.
#
# Expected: where sform and qform disagree, a reader has a fixed favourite. nibabel documents it: the sform if its code is not 0. ITK
#   is said to have preferred the qform once and the sform since 5.2. One would test a pipeline with one such file.
# Seen (@itk-wasm/image-io 1.6.1, that is ITK 5; nifti-reader-js 0.8.0; node 20), one image whose sform puts the first voxel at
#   x = 10 mm and whose qform puts it at x = 1 mm (RAS), with four pairs of codes:
#     sform_code qform_code    ITK   nifti-reader-js   (nibabel's rule)
#         1          1          10         10                10
#         2          1           1         10                10
#         1          2          10          1                10
#         2          2           1         10                10
#   ITK takes the sform if its code is 1 (scanner), else the qform; nifti-reader-js takes the qform if its code is the greater.
#   Neither warns.
# Matters: registration that moves an image by its header leaves the qform of the scanner (code 1) and writes the result into the
#   sform with code 2 (aligned), as the standard means it. ITK, and with it whatever reads by ITK, then shows the image where it was
#   before. With 1 and 2 it is the viewer in the browser that differs. A test with equal codes of 1 passes everywhere.
# Do: write both affines equal, code 1; look at both before a file from elsewhere is used.
#
# Needs node, npm and python3. Exit 0: as described; 1: changed; 2: could not be tried.
set -euo pipefail
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
cd "$tmp"

npm install --silent --no-audit --no-fund --ignore-scripts itk-wasm@1.0.0-b.201 @itk-wasm/image-io@1.6.1 nifti-reader-js@0.8.0 \
  >npm.log 2>&1 || { cat npm.log; echo "packages could not be installed"; exit 2; }

python3 - <<'PY'
import struct

for sform, qform in ((1, 1), (2, 1), (1, 2), (2, 2)):
    head = bytearray(348)
    struct.pack_into('<i', head, 0, 348)
    struct.pack_into('<8h', head, 40, 3, 4, 3, 2, 1, 1, 1, 1)
    struct.pack_into('<2h', head, 70, 16, 32)                              # float32
    struct.pack_into('<8f', head, 76, 1, 2, 3, 4, 1, 1, 1, 1)              # qfac, then steps of 2, 3 and 4 mm
    struct.pack_into('<3f', head, 108, 352, 1, 0)                          # offset of the voxels, slope, intercept
    head[123] = 2                                                          # mm
    struct.pack_into('<2h', head, 252, qform, sform)
    struct.pack_into('<6f', head, 256, 0, 0, 0, 1, 20, 30)                 # qform: no rotation, first voxel at (1, 20, 30)
    struct.pack_into('<12f', head, 280, 2, 0, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30)  # sform: the same at (10, 20, 30)
    head[344:348] = b'n+1\0'
    open(f's{sform}q{qform}.nii', 'wb').write(bytes(head) + b'\0' * 4 + struct.pack('<24f', *range(24)))
PY

cat >read.mjs <<'JS'
import fs from 'fs'
import { readImageNode } from '@itk-wasm/image-io'
import { readHeader } from 'nifti-reader-js'
for (const name of ['s1q1', 's2q1', 's1q2', 's2q2']) {
  const bytes = fs.readFileSync(`${name}.nii`)
  const header = readHeader(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length))
  const image = await readImageNode(`${process.cwd()}/${name}.nii`)
  console.log(`${name} ITK ${-image.origin[0]} nifti-reader-js ${header.affine[0][3]}`) // ITK says LPS
}
process.exit(0)
JS
node read.mjs >seen 2>read.log || { cat seen read.log; exit 2; }
cat seen
diff seen - <<'SEEN' || { echo "changed"; exit 1; }
s1q1 ITK 10 nifti-reader-js 10
s2q1 ITK 1 nifti-reader-js 10
s1q2 ITK 10 nifti-reader-js 1
s2q2 ITK 1 nifti-reader-js 10
SEEN
echo "as described"
