// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "dicom/file_layout.h"

namespace glisson::dicom {

/// The whole of the program glisson-reader: answers requests on a socket until the other end closes it. Before each
/// file it limits its own memory (RLIMIT_AS, counted from what the program takes at its start) and processor time
/// (ITIMER_PROF, and RLIMIT_CPU behind it); it writes no file (RLIMIT_FSIZE 0) and leaves no core (RLIMIT_CORE 0).
/// beforeParsing: called with the bytes of each file before a library sees them; tests misbehave there.
/// Returns the exit code.
int serveReader(int socket, const std::function<void(const ByteSource&)>& beforeParsing = {});

}  // namespace glisson::dicom
