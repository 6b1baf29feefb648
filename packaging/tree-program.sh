#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later

# Starts the program of the same name from the tree that this file lies in: where the system has no drivers, plugins or fonts of
# its own, those of the tree are used.
here=$(dirname -- "$(readlink -f -- "$0")")
tree=$(dirname -- "$here")
export QT_PLUGIN_PATH="$tree/lib/qt6"
export DCMDICTPATH="$tree/share/glisson/dicom/dicom.dic:$tree/share/glisson/dicom/private.dic"
if [ ! -d /usr/share/glvnd/egl_vendor.d ]; then
  export __EGL_VENDOR_LIBRARY_FILENAMES="$tree/share/glisson/egl.json"
  export LIBGL_DRIVERS_PATH="$tree/lib/dri"
fi
[ -e /etc/fonts/fonts.conf ] || export FONTCONFIG_FILE="$tree/share/glisson/fonts.conf"
exec "$tree/libexec/glisson/$(basename -- "$0")" "$@"
