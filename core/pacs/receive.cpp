// SPDX-License-Identifier: GPL-3.0-or-later
#include "pacs/receive.h"

#include <dcmtk/config/osconfig.h>
// Parts of DCMTK's network layer need its configuration first.
#include <dcmtk/dcmnet/assoc.h>
#include <dcmtk/dcmnet/cond.h>
#include <dcmtk/dcmnet/dul.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <list>
#include <mutex>
#include <thread>

#include "pacs/detail/association.h"
#include "pacs/detail/door.h"
#include "pacs/detail/object_store.h"
#include "pacs/detail/syntaxes.h"

namespace glisson::pacs {

using namespace detail;

namespace {

using Clock = std::chrono::steady_clock;

/// Longest wait for the whole request of a caller that has connected; others are let in meanwhile.
constexpr int requestWait_s = 5;
/// After the last wanted object, so long may callers take to say goodbye.
constexpr auto farewell = std::chrono::seconds(2);

std::string titleOf(const char* raw) {
  std::string s(raw);
  const std::size_t first = s.find_first_not_of(' ');
  return first == std::string::npos ? std::string() : s.substr(first, s.find_last_not_of(' ') - first + 1);
}

void reject(T_ASC_Association* association, T_ASC_RejectParametersResult result, T_ASC_RejectParametersSource source,
            T_ASC_RejectParametersReason reason) {
  const T_ASC_RejectParameters why{result, source, reason};
  ASC_rejectAssociation(association, &why);
  ASC_dropAssociation(association);
  ASC_destroyAssociation(&association);
}

bool accept(T_ASC_Association* association) {
  std::vector<const char*> syntaxes, classes;
  for (const auto* list : {&plainSyntaxes(), &packedSyntaxes()})
    for (const std::string& s : *list) syntaxes.push_back(s.c_str());
  for (const auto* list : {&imageClasses(), &derivedClasses()})
    for (const std::string& s : *list) classes.push_back(s.c_str());
  const char* echoes[] = {verification};
  ASC_acceptContextsWithPreferredTransferSyntaxes(association->params, echoes, 1, syntaxes.data(), 2);
  ASC_acceptContextsWithPreferredTransferSyntaxes(association->params, classes.data(), static_cast<int>(classes.size()),
                                                  syntaxes.data(), static_cast<int>(syntaxes.size()));
  return ASC_acknowledgeAssociation(association).good();
}

/// One association to its end; nothing leaves this thread.
void serve(T_ASC_Association* association, ObjectStore& store, const ReceiveOptions& options,
           const std::stop_token& stop) {
  try {
    Channel channel(*association, options.timeout_s, options.limits.association_s, Progress({}, stop));
    while (const std::optional<Channel::Message> message = channel.receive()) {
      const std::uint16_t field = message->command.wordOr(Field, 0);
      std::uint16_t status = 0;
      if (field == StoreRequest)
        status = store.receive(channel, *message, agreedContext(*association, message->context));
      else if (field != EchoRequest)
        throw NetworkError("a command that is not offered");
      channel.send(message->context, Command::answerTo(message->command, status));
    }
    ASC_acknowledgeRelease(association);
    ASC_dropSCPAssociation(association, 1);
  } catch (const std::exception&) {
    // The caller sees the abort; what it had not finished is not in the result.
    ASC_abortAssociation(association);
    ASC_dropSCPAssociation(association, 0);
  }
  ASC_destroyAssociation(&association);
}

/// While it lives, DCMTK takes a socket of ours where it would open or accept one; there is one such socket in a
/// process.
class OwnSocket {
 public:
  explicit OwnSocket(int socket) : lock_(mutex()) { dcmExternalSocketHandle.set(socket); }
  ~OwnSocket() { dcmExternalSocketHandle.set(DCMNET_INVALID_SOCKET); }
  OwnSocket(const OwnSocket&) = delete;
  OwnSocket& operator=(const OwnSocket&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  std::lock_guard<std::mutex> lock_;
};

}  // namespace

struct Receiver::State {
  explicit State(const ReceiveOptions& o) : options(o), store(o.folder, limitsOf(o)), door(o.bind, o.port) {
    const OwnSocket listening(door.descriptor());
    if (ASC_initializeNetwork(NET_ACCEPTOR, o.port, o.timeout_s, &network).bad())
      throw NetworkError("the network cannot be used");
  }
  ~State() {
    if (network != nullptr) ASC_dropNetwork(&network);
  }

  static Limits limitsOf(const ReceiveOptions& o) {
    Limits l = o.limits;
    if (o.count) l.objects = std::min(l.objects, *o.count);
    return l;
  }

  struct Guest {
    std::atomic<bool> done{false};
    std::jthread thread;
  };

  void letIn(int socket);
  void reap() {
    guests.remove_if([](const std::unique_ptr<Guest>& g) { return g->done.load(); });
  }

  ReceiveOptions options;
  ObjectStore store;
  Door door;
  T_ASC_Network* network = nullptr;
  std::stop_source stop;
  std::list<std::unique_ptr<Guest>> guests;
};

void Receiver::State::letIn(int socket) {
  T_ASC_Association* association = nullptr;
  const OFCondition received = [&] {
    const OwnSocket caller(socket);
    return ASC_receiveAssociation(network, &association, 65536, nullptr, nullptr, OFFalse, DUL_NOBLOCK,
                                  std::min(requestWait_s, options.timeout_s));
  }();
  DIC_AE calling{}, called{};
  if (received.good())
    ASC_getAPTitles(association->params, calling, sizeof(calling), called, sizeof(called), nullptr, 0);
  // A caller that only connects, or speaks no DICOM, has no titles.
  if (titleOf(calling).empty() || titleOf(called).empty()) {
    if (association != nullptr) {
      ASC_dropAssociation(association);
      ASC_destroyAssociation(&association);
    }
    return;
  }
  const bool known = options.callers.empty() || std::find(options.callers.begin(), options.callers.end(),
                                                          titleOf(calling)) != options.callers.end();
  const bool ours = titleOf(called) == options.title;
  const bool room = guests.size() < options.limits.associations;
  store.addAssociation(ours && known && room);
  if (!ours)
    return reject(association, ASC_RESULT_REJECTEDPERMANENT, ASC_SOURCE_SERVICEUSER,
                  ASC_REASON_SU_CALLEDAETITLENOTRECOGNIZED);
  if (!known)
    return reject(association, ASC_RESULT_REJECTEDPERMANENT, ASC_SOURCE_SERVICEUSER,
                  ASC_REASON_SU_CALLINGAETITLENOTRECOGNIZED);
  if (!room)
    return reject(association, ASC_RESULT_REJECTEDTRANSIENT, ASC_SOURCE_SERVICEPROVIDER_PRESENTATION_RELATED,
                  ASC_REASON_SP_PRES_LOCALLIMITEXCEEDED);
  if (!accept(association)) {
    ASC_dropAssociation(association);
    ASC_destroyAssociation(&association);
    return;
  }
  guests.push_back(std::make_unique<Guest>());
  Guest& guest = *guests.back();
  guest.thread = std::jthread([this, association, &guest] {
    serve(association, store, options, stop.get_token());
    guest.done = true;
  });
}

Receiver::Receiver(const ReceiveOptions& options) {
  if (options.port < 1 || options.port > 65535)
    throw BadInput("the port to receive on is " + std::to_string(options.port) + "; it must be 1 to 65535");
  if (options.timeout_s < 1 || options.timeout_s > 3600) throw BadInput("the time-out must be 1 to 3600 s");
  if (options.count && *options.count < 1) throw BadInput("--count must be 1 or more");
  if (options.idle_s && *options.idle_s < 1) throw BadInput("the time to wait must be 1 s or more");
  checkTitle(options.title, "--called");
  for (const std::string& c : options.callers) checkTitle(c, "--calling");
  quietNetwork(options.timeout_s);
  state_ = std::make_unique<State>(options);
}

Receiver::~Receiver() = default;

Received Receiver::result() const {
  return state_->store.result();
}

void Receiver::run(const Progress& progress) {
  State& s = *state_;
  auto quietSince = Clock::now();
  std::optional<Clock::time_point> last;
  std::size_t told = 0;
  try {
    progress.report(0.0, "listening on port " + std::to_string(s.options.port));
    while (true) {
      s.reap();
      const std::size_t count = s.store.count();
      if (count != told) {
        told = count;
        const double part = s.options.count ? static_cast<double>(count) / static_cast<double>(*s.options.count) : 0.0;
        progress.report(std::min(part, 0.99), std::to_string(count) + " objects received");
      }
      progress.check();
      const auto now = Clock::now();
      if (!s.guests.empty()) quietSince = now;
      if (s.options.count && count >= *s.options.count && !last) last = now;
      if (last && (s.guests.empty() || now - *last > farewell)) break;
      if (s.options.idle_s && now - quietSince > std::chrono::seconds(*s.options.idle_s)) break;
      if (const int caller = s.door.next(std::chrono::seconds(std::min(requestWait_s, s.options.timeout_s)));
          caller >= 0)
        s.letIn(caller);
      else
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    progress.report(1.0, std::to_string(told) + " objects received");
  } catch (const Cancelled&) {
    // The result says what has arrived; nothing is lost by stopping.
  }
  s.stop.request_stop();
  s.guests.clear();  // waits for the threads, which end at the stop
}

}  // namespace glisson::pacs
