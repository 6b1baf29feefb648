#include "live/server.h"

#include <arpa/inet.h>
#include <igtlMessageHeader.h>
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
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "base/error.h"

namespace glisson::live {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double furthestPose_mm = 100.0;
constexpr int largestBody = 1 << 20;

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

/// Whether a TRANSFORM's body is as long as its version asks for: 48 bytes; from version 2 on behind a header of its own
/// that says how long it and the metadata are.
bool soundTransform(int version, const unsigned char* body, int size) {
  constexpr int matrix = 48, extended = 12;
  if (version == 1) return size == matrix;
  if (size < extended + matrix) return false;
  const auto number = [body](int at, int bytes) {
    std::int64_t n = 0;
    for (int b = 0; b < bytes; ++b) n = 256 * n + body[at + b];
    return n;
  };
  return number(0, 2) == extended && number(2, 2) + number(4, 4) + extended + matrix == size;
}

/// The last pose that came in, handed from the receiving thread to the sending one.
class Poses {
 public:
  struct Pose {
    Eigen::Vector3d at_mm;
    Clock::time_point received;
  };
  void put(const Eigen::Vector3d& at_mm) {
    const std::lock_guard lock(mutex_);
    pose_ = Pose{at_mm, Clock::now()};
    ++count_;
    changed_.notify_one();
  }
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_one();
  }
  /// Waits until a pose comes, the client is gone, or the time is up.
  std::optional<Pose> takeUntil(Clock::time_point time) {
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, time, [&] { return pose_ || closed_; });
    return std::exchange(pose_, std::nullopt);
  }
  bool closed() {
    const std::lock_guard lock(mutex_);
    return closed_;
  }
  long count() {
    const std::lock_guard lock(mutex_);
    return count_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Pose> pose_;
  bool closed_ = false;
  long count_ = 0;
};

/// Between LPS and the messages' coordinates; its own inverse.
Eigen::Vector3d turned(const Eigen::Vector3d& p, bool ras) {
  return ras ? Eigen::Vector3d(-p.x(), -p.y(), p.z()) : p;
}

/// Reads all of it, however it arrives. False where the client is gone or `stop` is set.
bool readAll(igtl::Socket& socket, void* to, int bytes, const std::atomic<bool>& stop) {
  for (int done = 0; done < bytes && !stop;) {
    const int n = socket.Receive(static_cast<char*>(to) + done, bytes - done, 0);
    if (n == 0) return false;
    if (n > 0) done += n;
  }
  return !stop;
}

void receive(igtl::Socket& socket, const Eigen::Vector3d& rest_mm, bool ras, Poses& poses,
             const std::atomic<bool>& stop) {
  socket.SetReceiveTimeout(100);
  while (!stop) {
    igtl::MessageHeader::Pointer header = igtl::MessageHeader::New();
    header->InitPack();
    if (!readAll(socket, header->GetPackPointer(), header->GetPackSize(), stop)) break;
    // The first two bytes are the version of the header, most significant first, until it is unpacked.
    const auto* raw = static_cast<const unsigned char*>(header->GetPackPointer());
    const int version = 256 * raw[0] + raw[1];
    header->Unpack();
    // A client that does not speak the protocol, or lies about a size, is let go.
    const int size = header->GetBodySizeToRead();
    if (version < 1 || version > 3 || size < 0 || size > largestBody) break;
    const bool pose =
        std::string(header->GetDeviceType()) == "TRANSFORM" && std::string(header->GetDeviceName()) == "Retractor";
    if (!pose) {
      std::vector<char> skipped(static_cast<std::size_t>(size));
      if (size > 0 && !readAll(socket, skipped.data(), size, stop)) break;
      continue;
    }
    igtl::TransformMessage::Pointer message = igtl::TransformMessage::New();
    message->SetMessageHeader(header);
    message->AllocatePack();
    if (static_cast<int>(message->GetPackBodySize()) != size) break;
    if (!readAll(socket, message->GetPackBodyPointer(), size, stop)) break;
    if (!soundTransform(version, static_cast<const unsigned char*>(message->GetPackBodyPointer()), size)) break;
    if (!(message->Unpack(1) & igtl::MessageHeader::UNPACK_BODY)) continue;  // the checksum is wrong
    igtl::Matrix4x4 matrix;
    message->GetMatrix(matrix);
    const Eigen::Vector3d at_mm = turned(Eigen::Vector3f(matrix[0][3], matrix[1][3], matrix[2][3]).cast<double>(), ras);
    if (at_mm.allFinite() && (at_mm - rest_mm).norm() <= furthestPose_mm) poses.put(at_mm);
  }
  poses.close();
}

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

}  // namespace

ServerStatistics serve(const retraction::LiveLivers& livers, const std::vector<Eigen::Vector3d>& landmarks_mm,
                       const ServerOptions& options,
                       const std::function<void(int)>& listening, const Progress& progress) {
  if (landmarks_mm.size() != static_cast<std::size_t>(livers.mre->points()) ||
      (livers.atlas && livers.atlas->points() != livers.mre->points()))
    throw BadArgument("serve: the models do not watch the landmarks that were given");
  if (!(options.rate_hz > 0.0 && options.rate_hz <= 1000.0))
    throw BadInput("the rate must be above 0 and at most 1000 Hz");
  const Server::Pointer server = Server::New();
  if (!server->open(options.bind, options.port))
    throw BadInput("port " + std::to_string(options.port) + " of " + options.bind +
                   " cannot be opened; is another program using it (--port), or is it no address of this computer "
                   "(--bind)?");
  ServerStatistics s;
  double connected_ms = 0.0, latency_ms = 0.0;
  long answered = 0;
  const auto tick = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / options.rate_hz));
  // The first client meets the livers as the scene's own hoist leaves them.
  constexpr int most = 400;
  retraction::followScene(livers, most, progress);
  if (listening) listening(server->GetServerPort());
  const auto finished = [&] { return options.frames > 0 && s.frames >= options.frames; };
  try {
    while (!finished()) {
      progress.check();
      igtl::Socket::Pointer client = server->WaitForConnection(100).GetPointer();
      if (client.IsNull()) continue;
      progress.report(0.0, "a client is connected");
      client->SetSendTimeout(2000);
      Poses poses;
      std::atomic<bool> stop = false;
      std::thread receiver([&] { receive(*client, livers.mre->toolPoint_mm(), options.ras, poses, stop); });
      Session session(livers, landmarks_mm, options);
      const auto start = Clock::now();
      auto next = start;
      const auto leave = [&] {
        stop = true;
        receiver.join();
        client->CloseSocket();
        s.poses += poses.count();
        connected_ms += ms(Clock::now() - start);
      };
      try {
        while (!finished() && !poses.closed()) {
          progress.check();
          const auto pose = poses.takeUntil(next);
          if (pose) session.moveTo(pose->at_mm);
          session.follow(s);
          if (!session.sendFrame(*client)) break;
          ++s.frames;
          if (pose) {
            const double waited = ms(Clock::now() - pose->received);
            latency_ms += waited;
            s.latency_max_ms = std::max(s.latency_max_ms, waited);
            ++answered;
          }
          next = std::max(next + tick, Clock::now());
        }
      } catch (...) {
        leave();
        throw;
      }
      leave();
    }
  } catch (const Cancelled&) {
    // The usual end: what was measured until then is told.
  }
  server->CloseSocket();
  if (connected_ms > 0.0) s.rate_hz = 1e3 * static_cast<double>(s.frames) / connected_ms;
  if (s.frames > 0) s.evaluate_us /= static_cast<double>(s.frames);
  if (answered > 0) s.latency_ms = latency_ms / static_cast<double>(answered);
  return s;
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
