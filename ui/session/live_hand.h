// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>

#include "session/live_pair.h"

namespace glisson::session {

/// Lets both livers follow the hand on a thread of its own, so that the window answers whatever a frame takes. Frames
/// go on until the hand's place is reached and both livers are at rest.
class LiveHand : public QObject {
  Q_OBJECT
 public:
  explicit LiveHand(std::unique_ptr<LivePair> pair, QObject* parent = nullptr);
  ~LiveHand() override;

  const LivePair& pair() const { return *pair_; }
  void ask(const retraction::LiveTarget& hand, LiveComparison comparison);
  /// The frame that was told of last; null before the first.
  const std::shared_ptr<const LiveFrame>& frame() const { return shown_; }
  /// What was asked for last is reached, and shown.
  bool atRest() const { return shown_ && shown_->atRest && shownFor_ == wanted_; }

 signals:
  void moved();  ///< there is a new frame; the latest one where the window was busy
  void failed(const QString& why);

 private:
  void work(const std::stop_token& stop);
  void deliver();

  std::unique_ptr<LivePair> pair_;
  std::shared_ptr<const LiveFrame> shown_;
  std::uint64_t wanted_ = 0, shownFor_ = 0;  ///< numbers of what was asked for
  std::mutex mutex_;                         // guards the seven below
  std::condition_variable_any asked_;
  retraction::LiveTarget hand_;
  LiveComparison comparison_ = LiveComparison::EqualForce;
  std::uint64_t number_ = 0, latestFor_ = 0;
  bool posted_ = false;
  std::shared_ptr<const LiveFrame> latest_;
  QString failure_;
  std::jthread thread_;
};

}  // namespace glisson::session
