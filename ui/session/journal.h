// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "commands/outlines.h"
#include "session/settings.h"

namespace glisson::session {

/// What a journal holds, or held up to the moment of a crash.
struct Journalled {
  std::string source;                ///< what was open: a folder, file or case
  std::string caseFile;              ///< the case it belongs to; empty where it was never saved
  std::string seriesUid;             ///< of the image drawn on
  commands::Outlines outlines;       ///< drafts included
  roi::Polygon inWork;               ///< the outline being drawn; no points where there was none
  std::uint64_t gestures = 0;        ///< records since it began
  std::optional<Settings> settings;  ///< roles, parameters, bar, hoist and holds; empty where it holds none
  bool modified = false;             ///< whether there is anything that no case file holds
  std::filesystem::path file;        ///< the journal itself
};

/// Everything the reader does, on disk at once: one record per gesture and per change of a parameter, appended. What is
/// written survives the program (at once) and the machine (synchronised by a thread of its own within a second). A
/// record holds what has changed, with its SHA-256; a torn or damaged tail costs the records from there on and nothing
/// before.
class Journal {
 public:
  /// Starts a journal of its own in the folder, locked while it lives. Throws BadInput where that cannot be written.
  explicit Journal(const std::filesystem::path& folder);
  ~Journal();  ///< removes the file: an orderly end leaves nothing to recover
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// What the records that follow belong to; the first of them takes the place of all that came before.
  void begin(const std::string& source, const std::string& caseFile, const std::string& seriesUid);
  /// The state after a gesture or another parameter. Throws BadInput (full disk): the state
  /// is kept and written with the next record.
  void write(const commands::Outlines& outlines, const roi::Polygon& inWork, const Settings& settings, bool modified);
  const std::filesystem::path& file() const { return file_; }
  std::uint64_t bytesWritten() const { return bytes_; }

  /// Journals that their program did not end in order, newest first. Those of running programs are not among them.
  static std::vector<Journalled> abandoned(const std::filesystem::path& folder);
  /// Reads one, up to the first damaged record. Empty where not even its start can be read.
  static std::optional<Journalled> read(const std::filesystem::path& file);

 private:
  void append(const std::string& payload);
  void restart();
  std::filesystem::path file_;
  int fd_ = -1;
  std::uint64_t bytes_ = 0, sequence_ = 0;
  Journalled state_;
  bool whole_ = true;  ///< the next record holds everything
  std::atomic<bool> dirty_{false};
  std::jthread synchroniser_;
};

}  // namespace glisson::session
