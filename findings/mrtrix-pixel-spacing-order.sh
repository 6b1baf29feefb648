#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# MRtrix3 takes the first value of DICOM's Pixel Spacing for x. It is the distance between rows, which is y.
#
# Expected: mrinfo and mrconvert read an MR series as dcm2niix does. Pixel Spacing (0028,0030) is "between rows \ between columns"
#   (PS3.3, 10.7.1.3), so 1.5\2 on an axial slice means steps of 2 mm in x and 1.5 mm in y. Everybody has met this trap once; one
#   does not look for it in a converter as widely used as this.
# Seen (MRtrix3 3.0.3-3+b1, dcm2niix 1.0.20220720-1+deb12u1, Debian 12), 4 axial slices of 10 columns by 8 rows, Pixel Spacing 1.5\2:
#     dcm2niix  2 x 1.5 x 10 mm     a field of view of 20 x 12 mm
#     mrinfo    1.5 x 2 x 10 mm     a field of view of 15 x 16 mm
#   There is no warning, and the sizes (10 x 8 x 4) are right, so the volume of a region is right and its shape is wrong. The dcm2mnc
#   of the MINC tools (2.3.00) does the same, which has been reported there since 2012.
# Matters: nearly every scanner makes square pixels, so nothing shows. Elastograms that were resampled, rectangular reconstruction and
#   reformatted slices are not square: lengths change by the ratio of the spacings, strain and wave length by as much, and the
#   squared wave length makes stiffness wrong by (2/1.5)^2 = 1.8.
# Do: convert with dcm2niix, or compare mrinfo -spacing with the header whenever the two values differ.
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
  LD_LIBRARY_PATH=$(echo "$tmp"/root/usr/lib/*-linux-gnu):$(echo "$tmp"/root/lib/*-linux-gnu)
  export LD_LIBRARY_PATH PATH="$tmp/root/usr/bin:$PATH"
}
deb mrtrix3=3.0.3-3+b1 dcm2niix=1.0.20220720-1+deb12u1

python3 - <<'PY'
import os
import struct

def el(group, element, vr, value):
    """One data element, explicit VR little endian."""
    body = struct.pack('<H', value) if vr == 'US' else value if isinstance(value, bytes) else value.encode()
    body += (b'\0' if vr in ('UI', 'OB', 'OW') else b' ') * (len(body) % 2)
    length = b'\0\0' + struct.pack('<I', len(body)) if vr in ('OB', 'OW') else struct.pack('<H', len(body))
    return struct.pack('<HH', group, element) + vr.encode() + length + body

MR = '1.2.840.10008.5.1.4.1.1.4'
os.mkdir('series')
for k in range(4):
    uid = f'2.25.2001.1.{k + 1}'
    data = b''.join([
        el(8, 8, 'CS', 'DERIVED\\SECONDARY\\OTHER'), el(8, 0x16, 'UI', MR), el(8, 0x18, 'UI', uid), el(8, 0x20, 'DA', '20200101'),
        el(8, 0x30, 'TM', '120000'), el(8, 0x50, 'SH', ''), el(8, 0x60, 'CS', 'MR'), el(8, 0x70, 'LO', 'None'), el(8, 0x90, 'PN', ''),
        el(8, 0x103E, 'LO', 'stiffness'), el(0x10, 0x10, 'PN', 'Phantom^'), el(0x10, 0x20, 'LO', '0'), el(0x10, 0x30, 'DA', ''),
        el(0x10, 0x40, 'CS', ''), el(0x18, 0x20, 'CS', 'RM'), el(0x18, 0x21, 'CS', 'NONE'), el(0x18, 0x22, 'CS', ''),
        el(0x18, 0x23, 'CS', '2D'), el(0x18, 0x50, 'DS', '10'), el(0x18, 0x80, 'DS', '50'), el(0x18, 0x81, 'DS', '20'),
        el(0x18, 0x88, 'DS', '10'), el(0x18, 0x91, 'IS', '1'), el(0x18, 0x5100, 'CS', 'HFS'), el(0x20, 0xD, 'UI', '2.25.2001.2'),
        el(0x20, 0xE, 'UI', '2.25.2001.3'), el(0x20, 0x10, 'SH', '1'), el(0x20, 0x11, 'IS', '1'), el(0x20, 0x12, 'IS', '1'),
        el(0x20, 0x13, 'IS', str(k + 1)), el(0x20, 0x32, 'DS', f'-10\\-6\\{10 * k}'), el(0x20, 0x37, 'DS', '1\\0\\0\\0\\1\\0'),
        el(0x20, 0x52, 'UI', '2.25.2001.4'), el(0x20, 0x1040, 'LO', ''), el(0x28, 2, 'US', 1), el(0x28, 4, 'CS', 'MONOCHROME2'),
        el(0x28, 0x10, 'US', 8), el(0x28, 0x11, 'US', 10), el(0x28, 0x30, 'DS', '1.5\\2'), el(0x28, 0x100, 'US', 16),
        el(0x28, 0x101, 'US', 16), el(0x28, 0x102, 'US', 15), el(0x28, 0x103, 'US', 0),
        el(0x7FE0, 0x10, 'OW', struct.pack('<80H', *range(80)))])
    meta = (el(2, 1, 'OB', b'\0\1') + el(2, 2, 'UI', MR) + el(2, 3, 'UI', uid) + el(2, 0x10, 'UI', '1.2.840.10008.1.2.1') +
            el(2, 0x12, 'UI', '2.25.1'))
    with open(f'series/{k + 1}.dcm', 'wb') as out:
        out.write(b'\0' * 128 + b'DICM' + el(2, 0, 'UL', struct.pack('<I', len(meta))) + meta + data)
PY

dcm2niix -o . -f volume -z n series >dcm2niix.log 2>&1 || { cat dcm2niix.log; exit 2; }
mrinfo -quiet -spacing series >mrinfo.log 2>&1 || { cat mrinfo.log; exit 2; }
{
  python3 -c 'import struct; print("dcm2niix", *(f"{x:g}" for x in struct.unpack_from("<3f", open("volume.nii", "rb").read(), 80)))'
  echo "mrinfo $(tail -n 1 mrinfo.log | awk '{ print $1, $2, $3 }')"
} | tee seen
diff seen - <<'SEEN' || { echo "changed"; exit 1; }
dcm2niix 2 1.5 10
mrinfo 1.5 2 10
SEEN
echo "as described"
