// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// What goes between a program and its reader process: messages of a kind, a length and that many bytes.
#include <cstddef>
#include <cstdint>
#include <string>

namespace glisson::dicom::detail {

/// Descriptor of the socket in the reader process.
inline constexpr int readerSocket = 3;

enum class Ask : std::uint32_t {
  Open = 1,      ///< payload: path, memory limit, CPU limit -> Header
  Frame,         ///< payload: number, CPU limit -> Pixels, of the opened file
  Directory,     ///< payload: path, limits -> List
  Structures,    ///< payload: path, limits -> Structures
  Segmentation,  ///< payload: path, limits -> Segmentation; its frames are asked for with Frame
  Unpack         ///< payload: path, limits -> Entry, Data ..., Entry, ..., Done
};

enum class Answer : std::uint32_t {
  Refused = 1,  ///< reason, series UID, whether memory was short
  Header,
  Pixels,
  List,
  Entry,         ///< name of the next entry of an archive; its bytes follow
  EntryRefused,  ///< name, reason
  Data,
  Structures,
  Segmentation,
  Done
};

struct MessageHead {
  std::uint32_t kind = 0;
  std::uint32_t unused = 0;
  std::uint64_t length = 0;
};

/// Largest piece of an archive's entry in one message.
inline constexpr std::size_t dataPiece = 256 * 1024;

/// False where the other end is gone.
bool sendMessage(int socket, std::uint32_t kind, const void* bytes, std::size_t count);
/// Reads exactly count bytes; false where the other end is gone.
bool receiveAll(int socket, void* to, std::size_t count);

}  // namespace glisson::dicom::detail
