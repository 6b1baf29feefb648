// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "base/progress.h"
#include "pacs/detail/command.h"

struct T_ASC_Association;

namespace glisson::pacs::detail {

/// Messages over an association: commands are bounded, data sets flow through a sink, every wait ends by time or
/// cancel.
class Channel {
 public:
  /// timeout_s: longest silence. life_s: longest life of the association. Cancel of progress is seen within 50 ms while
  /// waiting.
  Channel(T_ASC_Association& association, int timeout_s, int life_s, Progress progress);

  struct Message {
    int context = 0;  ///< presentation context
    Command command;
  };
  /// Fills at most count bytes; returns how many, 0 at the end. Asked for even counts; must give even ones but at the
  /// end.
  using Source = std::function<std::size_t(char* to, std::size_t count)>;
  using Sink = std::function<void(const char* from, std::size_t count)>;

  void send(int context, const Command& command);
  void sendData(int context, const Source& source);
  void sendData(int context, const std::string& bytes);

  /// The next command; nothing where the other side asked to release. Throws NetworkError (silence, broken, aborted,
  /// senseless), Cancelled.
  std::optional<Message> receive();
  /// As receive(), where only an answer makes sense: a release is a NetworkError.
  Message receiveAnswer();
  /// The data set of a message whose command hasData(). Throws as receive(); what the sink throws goes through.
  void receiveData(int context, const Sink& sink);
  /// At most limit bytes in memory. Throws NetworkError beyond.
  std::string receiveData(int context, std::size_t limit);

  /// Where silence may be right because the work shows elsewhere (C-MOVE): asked when a silence has lasted too long,
  /// true grants another one.
  void setPatience(std::function<bool()> patience) { patience_ = std::move(patience); }

  std::uint16_t nextMessageId() { return ++lastId_; }
  const Progress& progress() const { return progress_; }

 private:
  struct Piece {
    int context = 0;
    bool command = false, last = false;
    const char* bytes = nullptr;
    std::size_t count = 0;
  };
  std::optional<Piece> next();
  void waitForBytes();
  void write(int context, bool command, const Source& source);

  T_ASC_Association& association_;
  int timeout_s_;
  std::chrono::steady_clock::time_point end_;
  Progress progress_;
  std::function<bool()> patience_;
  std::uint16_t lastId_ = 0;
};

}  // namespace glisson::pacs::detail
