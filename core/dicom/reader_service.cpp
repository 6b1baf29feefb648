// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/reader_service.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <new>

#include "base/error.h"
#include "dicom/detail/archive.h"
#include "dicom/detail/directory.h"
#include "dicom/detail/header_wire.h"
#include "dicom/detail/image_header.h"
#include "dicom/detail/packed_frames.h"
#include "dicom/detail/parsed_objects.h"
#include "dicom/detail/reader_protocol.h"
#include "dicom/detail/stored_frames.h"
#include "dicom/detail/wire.h"

namespace glisson::dicom {
namespace {

using detail::Answer;
using detail::Ask;
using detail::WireReader;
using detail::WireWriter;

std::uint64_t addressSpace_bytes() {
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0;
  unsigned long long pages = 0;
  const int got = std::fscanf(file, "%llu", &pages);
  std::fclose(file);
  return got == 1 ? pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) : 0;
}

void limit(decltype(RLIMIT_AS) what, std::uint64_t soft) {
  rlimit both{};
  getrlimit(what, &both);
  both.rlim_cur = std::min<rlim_t>(soft, both.rlim_max);
  setrlimit(what, &both);
}

void forbid(decltype(RLIMIT_AS) what) {
  const rlimit none{0, 0};
  setrlimit(what, &none);
}

/// From now on, and no longer than that: the signal's default action ends the process.
void allowTime(double seconds) {
  seconds = std::clamp(std::isfinite(seconds) ? seconds : 0.0, 0.01, 3600.0);
  const double whole = std::floor(seconds);
  const itimerval timer{{0, 0}, {static_cast<time_t>(whole), static_cast<suseconds_t>((seconds - whole) * 1e6)}};
  setitimer(ITIMER_PROF, &timer, nullptr);
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  limit(RLIMIT_CPU, static_cast<std::uint64_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                        static_cast<std::uint64_t>(whole) + 3);
}

void restTime() {
  const itimerval off{};
  setitimer(ITIMER_PROF, &off, nullptr);
}

class Service {
 public:
  Service(int socket, const std::function<void(const ByteSource&)>& beforeParsing)
      : socket_(socket), beforeParsing_(beforeParsing), baseline_bytes_(addressSpace_bytes()) {}

  int run() {
    detail::MessageHead head;
    while (detail::receiveAll(socket_, &head, sizeof(head))) {
      if (head.length > 64 * 1024) return 1;
      std::string payload(static_cast<std::size_t>(head.length), '\0');
      if (!detail::receiveAll(socket_, payload.data(), payload.size())) return 1;
      if (!answer(static_cast<Ask>(head.kind), payload)) return 1;
      restTime();
    }
    return 0;
  }

 private:
  bool answer(Ask ask, const std::string& payload) {
    RefusedFile refused;
    try {
      return obey(ask, payload);
    } catch (const RefusedFile& e) {
      refused = e;
    } catch (const std::bad_alloc&) {
      refused.reason = "asks for more memory than 256 MiB and three times its size";
      refused.outOfMemory = true;
    } catch (const std::exception& e) {
      refused.reason = e.what();
    }
    WireWriter w;
    w(refused.reason);
    w(refused.seriesUid);
    w(refused.outOfMemory);
    return say(Answer::Refused, w.bytes);
  }

  bool obey(Ask ask, const std::string& payload) {
    WireReader w(payload);
    double cpu_s = 0.0;
    if (ask == Ask::Frame) {
      int number = 0;
      w(number);
      w(cpu_s);
      allowTime(cpu_s);
      return frame(number);
    }
    std::string path;
    std::uint32_t memory_MiB = 0;
    w(path);
    w(memory_MiB);
    w(cpu_s);
    frame_ = {};
    frames_.reset();
    packed_.reset();
    source_.reset();
    header_ = {};
    frameCount_ = 0;
    limit(RLIMIT_AS, baseline_bytes_ + (static_cast<std::uint64_t>(memory_MiB) << 20));
    allowTime(cpu_s);
    source_ = std::make_unique<ByteSource>(path);
    if (beforeParsing_) beforeParsing_(*source_);
    switch (ask) {
      case Ask::Open:
        header_ = readImageHeader(path, *source_);
        frameCount_ = header_.frames.size();
        frame_ = [this](int number) {
          if (!frames_) frames_ = std::make_unique<StoredFrames>(header_, *source_);
          return frames_->read(number);
        };
        return say(Answer::Header, detail::toMessage(header_));
      case Ask::Structures: {
        const FileLayout layout = readLayout(*source_);
        return say(Answer::Structures, detail::toMessage(detail::parseStructures(*source_, layout)));
      }
      case Ask::Segmentation: return segmentation();
      case Ask::Directory: {
        WireWriter list;
        list(readDirectory(*source_));
        return say(Answer::List, list.bytes);
      }
      case Ask::Unpack: return unpack();
      default: return false;
    }
  }

  bool frame(int number) {
    if (!frame_ || number < 0 || static_cast<std::size_t>(number) >= frameCount_) throw BadInput("has no such frame");
    const std::vector<std::uint8_t> bytes = frame_(number);
    return detail::sendMessage(socket_, static_cast<std::uint32_t>(Answer::Pixels), bytes.data(), bytes.size());
  }

  bool segmentation() {
    layout_ = readLayout(*source_);
    const detail::SegHeader h = detail::parseSegHeader(*source_, layout_);
    packed_ = std::make_unique<PackedFrames>(*source_, layout_, h.frames.size(), h.frameBytes(), h.bits == 1 ? 1 : 8);
    frameCount_ = h.frames.size();
    frame_ = [this](int number) { return packed_->frame(static_cast<std::size_t>(number)); };
    return say(Answer::Segmentation, detail::toMessage(h));
  }

  bool unpack() {
    bool there = true;
    ArchiveEntries sink;
    sink.begin = [&](const std::string& name) {
      WireWriter w;
      w(name);
      there = there && say(Answer::Entry, w.bytes);
      return there;
    };
    sink.data = [&](const char* bytes, std::size_t count) {
      there = there && detail::sendMessage(socket_, static_cast<std::uint32_t>(Answer::Data), bytes, count);
      return there;
    };
    sink.refused = [&](const std::string& name, const std::string& reason) {
      WireWriter w;
      w(name);
      w(reason);
      there = there && say(Answer::EntryRefused, w.bytes);
    };
    readArchive(*source_, sink);
    return there && say(Answer::Done, {});
  }

  bool say(Answer kind, const std::string& bytes) {
    return detail::sendMessage(socket_, static_cast<std::uint32_t>(kind), bytes.data(), bytes.size());
  }

  int socket_;
  const std::function<void(const ByteSource&)>& beforeParsing_;
  std::uint64_t baseline_bytes_;
  std::unique_ptr<ByteSource> source_;
  ImageHeader header_;
  std::unique_ptr<StoredFrames> frames_;
  FileLayout layout_;
  std::unique_ptr<PackedFrames> packed_;
  std::size_t frameCount_ = 0;
  std::function<std::vector<std::uint8_t>(int)> frame_;  ///< of the opened file
};

}  // namespace

int serveReader(int socket, const std::function<void(const ByteSource&)>& beforeParsing) {
  forbid(RLIMIT_CORE);
  forbid(RLIMIT_FSIZE);
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  prctl(PR_SET_DUMPABLE, 0, 0, 0, 0);
  return Service(socket, beforeParsing).run();
}

}  // namespace glisson::dicom
