// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/reader_protocol.h"

#include <sys/socket.h>

#include <cerrno>

namespace glisson::dicom::detail {
namespace {

bool sendAll(int socket, const void* bytes, std::size_t count) {
  const auto* at = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t sent = send(socket, at, count, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    at += sent;
    count -= static_cast<std::size_t>(sent);
  }
  return true;
}

}  // namespace

bool sendMessage(int socket, std::uint32_t kind, const void* bytes, std::size_t count) {
  const MessageHead head{kind, 0, count};
  return sendAll(socket, &head, sizeof(head)) && sendAll(socket, bytes, count);
}

bool receiveAll(int socket, void* to, std::size_t count) {
  auto* at = static_cast<char*>(to);
  while (count > 0) {
    const ssize_t got = recv(socket, at, count, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    count -= static_cast<std::size_t>(got);
  }
  return true;
}

}  // namespace glisson::dicom::detail
