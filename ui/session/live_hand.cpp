// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/live_hand.h"

#include "session/worker.h"

namespace glisson::session {

LiveHand::LiveHand(std::unique_ptr<LivePair> pair, QObject* parent)
    : QObject(parent), pair_(std::move(pair)), thread_([this](const std::stop_token& stop) { work(stop); }) {}

LiveHand::~LiveHand() = default;

void LiveHand::ask(const retraction::LiveTarget& hand, LiveComparison comparison) {
  {
    const std::lock_guard lock(mutex_);
    hand_ = hand;
    comparison_ = comparison;
    number_ = ++wanted_;
  }
  asked_.notify_one();
}

void LiveHand::work(const std::stop_token& stop) {
  LiveFrame frame;
  std::uint64_t done = 0;
  while (!stop.stop_requested()) {
    retraction::LiveTarget hand;
    LiveComparison comparison{};
    {
      std::unique_lock lock(mutex_);
      if (!asked_.wait(lock, stop, [&] { return number_ != done || !frame.atRest; })) return;
      done = number_;
      hand = hand_;
      comparison = comparison_;
    }
    try {
      pair_->follow(hand, comparison, frame);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failure_ = reasonOf(std::current_exception());
      frame.atRest = true;
    }
    const std::lock_guard lock(mutex_);
    latest_ = std::make_shared<const LiveFrame>(frame);
    latestFor_ = done;
    if (!std::exchange(posted_, true)) QMetaObject::invokeMethod(this, &LiveHand::deliver, Qt::QueuedConnection);
  }
}

void LiveHand::deliver() {
  QString failure;
  {
    const std::lock_guard lock(mutex_);
    posted_ = false;
    shown_ = latest_;
    shownFor_ = latestFor_;
    failure = std::exchange(failure_, {});
  }
  if (!failure.isEmpty())
    emit failed(failure);
  else
    emit moved();
}

}  // namespace glisson::session
