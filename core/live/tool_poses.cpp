// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/detail/tool_poses.h"

#include <igtlMessageHeader.h>
#include <igtlTransformMessage.h>

#include <cstdint>
#include <string>
#include <vector>

namespace glisson::live::detail {
namespace {

constexpr double furthestPose_mm = 100.0;
constexpr int largestBody = 1 << 20;

/// Whether a TRANSFORM's body is as long as its version asks for: 48 bytes; from version 2 on behind a header of its
/// own that says how long it and the metadata are.
bool soundTransform(int version, const unsigned char* body, int size) {
  constexpr int matrix = 48, extended = 12;
  if (version == 1) return size == matrix;
  if (size < extended + matrix) return false;
  const auto number = [body](int at, int bytes) {
    std::int64_t n = 0;
    for (int b = 0; b < bytes; ++b) n = 256 * n + body[at + b];
    return n;
  };
  return number(0, 2) == extended && number(2, 2) + number(4, 4) + extended + matrix == size;
}

/// Reads all of it, however it arrives. False where the client is gone or `stop` is set.
bool readAll(igtl::Socket& socket, void* to, int bytes, const std::atomic<bool>& stop) {
  for (int done = 0; done < bytes && !stop;) {
    const int n = socket.Receive(static_cast<char*>(to) + done, bytes - done, 0);
    if (n == 0) return false;
    if (n > 0) done += n;
  }
  return !stop;
}

}  // namespace

void receive(igtl::Socket& socket, const Eigen::Vector3d& rest_mm, bool ras, Poses& poses,
             const std::atomic<bool>& stop) {
  socket.SetReceiveTimeout(100);
  while (!stop) {
    igtl::MessageHeader::Pointer header = igtl::MessageHeader::New();
    header->InitPack();
    if (!readAll(socket, header->GetPackPointer(), header->GetPackSize(), stop)) break;
    // The first two bytes are the version of the header, most significant first, until it is unpacked.
    const auto* raw = static_cast<const unsigned char*>(header->GetPackPointer());
    const int version = 256 * raw[0] + raw[1];
    header->Unpack();
    // A client that does not speak the protocol, or lies about a size, is let go.
    const int size = header->GetBodySizeToRead();
    if (version < 1 || version > 3 || size < 0 || size > largestBody) break;
    const bool pose =
        std::string(header->GetDeviceType()) == "TRANSFORM" && std::string(header->GetDeviceName()) == "Retractor";
    if (!pose) {
      std::vector<char> skipped(static_cast<std::size_t>(size));
      if (size > 0 && !readAll(socket, skipped.data(), size, stop)) break;
      continue;
    }
    igtl::TransformMessage::Pointer message = igtl::TransformMessage::New();
    message->SetMessageHeader(header);
    message->AllocatePack();
    if (static_cast<int>(message->GetPackBodySize()) != size) break;
    if (!readAll(socket, message->GetPackBodyPointer(), size, stop)) break;
    if (!soundTransform(version, static_cast<const unsigned char*>(message->GetPackBodyPointer()), size)) break;
    if (!(message->Unpack(1) & igtl::MessageHeader::UNPACK_BODY)) continue;  // the checksum is wrong
    igtl::Matrix4x4 matrix;
    message->GetMatrix(matrix);
    const Eigen::Vector3d at_mm = turned(Eigen::Vector3f(matrix[0][3], matrix[1][3], matrix[2][3]).cast<double>(), ras);
    if (at_mm.allFinite() && (at_mm - rest_mm).norm() <= furthestPose_mm) poses.put(at_mm);
  }
  poses.close();
}

}  // namespace glisson::live::detail
