// SPDX-License-Identifier: GPL-3.0-or-later
#include "pacs/detail/channel.h"

#include <dcmtk/config/osconfig.h>
// Parts of DCMTK's network layer need its configuration first.
#include <dcmtk/dcmnet/assoc.h>
#include <dcmtk/dcmnet/cond.h>
#include <dcmtk/dcmnet/dul.h>

#include <algorithm>
#include <cstring>
#include <thread>

#include "pacs/node.h"

namespace glisson::pacs::detail {
namespace {

[[noreturn]] void silent(int timeout_s) {
  throw NetworkError("timeout: the other side was silent for " + std::to_string(timeout_s) + " s");
}

}  // namespace

Channel::Channel(T_ASC_Association& association, int timeout_s, int life_s, Progress progress)
    : association_(association),
      timeout_s_(timeout_s),
      end_(std::chrono::steady_clock::now() + std::chrono::seconds(life_s)),
      progress_(std::move(progress)) {}

void Channel::write(int context, bool command, const Source& source) {
  // One piece is read ahead, because the last one must be marked.
  const std::size_t room = association_.sendPDVLength & ~1UL;
  std::string now(room, '\0'), ahead(room, '\0');
  std::size_t count = source(now.data(), room);
  while (true) {
    const std::size_t following = count == 0 ? 0 : source(ahead.data(), room);
    progress_.check();
    DUL_PDV piece{};
    piece.fragmentLength = static_cast<unsigned long>(count);
    piece.presentationContextID = static_cast<DUL_PRESENTATIONCONTEXTID>(context);
    piece.pdvType = command ? DUL_COMMANDPDV : DUL_DATASETPDV;
    piece.lastPDV = following == 0;
    piece.data = now.data();
    DUL_PDVLIST list{};
    list.count = 1;
    list.pdv = &piece;
    const OFCondition sent = DUL_WritePDVs(&association_.DULassociation, &list);
    if (sent.bad()) throw NetworkError("the connection broke while sending");
    if (following == 0) return;
    std::swap(now, ahead);
    count = following;
  }
}

void Channel::sendData(int context, const Source& source) {
  write(context, false, source);
}

void Channel::sendData(int context, const std::string& bytes) {
  std::size_t at = 0;
  sendData(context, [&](char* to, std::size_t count) {
    const std::size_t n = std::min(count, bytes.size() - at);
    std::memcpy(to, bytes.data() + at, n);
    at += n;
    return n;
  });
}

void Channel::send(int context, const Command& command) {
  const std::string bytes = command.encoded();
  std::size_t at = 0;
  write(context, true, [&](char* to, std::size_t count) {
    const std::size_t n = std::min(count, bytes.size() - at);
    std::memcpy(to, bytes.data() + at, n);
    at += n;
    return n;
  });
}

void Channel::waitForBytes() {
  auto begin = std::chrono::steady_clock::now();
  auto pause = std::chrono::microseconds(200);
  while (ASC_dataWaiting(&association_, 0) == OFFalse) {
    progress_.check();
    const auto now = std::chrono::steady_clock::now();
    if (now - begin > std::chrono::seconds(timeout_s_)) {
      if (!patience_ || !patience_()) silent(timeout_s_);
      begin = now;
    }
    if (now > end_) throw NetworkError("timeout: the association lasted longer than is allowed");
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, std::chrono::microseconds(20000));
  }
}

std::optional<Channel::Piece> Channel::next() {
  DUL_PDV pdv{};
  if (DUL_NextPDV(&association_.DULassociation, &pdv).bad()) {
    waitForBytes();
    progress_.check();
    if (std::chrono::steady_clock::now() > end_)
      throw NetworkError("timeout: the association lasted longer than is allowed");
    const OFCondition read = DUL_ReadPDVs(&association_.DULassociation, nullptr, DUL_NOBLOCK, timeout_s_);
    if (read == DUL_PEERREQUESTEDRELEASE) return std::nullopt;
    if (read == DUL_PEERABORTEDASSOCIATION)
      throw NetworkError("the other side aborted the association; does it know our AE title, and allow us this?");
    if (read == DUL_READTIMEOUT) silent(timeout_s_);
    if (read != DUL_PDATAPDUARRIVED || DUL_NextPDV(&association_.DULassociation, &pdv).bad())
      throw NetworkError("the connection broke, or what came is no DICOM");
  }
  Piece piece;
  piece.context = pdv.presentationContextID;
  piece.command = pdv.pdvType == DUL_COMMANDPDV;
  piece.last = pdv.lastPDV != OFFalse;
  piece.bytes = static_cast<const char*>(pdv.data);
  piece.count = pdv.fragmentLength;
  return piece;
}

std::optional<Channel::Message> Channel::receive() {
  std::string bytes;
  Message message;
  while (true) {
    const std::optional<Piece> piece = next();
    if (!piece && bytes.empty()) return std::nullopt;
    if (!piece || !piece->command || (!bytes.empty() && piece->context != message.context) ||
        bytes.size() + piece->count > largestCommand)
      throw NetworkError("the other side sent something else than a DICOM command");
    message.context = piece->context;
    bytes.append(piece->bytes, piece->count);
    if (piece->last) break;
  }
  message.command = Command::decoded(bytes);
  return message;
}

Channel::Message Channel::receiveAnswer() {
  if (std::optional<Message> message = receive()) return *std::move(message);
  throw NetworkError("the other side ended the association without an answer");
}

void Channel::receiveData(int context, const Sink& sink) {
  while (true) {
    const std::optional<Piece> piece = next();
    if (!piece || piece->command || piece->context != context)
      throw NetworkError("the other side broke off in the middle of an object");
    if (piece->count > 0) sink(piece->bytes, piece->count);
    if (piece->last) return;
  }
}

std::string Channel::receiveData(int context, std::size_t limit) {
  std::string all;
  receiveData(context, [&](const char* from, std::size_t count) {
    if (all.size() + count > limit)
      throw NetworkError("the other side sent an answer of more than " + std::to_string(limit) + " bytes");
    all.append(from, count);
  });
  return all;
}

}  // namespace glisson::pacs::detail
