// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/sha256.h"
#include "roi/contour_io.h"
#include "session/marks_json.h"
#include "session/settings_json.h"

namespace glisson::session {

namespace {

using Json = nlohmann::json;
constexpr std::string_view opening = "glisson-journal ";
constexpr std::uint64_t compactAbove_bytes = 8u << 20;
constexpr auto synchroniseEvery = std::chrono::milliseconds(800);

bool same(const roi::Polygon& a, const roi::Polygon& b) {
  return a.state == b.state && a.exclude == b.exclude && a.sopInstanceUid == b.sopInstanceUid &&
         a.points_lps_mm.cols() == b.points_lps_mm.cols() && a.points_lps_mm == b.points_lps_mm;
}

Json settingsToJson(const Settings& settings) {
  Json patient;
  putChoices(settings.choices, patient);
  return {{"patient", patient}, {"parameters", toJson(settings.parameters)}, {"measure", toJson(settings.measure)}};
}

Settings settingsFromJson(const Json& j) {
  return {choicesFromJson(j.at("patient")), parametersFromJson(j.at("parameters")), measureFromJson(j.at("measure"))};
}

/// A record: what has changed since the one before. Polygons are written as a contour file, bits and all.
std::string recordOf(const Journalled& before, const Journalled& now, bool whole) {
  roi::ContourStack changed;
  std::vector<std::size_t> indices;
  for (std::size_t p = 0; p < now.outlines.polygons.size(); ++p) {
    const bool known = !whole && p < before.outlines.polygons.size();
    if (known && same(before.outlines.polygons[p], now.outlines.polygons[p])) continue;
    indices.push_back(p);
    changed.polygons.push_back(now.outlines.polygons[p]);
  }
  changed.name = now.outlines.name;
  changed.frameOfReferenceUid = now.outlines.frameOfReferenceUid;
  changed.seriesUid = now.outlines.seriesUid;
  roi::ContourStack drawing;
  if (now.inWork.points_lps_mm.cols() > 0) drawing.polygons.push_back(now.inWork);
  Json record = {{"source", now.source},
                 {"case", now.caseFile},
                 {"series", now.seriesUid},
                 {"modified", now.modified},
                 {"polygons", now.outlines.polygons.size()},
                 {"indices", indices},
                 {"contours", roi::toJson(changed)},
                 {"drawing", drawing.polygons.empty() ? std::string() : roi::toJson(drawing)},
                 {"marks", marksToJson(now.outlines.marks)},
                 {"made", madeToJson(now.outlines)}};
  if (now.settings && (whole || now.settings != before.settings)) record["settings"] = settingsToJson(*now.settings);
  return record.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void applyRecord(Journalled& state, const std::string& payload) {
  const Json record = Json::parse(payload);
  const auto changed = roi::contoursFromJson(record.at("contours").get<std::string>(), "the journal");
  const auto indices = record.at("indices").get<std::vector<std::size_t>>();
  const auto count = record.at("polygons").get<std::size_t>();
  if (indices.size() != changed.polygons.size() || count > (1u << 24)) throw BadInput("the journal contradicts itself");
  Journalled next = state;
  next.outlines.polygons.resize(count);
  for (std::size_t i = 0; i < indices.size(); ++i) next.outlines.polygons.at(indices[i]) = changed.polygons[i];
  next.outlines.name = changed.name;
  next.outlines.frameOfReferenceUid = changed.frameOfReferenceUid;
  next.outlines.seriesUid = changed.seriesUid;
  next.outlines.marks = marksFromJson(record.at("marks"));
  next.outlines.made = record.contains("made") ? madeFromJson(record["made"])
                                               : std::map<std::uint64_t, commands::MadeBy>();  // of an earlier version
  next.source = record.at("source").get<std::string>();
  next.caseFile = record.at("case").get<std::string>();
  next.seriesUid = record.at("series").get<std::string>();
  next.modified = record.at("modified").get<bool>();
  if (record.contains("settings")) next.settings = settingsFromJson(record["settings"]);
  next.inWork = {};
  const auto drawing = record.at("drawing").get<std::string>();
  if (!drawing.empty()) next.inWork = roi::contoursFromJson(drawing, "the journal").polygons.at(0);
  ++next.gestures;
  state = std::move(next);
}

}  // namespace

Journal::Journal(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  for (int n = 0; fd_ < 0; ++n) {
    file_ = folder / ("journal-" + std::to_string(::getpid()) + "-" + std::to_string(n));
    fd_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0600);
    if (fd_ < 0 && errno != EEXIST)
      throw BadInput(std::string("no journal can be kept: ") + std::strerror(errno) +
                     "; outlines are safe only once they are saved");
  }
  ::flock(fd_, LOCK_EX | LOCK_NB);  // held while this program lives, whatever ends it
  synchroniser_ = std::jthread([this](std::stop_token stop) {
    std::mutex mutex;
    std::condition_variable_any wake;
    std::unique_lock lock(mutex);
    while (!stop.stop_requested()) {
      wake.wait_for(lock, stop, synchroniseEvery, [] { return false; });
      if (dirty_.exchange(false)) ::fdatasync(fd_);
    }
  });
}

Journal::~Journal() {
  synchroniser_.request_stop();
  synchroniser_.join();
  ::unlink(file_.c_str());
  ::close(fd_);
}

void Journal::append(const std::string& payload) {
  const std::string record = std::string(opening) + std::to_string(++sequence_) + ' ' + std::to_string(payload.size()) +
                             ' ' + sha256(payload.data(), payload.size()) + '\n' + payload + '\n';
  const auto end = static_cast<off_t>(bytes_);
  for (std::size_t done = 0; done < record.size();) {
    const ssize_t n = ::write(fd_, record.data() + done, record.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      const int error = errno;
      if (::ftruncate(fd_, end) != 0) restart();
      throw BadInput(std::string("the journal cannot be written: ") + std::strerror(error) +
                     "; the outlines are kept in memory, save the case elsewhere");
    }
    done += static_cast<std::size_t>(n);
  }
  bytes_ += record.size();
  dirty_ = true;
}

void Journal::restart() {
  if (::ftruncate(fd_, 0) == 0) bytes_ = 0;
  whole_ = true;
}

void Journal::begin(const std::string& source, const std::string& caseFile, const std::string& seriesUid) {
  // What came before goes out of force with the next record, not before: at no moment is there nothing on disk.
  whole_ = true;
  state_ = {};
  state_.source = source;
  state_.caseFile = caseFile;
  state_.seriesUid = seriesUid;
}

void Journal::write(const commands::Outlines& outlines, const roi::Polygon& inWork, const Settings& settings,
                    bool modified) {
  Journalled now;
  now.source = state_.source;
  now.caseFile = state_.caseFile;
  now.seriesUid = state_.seriesUid;
  now.outlines = outlines;
  now.inWork = inWork;
  now.settings = settings;
  now.modified = modified || inWork.points_lps_mm.cols() > 0;
  if (bytes_ > compactAbove_bytes) {
    // Everything anew beside, then in its place: at no moment is there less on disk than was promised.
    const std::string payload = recordOf({}, now, true);
    const std::string head = std::string(opening) + std::to_string(++sequence_) + ' ' + std::to_string(payload.size());
    writeAtomically(file_, head + ' ' + sha256(payload.data(), payload.size()) + '\n' + payload + '\n');
    const int fresh = ::open(file_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (fresh < 0) throw BadInput("the journal cannot be opened again; save the case");
    ::flock(fresh, LOCK_EX | LOCK_NB);
    ::dup2(fresh, fd_);
    ::close(fresh);
    bytes_ = std::filesystem::file_size(file_);
    state_ = std::move(now);
    whole_ = false;
    return;
  }
  const std::string record = recordOf(state_, now, whole_);
  append(record);
  state_ = std::move(now);
  whole_ = false;
}

std::optional<Journalled> Journal::read(const std::filesystem::path& file) {
  std::string text;
  try {
    text = readWhole(file);
  } catch (const BadInput&) {
    return std::nullopt;  // gone meanwhile: there is nothing to recover
  }
  Journalled state;
  std::size_t at = 0;
  while (text.compare(at, opening.size(), opening) == 0) {
    const std::size_t line = text.find('\n', at);
    if (line == std::string::npos) break;
    unsigned long long sequence = 0, size = 0;
    char digest[65] = {};
    const std::string head = text.substr(at + opening.size(), line - at - opening.size());
    if (std::sscanf(head.c_str(), "%llu %llu %64s", &sequence, &size, digest) != 3) break;
    if (size > text.size() || line + 1 + size > text.size()) break;
    const std::string payload = text.substr(line + 1, size);
    if (sha256(payload.data(), payload.size()) != digest) break;
    try {
      applyRecord(state, payload);
    } catch (const std::exception&) {
      break;  // a record of another version: what came before still holds
    }
    at = std::min<std::size_t>(line + 2 + size, text.size());
  }
  if (state.gestures == 0) return std::nullopt;
  state.file = file;
  return state;
}

std::vector<Journalled> Journal::abandoned(const std::filesystem::path& folder) {
  std::vector<std::pair<std::filesystem::file_time_type, Journalled>> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().filename().string().rfind("journal-", 0) != 0) continue;
    const int fd = ::open(entry.path().c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0) continue;
    const bool free = ::flock(fd, LOCK_EX | LOCK_NB) == 0;  // else its program is alive
    ::close(fd);
    if (!free) continue;
    auto journalled = read(entry.path());
    if (journalled && journalled->modified) {
      found.emplace_back(entry.last_write_time(error), std::move(*journalled));
    } else {
      std::filesystem::remove(entry.path(), error);  // nothing in it that no case holds
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Journalled> result;
  for (auto& f : found) result.push_back(std::move(f.second));
  return result;
}

}  // namespace glisson::session
