#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# vtk.js reads the Direction of a .vti file by columns, VTK writes it by rows: an oblique image turns the other way.
#
# Expected: VTK's XML image format has one meaning; what VTK and ParaView write, vtk.js shows in the same place. Both belong to the
#   same family, and vtk.js has read and written the Direction attribute since 2022.
# Seen (python3-vtk9 9.1.0 of Debian 12, @kitware/vtk.js 37.3.1, node 20), an image turned by 30 degrees about z, written by VTK;
#   where the voxel (10, 0, 0) of 1 mm lies:
#     Direction in the file                  0.866 -0.5 0 0.5 0.866 0 0 0 1
#     VTK, read back                         8.66  5  0
#     vtk.js                                 8.66 -5  0
#   vtk.js keeps the matrix in the order of gl-matrix (by columns) and takes the nine numbers as they come, so it uses the transpose,
#   which is the inverse rotation. Its own writer makes the same exchange, so what vtk.js writes and reads back looks right. An axial
#   image, flipped or not, has a symmetric matrix and shows nothing.
# Matters: a viewer in the browser lays the oblique elastogram across the liver by twice the angle, 10 mm at 10 mm here, and a contour
#   drawn there is saved in the wrong place. vtkITKHelper, the other way into vtk.js, does transpose: the same scan lies right if it
#   came as NRRD and wrong if it came as .vti.
# Do: transpose the direction after reading and before writing .vti in vtk.js, or hand images over by ITK.
#
# Needs Debian 12 (apt-get, dpkg, python3), node and npm. Exit 0: as described; 1: changed; 2: could not be tried.
set -euo pipefail
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
cd "$tmp"

deb() {  # deb PACKAGE=VERSION...: they and what they need (but the C library) unpacked in $tmp/root, nothing installed
  mkdir -p apt/archives/partial root && : >none
  apt-get -qq -y -o Dir::State::status="$tmp/none" -o Dir::Cache="$tmp/apt" -o Debug::NoLocking=1 -o APT::Sandbox::User=root \
    --no-install-recommends --download-only install "$@" >apt.log 2>&1 || { cat apt.log; echo "packages could not be had"; exit 2; }
  rm -f apt/archives/libc6_* apt/archives/libc-bin_*
  for archive in apt/archives/*.deb; do dpkg -x "$archive" root; done
}
npm install --silent --no-audit --no-fund --ignore-scripts @kitware/vtk.js@37.3.1 @xmldom/xmldom@0.9.8 >npm.log 2>&1 ||
  { cat npm.log; echo "packages could not be installed"; exit 2; }
deb python3-vtk9=9.1.0+really9.1.0+dfsg2-5+deb12u1
lib=$(echo "$tmp"/root/usr/lib/*-linux-gnu)

cat >write.py <<'PY'
import math
import re
from vtkmodules.vtkCommonCore import VTK_UNSIGNED_CHAR
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLImageDataWriter

c, s = math.cos(math.pi / 6), math.sin(math.pi / 6)
image = vtkImageData()
image.SetDimensions(11, 2, 2)
image.SetDirectionMatrix(c, -s, 0, s, c, 0, 0, 0, 1)
image.AllocateScalars(VTK_UNSIGNED_CHAR, 1)
image.GetPointData().GetScalars().Fill(1)
writer = vtkXMLImageDataWriter()
writer.SetFileName('oblique.vti')
writer.SetInputData(image)
writer.SetDataModeToAscii()
writer.Write()
reader = vtkXMLImageDataReader()
reader.SetFileName('oblique.vti')
reader.Update()
where = [0.0] * 3
reader.GetOutput().TransformIndexToPhysicalPoint(10, 0, 0, where)
numbers = re.search(r'Direction="([^"]*)"', open('oblique.vti').read()).group(1).split()
print('file  ', *(f'{float(x):.3f}' for x in numbers))
print('VTK   ', *(f'{x:.2f}' for x in where))
PY
PYTHONPATH=$tmp/root/usr/lib/python3/dist-packages LD_LIBRARY_PATH=$lib:$lib/blas:$lib/lapack \
  /usr/bin/python3 write.py >seen 2>vtk.log || { cat seen vtk.log; exit 2; }

cat >read.mjs <<'JS'
import fs from 'fs'
import { DOMParser } from '@xmldom/xmldom'
globalThis.self = globalThis
globalThis.DOMParser = DOMParser
const { default: Reader } = await import('@kitware/vtk.js/IO/XML/XMLImageDataReader.js')
const reader = Reader.newInstance()
const bytes = fs.readFileSync('oblique.vti')
reader.parseAsArrayBuffer(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length))
console.log('vtk.js', ...reader.getOutputData(0).indexToWorld([10, 0, 0]).map((x) => x.toFixed(2)))
process.exit(0)
JS
node read.mjs >>seen 2>js.log || { cat seen js.log; exit 2; }
cat seen
diff seen - <<'SEEN' || { echo "changed"; exit 1; }
file   0.866 -0.500 0.000 0.500 0.866 0.000 0.000 0.000 1.000
VTK    8.66 5.00 0.00
vtk.js 8.66 -5.00 0.00
SEEN
echo "as described"
