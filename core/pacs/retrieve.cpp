// SPDX-License-Identifier: GPL-3.0-or-later
#include "pacs/retrieve.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "pacs/detail/association.h"
#include "pacs/detail/identifier.h"
#include "pacs/detail/object_store.h"
#include "pacs/detail/syntaxes.h"
#include "pacs/detail/trouble.h"
#include "pacs/query.h"

namespace glisson::pacs {

using namespace detail;

namespace {

struct Target {
  bool series = false;
  std::string studyUid, seriesUid;
  int objects = -1;
};

/// Study or series?
Target locate(const Node& node, const RetrieveOptions& o, const Progress& progress) {
  checkUid(o.uid, "the UID to get");
  if (!o.studyUid.empty()) checkUid(o.studyUid, "--study");
  Query q;
  if (o.studyUid.empty() || o.studyUid == o.uid) {
    q.studyUid = o.uid;
    const Found study = find(node, q, progress);
    if (!study.studies.empty()) return {false, o.uid, {}, study.studies.front().objects};
  }
  q.studyUid = o.studyUid;
  q.seriesUid = o.uid;
  q.series = true;
  const Found found = find(node, q, progress);
  for (const FoundStudy& study : found.studies)
    for (const FoundSeries& s : study.series)
      if (s.uid == o.uid) return {true, study.uid, s.uid, s.objects};
  throw BadInput("the server at " + placeOf(node) +
                 " has no study and no series with this UID; `pacs find` lists what it has" +
                 (o.studyUid.empty() ? " (for a series, --study may help)" : ""));
}

Keys identifierOf(const Target& target) {
  Keys keys{{0x00080052, target.series ? "SERIES" : "STUDY"}, {0x0020000d, target.studyUid}};
  if (target.series) keys[0x0020000e] = target.seriesUid;
  return keys;
}

/// What a C-GET or C-MOVE response says.
struct Count {
  int left = 0, done = 0, failed = 0;
};

Count countOf(const Command& c) {
  return {c.wordOr(Remaining, 0), c.wordOr(Completed, 0) + c.wordOr(Warned, 0), c.wordOr(FailedCount, 0)};
}

void tell(const Progress& progress, const Count& n) {
  const int all = std::max(1, n.left + n.done + n.failed);
  progress.report(static_cast<double>(n.done + n.failed) / all, std::to_string(n.done) + " objects received");
}

/// The last response: throws where nothing was sent.
void finish(const Node& node, std::uint16_t status, const Count& count, bool moved, Retrieved& result) {
  result.failed = count.failed;
  if (status == 0xfe00) throw NetworkError("the server at " + placeOf(node) + " cancelled the retrieval");
  // Out of resources with some objects sent is told by the numbers.
  const bool some = count.done > 0 || result.received.files.size() + result.received.alreadyThere > 0;
  if (status != 0 && (status & 0xf000) != 0xb000 && !some)
    throw NetworkError("the server at " + placeOf(node) + " did not send: " + meaningOf(status, node.callingTitle) +
                       (moved && status != 0xa801 ? "; does it know the AE title '" + node.callingTitle +
                                                        "' with this computer's address and the port of --receive-port?"
                                                  : ""));
  if (status != 0 && result.failed == 0 && (status & 0xf000) != 0xb000) result.failed = 1;
}

Retrieved get(const Node& node, const RetrieveOptions& o, const Target& target, const Progress& progress) {
  std::vector<Proposal> proposals{{studyRootGet, plainSyntaxes()}};
  for (Proposal& p : proposalsToReceive()) proposals.push_back(std::move(p));
  ObjectStore store(o.folder, o.limits);
  Association association(node, proposals, progress, o.limits.association_s);
  const Agreed agreed = association.need(studyRootGet, "C-GET; ask for C-MOVE instead (--move)");
  Channel& channel = association.channel();
  Command request = Command::of(GetRequest, channel.nextMessageId(), studyRootGet);
  channel.send(agreed.context, request.word(Priority, 0).word(DataSetType, 1));
  channel.sendData(agreed.context, encodedKeys(identifierOf(target), agreed.transferSyntax));
  Retrieved result;
  Count count;
  while (true) {
    const Channel::Message m = channel.receiveAnswer();
    const std::uint16_t field = m.command.wordOr(Field, 0);
    if (field == StoreRequest) {
      const std::uint16_t status = store.receive(channel, m, association.agreed(m.context));
      channel.send(m.context, Command::answerTo(m.command, status));
      const auto have = static_cast<double>(store.count());
      if (target.objects > 0)
        progress.report(std::min(0.99, have / target.objects), std::to_string(store.count()) + " objects received");
      continue;
    }
    if (field != GetResponse)
      throw NetworkError("the server at " + placeOf(node) + " answered C-GET with another command");
    // The list of objects that failed: their number is all that is told.
    if (m.command.hasData()) channel.receiveData(m.context, std::size_t{16} << 20);
    count = countOf(m.command);
    const std::uint16_t status = m.command.wordOr(Status, 0x0110);
    if (isPending(status)) {
      tell(progress, count);
      continue;
    }
    result.received = store.result();
    finish(node, status, count, false, result);
    break;
  }
  association.release();
  return result;
}

Retrieved move(const Node& node, const RetrieveOptions& o, const Target& target, const Progress& progress) {
  ReceiveOptions in;
  in.port = o.receivePort;
  // The server comes to us: from this computer, or from its network.
  if (node.host.rfind("127.", 0) != 0 && node.host != "localhost") in.bind = "0.0.0.0";
  in.title = node.callingTitle;
  in.callers = {o.sender.empty() ? node.calledTitle : o.sender};
  in.folder = o.folder;
  in.timeout_s = node.timeout_s;
  in.limits = o.limits;
  Receiver receiver(in);
  std::stop_source stop;
  Retrieved result;
  Count count;
  std::uint16_t status = 0;
  {
    // Ends, also by an exception, with the receiver's thread.
    struct Stopper {
      std::stop_source& source;
      std::jthread thread;
      ~Stopper() { source.request_stop(); }
    } running{stop, std::jthread([&] { receiver.run(Progress({}, stop.get_token())); })};
    Association association(node, {{studyRootMove, plainSyntaxes()}}, progress, o.limits.association_s);
    const Agreed agreed = association.need(studyRootMove, "C-MOVE");
    Channel& channel = association.channel();
    // Servers may keep silent here while they send objects there.
    channel.setPatience([&receiver, seen = std::uint64_t{0}]() mutable {
      const Received r = receiver.result();
      return std::exchange(seen, r.bytes + r.alreadyThere) != r.bytes + r.alreadyThere;
    });
    Command request = Command::of(MoveRequest, channel.nextMessageId(), studyRootMove);
    request.title(Destination, node.callingTitle).word(Priority, 0).word(DataSetType, 1);
    channel.send(agreed.context, request);
    channel.sendData(agreed.context, encodedKeys(identifierOf(target), agreed.transferSyntax));
    while (true) {
      const Channel::Message m = channel.receiveAnswer();
      if (m.command.wordOr(Field, 0) != MoveResponse)
        throw NetworkError("the server at " + placeOf(node) + " answered C-MOVE with another command");
      if (m.command.hasData()) channel.receiveData(m.context, std::size_t{16} << 20);
      count = countOf(m.command);
      status = m.command.wordOr(Status, 0x0110);
      if (!isPending(status)) break;
      tell(progress, count);
    }
    association.release();
  }
  result.received = receiver.result();
  finish(node, status, count, true, result);
  if (result.received.files.empty() && result.received.alreadyThere == 0 && result.received.rejected > 0)
    throw NetworkError("the objects came from another AE title than '" + in.callers.front() +
                       "' and were rejected; name the sender with --sender");
  return result;
}

}  // namespace

Retrieved retrieve(const Node& node, const RetrieveOptions& options, const Progress& progress) {
  check(node);
  if (options.move && (options.receivePort < 1 || options.receivePort > 65535))
    throw BadInput("--move needs the port on which the server sends to us: give --receive-port");
  if (!options.sender.empty()) checkTitle(options.sender, "--sender");
  const Target target = locate(node, options, progress.part(0.0, 0.05));
  const Progress rest = progress.part(0.05, 1.0);
  Retrieved result = options.move ? move(node, options, target, rest) : get(node, options, target, rest);
  result.level = target.series ? "series" : "study";
  result.expected = target.objects;
  const std::size_t have = result.received.files.size() + result.received.alreadyThere;
  result.complete = result.failed == 0 && result.received.refused.empty() &&
                    (target.objects < 0 || have >= static_cast<std::size_t>(target.objects));
  progress.report(1.0, std::to_string(have) + " objects received");
  return result;
}

}  // namespace glisson::pacs
