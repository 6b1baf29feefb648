#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# DCMTK's dcmscale cuts a region out of an image and says that its pixels have grown.
#
# Expected: "dcmscale +C left top width height" cuts a rectangle out and, since nothing is scaled, leaves Pixel Spacing alone. One
#   would check that Image Position (Patient) follows the new corner, and would be glad not to have to check the spacing.
# Seen (dcmtk 3.6.7-9~deb12u4, Debian 12), a slice of 8 rows by 10 columns, Pixel Spacing 2\2, Image Position -10\-6\0:
#     before                8 x 10 pixels   Pixel Spacing 2\2                  Image Position -10\-6\0
#     dcmscale +C 5 4 5 4   4 x 5 pixels    Pixel Spacing 4.000000\4.000000    Image Position -10\-6\0
#     dcmscale +C 0 0 10 4  4 x 10 pixels   Pixel Spacing 4.000000\2.000000    Image Position -10\-6\0
#   The stored values are the ones of the region, unscaled (checked below). The spacing is that of the old field of view spread over
#   the new number of pixels, so a smaller region is a coarser image in the same place. No warning; the manual page is silent.
# Matters: cropping a series to the liver before it goes into a study is routine. Here an area comes out four times too large, a
#   wave length in the elastogram twice too long and its stiffness four times too high, and the outline of the liver, which is in
#   millimetres, no longer lies on it.
# Do: do not clip with dcmscale where geometry matters; crop with a tool that knows patient coordinates, or afterwards
#   set Pixel Spacing back and move Image Position (Patient) by hand.
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
deb dcmtk=3.6.7-9~deb12u4
DCMDICTPATH=$(find "$tmp/root" -name dicom.dic | head -n 1)
export DCMDICTPATH

# Pixel values 0 to 79, row after row, in hexadecimal words.
pixels=$(python3 -c 'print("\\".join(f"{k:04x}" for k in range(80)))')
cat >slice.dump <<DUMP
(0002,0010) UI [1.2.840.10008.1.2.1]
(0008,0008) CS [DERIVED\\SECONDARY\\OTHER]
(0008,0016) UI [1.2.840.10008.5.1.4.1.1.4]
(0008,0018) UI [2.25.3001.1]
(0008,0020) DA [20200101]
(0008,0030) TM [120000]
(0008,0050) SH
(0008,0060) CS [MR]
(0008,0070) LO [None]
(0008,0090) PN
(0010,0010) PN [Phantom^]
(0010,0020) LO [0]
(0010,0030) DA
(0010,0040) CS
(0018,0020) CS [RM]
(0018,0021) CS [NONE]
(0018,0022) CS
(0018,0023) CS [2D]
(0018,0050) DS [10]
(0018,0080) DS [50]
(0018,0081) DS [20]
(0018,0091) IS [1]
(0018,5100) CS [HFS]
(0020,000d) UI [2.25.3001.2]
(0020,000e) UI [2.25.3001.3]
(0020,0010) SH [1]
(0020,0011) IS [1]
(0020,0013) IS [1]
(0020,0032) DS [-10\\-6\\0]
(0020,0037) DS [1\\0\\0\\0\\1\\0]
(0020,0052) UI [2.25.3001.4]
(0020,1040) LO
(0028,0002) US 1
(0028,0004) CS [MONOCHROME2]
(0028,0010) US 8
(0028,0011) US 10
(0028,0030) DS [2\\2]
(0028,0100) US 16
(0028,0101) US 16
(0028,0102) US 15
(0028,0103) US 0
(7fe0,0010) OW $pixels
DUMP
dump2dcm -q slice.dump slice.dcm || exit 2
dcmscale -q +C 5 4 5 4 slice.dcm corner.dcm || exit 2
dcmscale -q +C 0 0 10 4 slice.dcm upper.dcm || exit 2

value() { dcmdump -q +L +P "$2" "$1.dcm" | sed -E 's/^\([^)]*\) .. \[?([^] ]*).*/\1/'; }
for name in slice corner upper; do
  echo "$name $(value $name 0028,0010) x $(value $name 0028,0011) spacing $(value $name 0028,0030) position $(value $name 0020,0032)"
done | tee seen
echo "corner values $(value corner 7fe0,0010)" | tee -a seen
diff seen - <<'SEEN' || { echo "changed"; exit 1; }
slice 8 x 10 spacing 2\2 position -10\-6\0
corner 4 x 5 spacing 4.000000\4.000000 position -10\-6\0
upper 4 x 10 spacing 4.000000\2.000000 position -10\-6\0
corner values 2d\2e\2f\30\31\37\38\39\3a\3b\41\42\43\44\45\4b\4c\4d\4e\4f
SEEN
echo "as described"
