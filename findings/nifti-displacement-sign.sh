#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# One number in a NIfTI header, the intent, decides whether ITK turns a displacement round: 1006 yes, 1007 no.
#
# Expected: NIfTI is RAS, ITK is LPS. A reader either turns the components of a vector with the axes or leaves them alone; the intent
#   code says what the vectors are, and "displacement vector" (1006) and "vector" (1007) both are vectors.
# Seen (@itk-wasm/image-io 1.6.1, that is ITK 5.4 or later; node 20), the field (1, 2, 3) everywhere, axes along RAS, which ITK gives
#   with the direction -1, -1, 1:
#     intent 1006 (NIFTI_INTENT_DISPVECT)   -1 -2 3
#     intent 1007 (NIFTI_INTENT_VECTOR)      1  2 3
#   The reasoning is that 1006 is defined in the space of NIfTI and that ITK itself always wrote its LPS fields as 1007. (ITK before
#   5.4, says the change that brought this, read 1006 as three times the same component.)
# Matters: the field of a simulation, written once by nibabel in RAS, deforms the liver rightly with 1006 and towards the other side,
#   front to back, with 1007 (the habit of ANTs and of most examples); a field of ITK that somebody re-labels 1006 turns as well. The
#   length of the vectors, and so every summary, is the same. Moving right by 10 mm becomes moving left by 10 mm.
# Do: write 1006 with RAS components or 1007 with LPS components, never the other pairs, and test with one vector that is not
#   symmetric.
#
# Needs node, npm and python3. Exit 0: as described; 1: changed; 2: could not be tried.
set -euo pipefail
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
cd "$tmp"
npm install --silent --no-audit --no-fund --ignore-scripts itk-wasm@1.0.0-b.201 @itk-wasm/image-io@1.6.1 >npm.log 2>&1 ||
  { cat npm.log; echo "packages could not be installed"; exit 2; }

python3 - <<'PY'
import struct

for intent in (1006, 1007):
    head = bytearray(348)
    struct.pack_into('<i', head, 0, 348)
    struct.pack_into('<8h', head, 40, 5, 2, 2, 2, 1, 3, 1, 1)              # the components are the fifth dimension
    struct.pack_into('<3h', head, 68, intent, 16, 32)                      # float32
    struct.pack_into('<8f', head, 76, 1, 1, 1, 1, 1, 1, 1, 1)              # qfac and steps of 1 mm
    struct.pack_into('<3f', head, 108, 352, 1, 0)                          # offset of the voxels, slope, intercept
    head[123] = 2                                                          # mm
    struct.pack_into('<2h', head, 252, 1, 1)                               # qform and sform: scanner
    struct.pack_into('<12f', head, 280, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0)
    head[344:348] = b'n+1\0'
    field = struct.pack('<24f', *(float(component) for component in (1, 2, 3) for _ in range(8)))
    open(f'{intent}.nii', 'wb').write(bytes(head) + b'\0' * 4 + field)
PY

cat >read.mjs <<'JS'
import { readImageNode } from '@itk-wasm/image-io'
for (const intent of [1006, 1007]) {
  const image = await readImageNode(`${process.cwd()}/${intent}.nii`)
  const type = image.imageType
  console.log(`${intent} ${type.pixelType} of ${type.components} direction ${[0, 4, 8].map((k) => image.direction[k]).join(' ')} ` +
    `first ${Array.from(image.data.slice(0, 3)).join(' ')} last ${Array.from(image.data.slice(-3)).join(' ')}`)
}
process.exit(0)
JS
node read.mjs >seen 2>read.log || { cat seen read.log; exit 2; }
cat seen
diff seen - <<'SEEN' || { echo "changed"; exit 1; }
1006 Vector of 3 direction -1 -1 1 first -1 -2 3 last -1 -2 3
1007 Vector of 3 direction -1 -1 1 first 1 2 3 last 1 2 3
SEEN
echo "as described"
