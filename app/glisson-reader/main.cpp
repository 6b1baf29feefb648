// SPDX-License-Identifier: GPL-3.0-or-later

// The reader process: answers on the socket that its parent gave it (core/dicom/reader_service.h).
#include <sys/socket.h>

#include <clocale>
#include <iostream>

#include "dicom/detail/reader_protocol.h"
#include "dicom/reader_service.h"

int main() {
  std::setlocale(LC_ALL, "C");
  int type = 0;
  socklen_t size = sizeof(type);
  if (getsockopt(glisson::dicom::detail::readerSocket, SOL_SOCKET, SO_TYPE, &type, &size) != 0) {
    std::cerr << "glisson-reader is started by Glisson's other programs; it does nothing by itself\n";
    return 2;
  }
  return glisson::dicom::serveReader(glisson::dicom::detail::readerSocket);
}
