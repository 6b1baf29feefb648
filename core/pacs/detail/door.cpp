// SPDX-License-Identifier: GPL-3.0-or-later
#include "pacs/detail/door.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>

#include "pacs/node.h"

namespace glisson::pacs::detail {
namespace {

using Clock = std::chrono::steady_clock;

/// Connections without a whole request; where more come, the oldest gives way.
constexpr std::size_t mostWaiting = 64;
constexpr std::uint32_t largestRequest = 64 * 1024;
/// The system's buffer holds a request until it is whole.
constexpr int receiveBuffer = 256 * 1024;

enum class Request { Incomplete, Whole, None };

/// What has arrived, which stays where it is.
Request requestAt(int socket) {
  // PS3.8 9.3.2: type 1, a reserved byte, the length of what follows (most significant byte first).
  unsigned char head[6];
  const ssize_t n = recv(socket, head, sizeof(head), MSG_PEEK | MSG_DONTWAIT);
  if (n < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR ? Request::Incomplete : Request::None;
  if (n == 0 || head[0] != 1) return Request::None;
  if (n < static_cast<ssize_t>(sizeof(head))) return Request::Incomplete;
  std::uint32_t length = 0;
  for (int b = 2; b < 6; ++b) length = length << 8 | head[b];
  if (length > largestRequest) return Request::None;
  int there = 0;
  if (ioctl(socket, FIONREAD, &there) != 0) return Request::None;
  return static_cast<std::uint32_t>(there) >= sizeof(head) + length ? Request::Whole : Request::Incomplete;
}

}  // namespace

Door::Door(const std::string& address, int port) {
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, address.c_str(), &at.sin_addr) != 1)
    throw NetworkError("the address to listen on (--bind) is no IPv4 address");
  listening_ = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int yes = 1;
  const bool listens = listening_ >= 0 && setsockopt(listening_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes)) == 0 &&
                       setsockopt(listening_, SOL_SOCKET, SO_RCVBUF, &receiveBuffer, sizeof(receiveBuffer)) == 0 &&
                       ::bind(listening_, reinterpret_cast<const sockaddr*>(&at), sizeof(at)) == 0 &&
                       ::listen(listening_, 50) == 0;
  if (listens) return;
  const bool foreign = errno == EADDRNOTAVAIL;
  if (listening_ >= 0) ::close(listening_);
  if (foreign) throw NetworkError("the address to listen on (--bind) is none of this computer's");
  throw NetworkError("nothing can listen on port " + std::to_string(port) +
                     ": it is taken, or below 1024 and not allowed; give another");
}

Door::~Door() {
  for (const Waiting& w : waiting_) ::close(w.socket);
  ::close(listening_);
}

void Door::letCallersIn() {
  while (true) {
    const int socket = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket < 0) return;
    if (waiting_.size() >= mostWaiting) {
      ::close(waiting_.front().socket);
      waiting_.pop_front();
    }
    waiting_.push_back({socket, Clock::now()});
  }
}

int Door::next(std::chrono::milliseconds wait) {
  letCallersIn();
  const auto now = Clock::now();
  for (auto w = waiting_.begin(); w != waiting_.end();) {
    const Request request = requestAt(w->socket);
    if (request == Request::Incomplete && now - w->since <= wait) {
      ++w;
      continue;
    }
    const int socket = w->socket;
    w = waiting_.erase(w);
    if (request == Request::Whole) return socket;
    ::close(socket);
  }
  return -1;
}

}  // namespace glisson::pacs::detail
