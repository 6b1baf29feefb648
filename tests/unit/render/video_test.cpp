// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/video.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "base/error.h"
#include "support/support.h"

namespace glisson::render {
namespace {

constexpr int width = 96, height = 64, perSecond = 25, pictures = 30;

/// One colour all over, brighter from picture to picture.
Picture plain(int n) {
  Picture p;
  p.width = width;
  p.height = height;
  for (int i = 0; i < width * height; ++i)
    for (const int c : {40 + 5 * n, 90, 200 - 4 * n}) p.rgb.push_back(static_cast<std::uint8_t>(c));
  return p;
}

/// Mean brightness, 16 to 235, of every picture of a file, as a player would decode it.
std::vector<double> decoded(const std::filesystem::path& file, double* perSecondThere) {
  AVFormatContext* format = nullptr;
  if (avformat_open_input(&format, file.c_str(), nullptr, nullptr) < 0) return {};
  avformat_find_stream_info(format, nullptr);
  AVStream* stream = format->streams[0];
  *perSecondThere = av_q2d(stream->avg_frame_rate);
  const AVCodec* codec = avcodec_find_decoder(stream->codecpar->codec_id);
  AVCodecContext* decoder = avcodec_alloc_context3(codec);
  avcodec_parameters_to_context(decoder, stream->codecpar);
  avcodec_open2(decoder, codec, nullptr);
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  std::vector<double> means;
  const auto take = [&] {
    while (avcodec_receive_frame(decoder, frame) == 0) {
      double sum = 0.0;
      for (int y = 0; y < frame->height; ++y)
        for (int x = 0; x < frame->width; ++x) sum += frame->data[0][y * frame->linesize[0] + x];
      means.push_back(frame->width == width && frame->height == height ? sum / (width * height) : -1.0);
    }
  };
  while (av_read_frame(format, packet) >= 0) {
    avcodec_send_packet(decoder, packet);
    av_packet_unref(packet);
    take();
  }
  avcodec_send_packet(decoder, nullptr);
  take();
  av_frame_free(&frame);
  av_packet_free(&packet);
  avcodec_free_context(&decoder);
  avformat_close_input(&format);
  return means;
}

class Video : public testing::TestWithParam<const char*> {};

TEST_P(Video, HoldsEveryPictureInOrderAndInItsBrightness) {
  const test::TemporaryFolder folder;
  const auto file = folder / (std::string("retraction") + GetParam());
  VideoFile video(file, width, height, perSecond);
  for (int n = 0; n < pictures; ++n) video.add(plain(n));
  EXPECT_FALSE(std::filesystem::exists(file)) << "half a video would pass for a whole one";
  video.finish();
  double there = 0.0;
  const std::vector<double> means = decoded(file, &there);
  EXPECT_NEAR(there, perSecond, 0.1);
  ASSERT_EQ(means.size(), static_cast<std::size_t>(pictures));
  for (int n = 0; n < pictures; ++n) {
    const double wanted = 16.0 + 219.0 / 255.0 * (0.299 * (40 + 5 * n) + 0.587 * 90 + 0.114 * (200 - 4 * n));
    EXPECT_NEAR(means[static_cast<std::size_t>(n)], wanted, 2.0) << "picture " << n;
  }
}

TEST_P(Video, IsTheSameFileTwice) {
  const test::TemporaryFolder folder;
  std::string bytes[2];
  for (const int turn : {0, 1}) {
    const auto file = folder / (std::to_string(turn) + GetParam());
    VideoFile video(file, width, height, perSecond);
    for (int n = 0; n < 5; ++n) video.add(plain(n));
    video.finish();
    std::ifstream in(file, std::ios::binary);
    bytes[turn] = {std::istreambuf_iterator<char>(in), {}};
  }
  EXPECT_GT(bytes[0].size(), 200U);
  EXPECT_TRUE(bytes[0] == bytes[1]);
}

TEST_P(Video, ThatWasBrokenOffLeavesWhatWasThere) {
  const test::TemporaryFolder folder;
  const auto file = folder / (std::string("kept") + GetParam());
  std::ofstream(file) << "before";
  {
    VideoFile video(file, width, height, perSecond);
    video.add(plain(0));
    EXPECT_THROW(video.add(Picture{2, 2, std::vector<std::uint8_t>(12)}), BadArgument);
  }
  EXPECT_EQ(std::filesystem::file_size(file), 6U);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << "nothing half written stays";
}

INSTANTIATE_TEST_SUITE_P(Kinds, Video, testing::Values(".webm", ".mp4"));

TEST(VideoFile, RefusesOtherKindsAndSizes) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(isVideoFile("a.MP4"));
  EXPECT_FALSE(isVideoFile("a.gif"));
  EXPECT_THROW(VideoFile(folder / "a.gif", width, height, perSecond), BadInput);
  EXPECT_THROW(VideoFile(folder / "a.webm", width + 1, height, perSecond), BadArgument);
  EXPECT_THROW(VideoFile(folder / "a.webm", width, 8, perSecond), BadArgument);
  EXPECT_THROW(VideoFile(folder / "a.webm", width, height, 0), BadArgument);
  EXPECT_THROW(VideoFile(folder / "none" / "a.webm", width, height, perSecond), BadInput);
}

}  // namespace
}  // namespace glisson::render
