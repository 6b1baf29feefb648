#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# CalculiX prints the volume of an element (EVOL) as it was before the load, also with NLGEOM, step after step.
#
# Expected: "*EL PRINT" with EVOL prints the volume at the time that stands above it, next to stress and strain of that time. The
#   manual says "the volume" and no more.
# Seen (calculix-ccx 2.20-1 of Debian 12), a cube of 1 m3, C3D8, E 1000 Pa, nu 0, NLGEOM, pressed to half its height:
#     time    volume from the nodes of the same file   EVOL
#     0.5     0.75                                     1.000000E+00
#     1.0     0.50                                     1.000000E+00
#   The Green-Lagrange strain beside it, -0.375 at the end, is of that time. The same holds for hyperelastic materials.
# Matters: soft tissue is nearly incompressible, and the first check of a large deformation is whether its volume stays. EVOL says that
#   it does, to the last digit, for every material, mesh and Poisson ratio; means weighted with it are means over the shape at rest.
# Do: take the volume from the displaced nodes, or from det F at the integration points.
#
# Needs Debian 12 (apt-get, dpkg, python3). Exit 0: as described; 1: changed; 2: could not be tried.
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
deb calculix-ccx=2.20-1
lib=$(echo "$tmp"/root/usr/lib/*-linux-gnu)

cat >cube.inp <<'INP'
*NODE, NSET=ALL
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 0., 1., 1.
*ELEMENT, TYPE=C3D8, ELSET=CUBE
1, 1, 2, 3, 4, 5, 6, 7, 8
*NSET, NSET=BOTTOM
1, 2, 3, 4
*NSET, NSET=TOP
5, 6, 7, 8
*NSET, NSET=LEFT
1, 4, 5, 8
*NSET, NSET=FRONT
1, 2, 5, 6
*MATERIAL, NAME=SOFT
*ELASTIC
1000., 0.
*SOLID SECTION, ELSET=CUBE, MATERIAL=SOFT
*BOUNDARY
BOTTOM, 3, 3
LEFT, 1, 1
FRONT, 2, 2
*STEP, NLGEOM
*STATIC, DIRECT
0.5, 1.
*BOUNDARY
TOP, 3, 3, -0.5
*NODE PRINT, NSET=ALL
U
*EL PRINT, ELSET=CUBE
E, EVOL
*END STEP
INP
LD_LIBRARY_PATH=$lib:$lib/blas:$lib/lapack "$tmp/root/usr/bin/ccx" -i cube >ccx.log 2>&1 || { cat ccx.log; exit 2; }
[ -s cube.dat ] || { cat ccx.log; exit 2; }

python3 - <<'PY' | tee seen
import re

blocks = {}
for head, body in re.findall(r'^ (\w[^\n]* and time +\S+)\n\s*\n(.*?)(?=^ \w|\Z)', open('cube.dat').read(), re.S | re.M):
    blocks[head.split()[0], float(head.split()[-1])] = [[float(x) for x in line.split()] for line in body.splitlines() if line.strip()]
for time in (0.5, 1.0):
    ux, uy, uz = blocks['displacements', time][6][1:]  # node 7, opposite the fixed corner
    strain, evol = blocks['strains', time][0][4], blocks['volume', time][0][1]
    print(f'time {time:g} strain {strain:.4f} nodes {(1 + ux) * (1 + uy) * (1 + uz):.4f} EVOL {evol:.4f}')
PY
diff seen - <<'SEEN' || { echo "changed"; exit 1; }
time 0.5 strain -0.2188 nodes 0.7500 EVOL 1.0000
time 1 strain -0.3750 nodes 0.5000 EVOL 1.0000
SEEN
echo "as described"
