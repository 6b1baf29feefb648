// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/video.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
}

#include <cerrno>
#include <new>
#include <string>

#include "base/error.h"
#include "base/part_file.h"
#include "base/text.h"

namespace glisson::render {

namespace {

constexpr int smallest_px = 16, largest_px = 8192, mostFrames = 60;

std::string reasonOf(int code) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(code, text, sizeof text);
  return text;
}

void check(int code, const char* what) {
  if (code < 0)
    throw BadInput(std::string("the video cannot be written (") + what + "): " + reasonOf(code) +
                   "; check the folder's rights and the free space");
}

struct Freed {
  void operator()(AVFormatContext* c) const {
    if (c->pb) avio_closep(&c->pb);
    avformat_free_context(c);
  }
  void operator()(AVCodecContext* c) const { avcodec_free_context(&c); }
  void operator()(AVFrame* f) const { av_frame_free(&f); }
  void operator()(AVPacket* p) const { av_packet_free(&p); }
};

/// BT.601, 16 to 235 of brightness and 16 to 240 of colour; 16 bits behind the point.
struct Yuv {
  int y, u, v;
};
Yuv yuvOf(int r, int g, int b) {
  return {(16829 * r + 33039 * g + 6416 * b + (16 << 16) + 32768) >> 16,
          (-9714 * r - 19070 * g + 28784 * b + (128 << 16) + 32768) >> 16,
          (28784 * r - 24103 * g - 4681 * b + (128 << 16) + 32768) >> 16};
}

}  // namespace

struct VideoFile::State {
  State(const std::filesystem::path& file, const std::string& ending) : part(file, ending) {}
  PartFile part;
  std::unique_ptr<AVFormatContext, Freed> format;
  std::unique_ptr<AVCodecContext, Freed> encoder;
  std::unique_ptr<AVFrame, Freed> frame;
  std::unique_ptr<AVPacket, Freed> packet;
  AVStream* stream = nullptr;
  std::int64_t next = 0;

  void encode(const AVFrame* picture) {
    check(avcodec_send_frame(encoder.get(), picture), "encoding");
    for (;;) {
      const int got = avcodec_receive_packet(encoder.get(), packet.get());
      if (got == AVERROR(EAGAIN) || got == AVERROR_EOF) return;
      check(got, "encoding");
      av_packet_rescale_ts(packet.get(), encoder->time_base, stream->time_base);
      packet->stream_index = stream->index;
      packet->duration = av_rescale_q(1, encoder->time_base, stream->time_base);
      check(av_interleaved_write_frame(format.get(), packet.get()), "writing");
    }
  }
};

bool isVideoFile(const std::filesystem::path& file) {
  const std::string ending = extensionOf(file);
  return ending == ".webm" || ending == ".mp4";
}

VideoFile::VideoFile(const std::filesystem::path& file, int width, int height, int framesPerSecond) {
  for (const int side : {width, height})
    if (side < smallest_px || side > largest_px || side % 2 != 0)
      throw BadArgument("a video is 16 to 8192 pixels wide and high, an even number of them");
  if (framesPerSecond < 1 || framesPerSecond > mostFrames) throw BadArgument("a video has 1 to 60 pictures a second");
  if (!isVideoFile(file)) throw BadInput("a video is written as .webm or .mp4; choose a name that ends so");
  const bool webm = extensionOf(file) == ".webm";
  const AVCodec* codec = avcodec_find_encoder_by_name(webm ? "libvpx" : "libx264");
  if (!codec)
    throw BadInput(std::string("the encoder for ") + (webm ? ".webm (libvpx)" : ".mp4 (libx264)") +
                   " is not part of the libavcodec that is installed; choose the other kind of file");
  state_ = std::make_unique<State>(file, webm ? ".webm" : ".mp4");
  State& s = *state_;
  AVFormatContext* format = nullptr;
  check(avformat_alloc_output_context2(&format, nullptr, webm ? "webm" : "mp4", s.part.path().c_str()), "format");
  s.format.reset(format);
  s.format->flags |= AVFMT_FLAG_BITEXACT;
  s.stream = avformat_new_stream(format, nullptr);
  s.encoder.reset(avcodec_alloc_context3(codec));
  s.frame.reset(av_frame_alloc());
  s.packet.reset(av_packet_alloc());
  if (!s.stream || !s.encoder || !s.frame || !s.packet) throw std::bad_alloc();
  AVCodecContext& e = *s.encoder;
  e.width = width;
  e.height = height;
  e.pix_fmt = AV_PIX_FMT_YUV420P;
  e.color_range = AVCOL_RANGE_MPEG;
  e.colorspace = AVCOL_SPC_SMPTE170M;
  e.time_base = {1, framesPerSecond};
  e.framerate = {framesPerSecond, 1};
  e.gop_size = 2 * framesPerSecond;
  e.flags |= AV_CODEC_FLAG_BITEXACT;
  e.thread_count = 1;  // the same file on every machine
  if ((format->oformat->flags & AVFMT_GLOBALHEADER) != 0) e.flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  if (webm) {
    e.bit_rate = 4LL * width * height;  // an upper bound: the quality below decides
    av_opt_set(e.priv_data, "crf", "10", 0);
    av_opt_set(e.priv_data, "deadline", "good", 0);
    av_opt_set(e.priv_data, "cpu-used", "3", 0);
  } else {
    av_opt_set(e.priv_data, "crf", "20", 0);
    av_opt_set(e.priv_data, "preset", "fast", 0);
  }
  check(avcodec_open2(&e, codec, nullptr), "encoder");
  check(avcodec_parameters_from_context(s.stream->codecpar, &e), "encoder");
  s.stream->time_base = e.time_base;
  s.stream->avg_frame_rate = e.framerate;
  s.frame->format = e.pix_fmt;
  s.frame->width = width;
  s.frame->height = height;
  check(av_frame_get_buffer(s.frame.get(), 0), "memory");
  check(avio_open(&format->pb, s.part.path().c_str(), AVIO_FLAG_WRITE), "file");
  check(avformat_write_header(format, nullptr), "header");
}

VideoFile::~VideoFile() = default;

void VideoFile::add(const Picture& picture) {
  State& s = *state_;
  AVFrame& f = *s.frame;
  if (picture.width != f.width || picture.height != f.height ||
      picture.rgb.size() != 3U * static_cast<std::size_t>(f.width) * static_cast<std::size_t>(f.height))
    throw BadArgument("a picture of a video has another size than the video");
  check(av_frame_make_writable(&f), "memory");
  for (int y = 0; y < f.height; y += 2)
    for (int x = 0; x < f.width; x += 2) {
      int u = 0, v = 0;
      for (const int row : {y, y + 1})
        for (const int column : {x, x + 1}) {
          const std::uint8_t* rgb =
              &picture.rgb[3U * (static_cast<std::size_t>(row) * static_cast<std::size_t>(f.width) +
                                 static_cast<std::size_t>(column))];
          const Yuv yuv = yuvOf(rgb[0], rgb[1], rgb[2]);
          f.data[0][row * f.linesize[0] + column] = static_cast<std::uint8_t>(yuv.y);
          u += yuv.u;
          v += yuv.v;
        }
      f.data[1][y / 2 * f.linesize[1] + x / 2] = static_cast<std::uint8_t>((u + 2) / 4);
      f.data[2][y / 2 * f.linesize[2] + x / 2] = static_cast<std::uint8_t>((v + 2) / 4);
    }
  f.pts = s.next++;
  s.encode(&f);
}

void VideoFile::finish() {
  State& s = *state_;
  if (s.next == 0) throw BadArgument("a video has at least one picture");
  s.encode(nullptr);
  check(av_write_trailer(s.format.get()), "end of the file");
  check(avio_closep(&s.format->pb), "end of the file");
  s.part.become();
}

}  // namespace glisson::render
