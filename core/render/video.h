// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>

#include "render/picture.h"

namespace glisson::render {

/// Whether the file's ending is one that a video can be written for: .webm (VP8) or .mp4 (H.264).
bool isVideoFile(const std::filesystem::path& file);

/// A video file, written picture by picture. Colours are BT.601 at half resolution (YUV 4:2:0), as players expect.
class VideoFile {
 public:
  /// width, height: even, 16 to 8192 pixels; framesPerSecond: 1 to 60. Throws BadArgument otherwise, BadInput where the
  /// ending is neither .webm nor .mp4, the encoder is not installed, or the file cannot be made.
  VideoFile(const std::filesystem::path& file, int width, int height, int framesPerSecond);
  ~VideoFile();  ///< without finish() nothing of it stays, and a file that was there before does
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  /// The next picture. Throws BadArgument where it has another size, BadInput where it cannot be written.
  void add(const Picture& picture);
  /// Ends the file, which is there as a whole from then on. Throws BadInput where it cannot be written.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace glisson::render
