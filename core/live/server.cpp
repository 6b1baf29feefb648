// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/server.h"

#include <arpa/inet.h>
#include <igtlPointMessage.h>
#include <igtlServerSocket.h>
#include <igtlStringMessage.h>
#include <igtlTransformMessage.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <thread>

#include "base/error.h"
#include "live/detail/tool_poses.h"

namespace glisson::live {
namespace {

using detail::Clock;
using detail::Poses;
using detail::turned;

double ms(Clock::duration d) {
  return std::chrono::duration<double, std::milli>(d).count();
}

/// The library's server on an address of choice; by itself it listens on all of them.
class Server : public igtl::ServerSocket {
 public:
  using Self = Server;
  using Pointer = igtl::SmartPointer<Self>;
  static Pointer New() {
    Pointer made = new Self;
    made->UnRegister();
    return made;
  }
  bool open(const std::string& address, int port) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_port = htons(static_cast<std::uint16_t>(port));
    if (inet_pton(AF_INET, address.c_str(), &at.sin_addr) != 1) return false;
    const int descriptor = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (descriptor < 0) return false;
    const int yes = 1;
    setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (::bind(descriptor, reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0 || ::listen(descriptor, 5) != 0) {
      ::close(descriptor);
      return false;
    }
    m_SocketDescriptor = descriptor;
    return true;
  }

 protected:
  Server() = default;
};

bool send(igtl::Socket& socket, igtl::MessageBase& message, const char* name, igtl::TimeStamp::Pointer& time) {
  message.SetDeviceName(name);
  message.SetTimeStamp(time);
  message.Pack();
  return socket.Send(message.GetPackPointer(), static_cast<int>(message.GetPackSize())) != 0;
}

class Session {
 public:
  Session(const retraction::LiveLivers& livers, const std::vector<Eigen::Vector3d>& landmarks_mm,
          const ServerOptions& options)
      : livers_(livers), rest_mm_(landmarks_mm), options_(options) {
    const std::size_t n = landmarks_mm.size(), most = std::min(n, std::max<std::size_t>(1, options.landmarks));
    for (std::size_t i = 0; i < most; ++i) sent_.push_back(i * n / most);
    mre_ = livers.mre->sceneTarget();
    atlas_ = livers.atlas ? livers.atlas->sceneTarget() : mre_;
  }

  /// The tool is taken to a place: both livers follow it.
  void moveTo(const Eigen::Vector3d& at_mm) {
    mre_ = {at_mm - livers_.mre->toolPoint_mm(), {}};
    if (livers_.atlas) atlas_ = {at_mm - livers_.atlas->toolPoint_mm(), {}};
  }

  void follow(ServerStatistics& s) {
    const auto start = Clock::now();
    now_ = retraction::followBoth(livers_, mre_, atlas_);
    livers_.mre->displacements(u_mm_);
    if (livers_.atlas) livers_.atlas->displacements(atlas_u_mm_);
    s.evaluate_us += 1e3 * ms(Clock::now() - start);
    s.remaining_mm = std::max({s.remaining_mm, now_.mre.remaining_mm, now_.atlas.remaining_mm});
    if (isOut(LiveOutcome::Slips)) ++s.slipping;
    if (isOut(LiveOutcome::Cuts)) ++s.cutting;
    s.last = now_;
  }

  bool sendFrame(igtl::Socket& socket) {
    igtl::TimeStamp::Pointer time = igtl::TimeStamp::New();
    time->GetTime();
    if (!sent_.empty()) {
      if (!sendPoints(socket, "LandmarksMRE", "MRE", u_mm_, time)) return false;
      if (livers_.atlas && !sendPoints(socket, "LandmarksAtlas", "atlas", atlas_u_mm_, time)) return false;
    }
    igtl::TransformMessage::Pointer reached = igtl::TransformMessage::New();
    igtl::Matrix4x4 matrix;
    igtl::IdentityMatrix(matrix);
    const Eigen::Vector3d tool = turned(livers_.mre->toolPoint_mm() + now_.mre.tool_mm, options_.ras);
    for (int a = 0; a < 3; ++a) matrix[a][3] = static_cast<float>(tool[a]);
    reached->SetMatrix(matrix);
    if (!send(socket, *reached, "RetractorReached", time) || !sendState(socket, time)) return false;
    igtl::StringMessage::Pointer force = igtl::StringMessage::New();
    const Eigen::Vector3d f = turned(now_.mre.force_N, options_.ras);
    char text[96];
    std::snprintf(text, sizeof text, "%.6g %.6g %.6g", f.x(), f.y(), f.z());
    force->SetString(text);
    return send(socket, *force, "RetractorForce", time);
  }

 private:
  using LiveOutcome = retraction::LiveOutcome;

  bool isOut(LiveOutcome outcome) const { return now_.mre.outcome == outcome || now_.atlas.outcome == outcome; }
  /// "slips: MRE, atlas", or nothing where no liver has that outcome.
  std::string stateOf(LiveOutcome outcome, const char* word) const {
    std::string livers;
    if (now_.mre.outcome == outcome) livers = "MRE";
    if (now_.atlas.outcome == outcome) livers += livers.empty() ? "atlas" : ", atlas";
    return livers.empty() ? livers : std::string(word) + ": " + livers;
  }
  /// That a bar slips or cuts, in every frame in which it does, and once that it holds again.
  bool sendState(igtl::Socket& socket, igtl::TimeStamp::Pointer& time) {
    const std::string slips = stateOf(LiveOutcome::Slips, "slips"), cuts = stateOf(LiveOutcome::Cuts, "cuts");
    const std::string text = slips.empty() || cuts.empty() ? slips + cuts : slips + "; " + cuts;
    if (text.empty() && !outToldLast_) return true;
    outToldLast_ = !text.empty();
    igtl::StringMessage::Pointer state = igtl::StringMessage::New();
    state->SetString(text.empty() ? "holds" : text.c_str());
    return send(socket, *state, "RetractorState", time);
  }
  bool sendPoints(igtl::Socket& socket, const char* name, const char* group, const Eigen::Matrix3Xd& u_mm,
                  igtl::TimeStamp::Pointer& time) {
    igtl::PointMessage::Pointer message = igtl::PointMessage::New();
    char label[24];
    for (const std::size_t i : sent_) {
      const Eigen::Vector3d p = turned(rest_mm_[i] + u_mm.col(static_cast<Eigen::Index>(i)), options_.ras);
      igtl::PointElement::Pointer point = igtl::PointElement::New();
      std::snprintf(label, sizeof label, "V%05zu", i);
      point->SetName(label);
      point->SetGroupName(group);
      point->SetPosition(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
      message->AddPointElement(point);
    }
    return send(socket, *message, name, time);
  }

  const retraction::LiveLivers& livers_;
  const std::vector<Eigen::Vector3d>& rest_mm_;
  ServerOptions options_;
  std::vector<std::size_t> sent_;
  retraction::LiveTarget mre_, atlas_;
  retraction::LiveAnswers now_;
  bool outToldLast_ = false;  ///< that a bar slips or cuts
  Eigen::Matrix3Xd u_mm_, atlas_u_mm_;
};

/// What was measured while clients were served, summed up.
struct Served {
  ServerStatistics s;
  double connected_ms = 0.0, latency_ms = 0.0;
  long answered = 0;

  void noteAnswer(double waited_ms) {
    latency_ms += waited_ms;
    s.latency_max_ms = std::max(s.latency_max_ms, waited_ms);
    ++answered;
  }
  ServerStatistics means() const {
    ServerStatistics m = s;
    if (connected_ms > 0.0) m.rate_hz = 1e3 * static_cast<double>(m.frames) / connected_ms;
    if (m.frames > 0) m.evaluate_us /= static_cast<double>(m.frames);
    if (answered > 0) m.latency_ms = latency_ms / static_cast<double>(answered);
    return m;
  }
};

/// A thread that takes a client's poses; ends with this object, and with it the connection.
class Connection {
 public:
  Connection(igtl::Socket& client, const Eigen::Vector3d& rest_mm, bool ras, Served& served)
      : client_(client),
        served_(served),
        receiver_([this, &client, rest_mm, ras] { detail::receive(client, rest_mm, ras, poses, stop_); }) {}
  ~Connection() {
    stop_ = true;
    receiver_.join();
    client_.CloseSocket();
    served_.s.poses += poses.count();
    served_.connected_ms += ms(Clock::now() - start_);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  Poses poses;

 private:
  igtl::Socket& client_;
  Served& served_;
  std::atomic<bool> stop_ = false;
  Clock::time_point start_ = Clock::now();
  std::thread receiver_;
};

void check(const retraction::LiveLivers& livers, const std::vector<Eigen::Vector3d>& landmarks_mm,
           const ServerOptions& options) {
  if (landmarks_mm.size() != static_cast<std::size_t>(livers.mre->points()) ||
      (livers.atlas && livers.atlas->points() != livers.mre->points()))
    throw BadArgument("serve: the models do not watch the landmarks that were given");
  if (!(options.rate_hz > 0.0 && options.rate_hz <= 1000.0))
    throw BadInput("the rate must be above 0 and at most 1000 Hz");
}

Server::Pointer opened(const ServerOptions& options) {
  const Server::Pointer server = Server::New();
  if (!server->open(options.bind, options.port))
    throw BadInput("port " + std::to_string(options.port) + " of " + options.bind +
                   " cannot be opened; is another program using it (--port), or is it no address of this computer "
                   "(--bind)?");
  return server;
}

bool finished(const ServerOptions& options, const ServerStatistics& s) {
  return options.frames > 0 && s.frames >= options.frames;
}

/// One client until it leaves, or the frames are sent. Throws Cancelled.
void serveClient(igtl::Socket& client, const retraction::LiveLivers& livers,
                 const std::vector<Eigen::Vector3d>& landmarks_mm, const ServerOptions& options, Served& served,
                 const Progress& progress) {
  client.SetSendTimeout(2000);
  const auto tick = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / options.rate_hz));
  Connection connection(client, livers.mre->toolPoint_mm(), options.ras, served);
  Session session(livers, landmarks_mm, options);
  auto next = Clock::now();
  while (!finished(options, served.s) && !connection.poses.closed()) {
    progress.check();
    const auto pose = connection.poses.takeUntil(next);
    if (pose) session.moveTo(pose->at_mm);
    session.follow(served.s);
    if (!session.sendFrame(client)) break;
    ++served.s.frames;
    if (pose) served.noteAnswer(ms(Clock::now() - pose->received));
    next = std::max(next + tick, Clock::now());
  }
}

}  // namespace

ServerStatistics serve(const retraction::LiveLivers& livers, const std::vector<Eigen::Vector3d>& landmarks_mm,
                       const ServerOptions& options, const std::function<void(int)>& listening,
                       const Progress& progress) {
  check(livers, landmarks_mm, options);
  const Server::Pointer server = opened(options);
  // The first client meets the livers as the scene's own hoist leaves them.
  constexpr int most = 400;
  retraction::followScene(livers, most, progress);
  if (listening) listening(server->GetServerPort());
  Served served;
  try {
    while (!finished(options, served.s)) {
      progress.check();
      igtl::Socket::Pointer client = server->WaitForConnection(100).GetPointer();
      if (client.IsNull()) continue;
      progress.report(0.0, "a client is connected");
      serveClient(*client, livers, landmarks_mm, options, served, progress);
    }
  } catch (const Cancelled&) {
    // The usual end: what was measured until then is told.
  }
  server->CloseSocket();
  return served.means();
}

ServerStatistics rehearse(const retraction::LiveLivers& livers, long frames, const Progress& progress) {
  if (frames < 1) throw BadArgument("rehearse: a number of frames is needed");
  ServerStatistics s;
  const std::vector<Eigen::Vector3d> none;
  Session session(livers, none, {});
  const auto start = Clock::now();
  while (s.frames < frames) {
    progress.check();
    session.follow(s);
    ++s.frames;
  }
  s.rate_hz = 1e3 * static_cast<double>(s.frames) / ms(Clock::now() - start);
  s.evaluate_us /= static_cast<double>(s.frames);
  return s;
}

}  // namespace glisson::live
