// SPDX-License-Identifier: GPL-3.0-or-later

// A reader process that misbehaves where a file tells it to: what a library taken over by a hostile file might do.
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <vector>

#include "dicom/detail/reader_protocol.h"
#include "dicom/reader_service.h"

namespace {

void misbehave(const glisson::dicom::ByteSource& source) {
  const auto bytes = source.bytes(0, source.size());
  const std::string text(bytes.begin(), bytes.end());
  const auto asks = [&text](const char* word) { return text.find(word) != std::string::npos; };
  if (asks("FAULT-CRASH")) {
    std::raise(SIGSEGV);
  } else if (asks("FAULT-ABORT")) {
    std::abort();
  } else if (asks("FAULT-LOOP")) {
    volatile bool forever = true;
    while (forever) {
    }
  } else if (asks("FAULT-MEMORY")) {
    std::vector<std::vector<char>> held;
    for (;;) held.emplace_back(16 * 1024 * 1024, 'x');
  } else if (asks("FAULT-EXIT")) {
    _exit(0);
  } else if (asks("FAULT-LIE")) {
    const std::string lie(200, '\xff');
    glisson::dicom::detail::sendMessage(glisson::dicom::detail::readerSocket,
                                        static_cast<std::uint32_t>(glisson::dicom::detail::Answer::Header), lie.data(),
                                        lie.size());
  } else if (asks("FAULT-HUGE")) {
    const glisson::dicom::detail::MessageHead head{2, 0, 1ULL << 60};
    if (write(glisson::dicom::detail::readerSocket, &head, sizeof(head)) < 0) _exit(1);
  } else if (asks("FAULT-FILE")) {
    // No limit lets it write a file: SIGXFSZ ends it.
    std::string name = "glisson-faulty-" + std::string(6, 'X');
    const int file = mkstemp(name.data());
    unlink(name.c_str());
    if (file >= 0 && write(file, "x", 1) == 1) _exit(0);
  }
}

}  // namespace

int main() {
  return glisson::dicom::serveReader(glisson::dicom::detail::readerSocket, misbehave);
}
