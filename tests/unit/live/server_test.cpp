// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/server.h"

#include <gtest/gtest.h>
#include <igtlClientSocket.h>
#include <igtlPointMessage.h>
#include <igtlStringMessage.h>
#include <igtlTransformMessage.h>

#include <chrono>
#include <cmath>
#include <future>
#include <thread>

#include "base/error.h"
#include "retraction/live_condensed.h"

namespace glisson::live {
namespace {

using Clock = std::chrono::steady_clock;

retraction::Model block(float E_kPa) {
  image::Grid g;
  g.size = {10, 8, 8};
  g.spacing_mm = {6.0, 6.0, 6.0};
  return retraction::makeModel(image::ScalarVolume(g, E_kPa), 0.45, defaults::liverDensity, false);
}

retraction::Setup hoist() {
  retraction::Setup s;
  retraction::SupportSpec springs;
  springs.kind = retraction::SupportSpec::Kind::Spring;
  springs.region = retraction::SurfaceRegion{"all"};
  springs.stiffness_kPa_per_mm = 0.1;
  s.supports.push_back(springs);
  retraction::Retractor bar;
  bar.length_mm = 30.0;
  bar.force_N = 2.0;
  s.loads.emplace_back(bar);
  return s;
}

struct Frame {
  std::vector<Eigen::Vector3d> mre, atlas;  ///< LPS
  Eigen::Vector3d tool = Eigen::Vector3d::Zero();
  std::string state;  ///< of the bar, where it is told
};

/// A client as 3D Slicer is one: RAS in and out.
class Client {
 public:
  explicit Client(int port) : socket_(igtl::ClientSocket::New()) {
    for (int attempt = 0; attempt < 50 && socket_->ConnectToServer("127.0.0.1", port) != 0; ++attempt)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_TRUE(socket_->GetConnected());
  }
  void take(const Eigen::Vector3d& lps, const char* name = "Retractor") {
    igtl::TransformMessage::Pointer m = igtl::TransformMessage::New();
    igtl::Matrix4x4 matrix;
    igtl::IdentityMatrix(matrix);
    matrix[0][3] = static_cast<float>(-lps.x());
    matrix[1][3] = static_cast<float>(-lps.y());
    matrix[2][3] = static_cast<float>(lps.z());
    m->SetDeviceName(name);
    m->SetMatrix(matrix);
    m->Pack();
    socket_->Send(m->GetPackPointer(), static_cast<int>(m->GetPackSize()));
  }
  void sendRubbish() {
    const std::string rubbish(400, '\xff');
    socket_->Send(rubbish.data(), static_cast<int>(rubbish.size()));
  }
  /// Everything up to the end of the next frame; empty where the server is gone.
  Frame next() {
    Frame f;
    for (;;) {
      igtl::MessageHeader::Pointer h = igtl::MessageHeader::New();
      h->InitPack();
      if (socket_->Receive(h->GetPackPointer(), h->GetPackSize()) != h->GetPackSize()) return {};
      h->Unpack();
      const std::string name = h->GetDeviceName();
      if (name == "LandmarksMRE" || name == "LandmarksAtlas") {
        igtl::PointMessage::Pointer m = igtl::PointMessage::New();
        read(*m, h);
        for (int i = 0; i < m->GetNumberOfPointElement(); ++i) {
          igtl::PointElement::Pointer p;
          m->GetPointElement(i, p);
          float x = 0, y = 0, z = 0;
          p->GetPosition(x, y, z);
          (name == "LandmarksMRE" ? f.mre : f.atlas).emplace_back(-x, -y, z);
        }
      } else if (name == "RetractorReached") {
        igtl::TransformMessage::Pointer m = igtl::TransformMessage::New();
        read(*m, h);
        igtl::Matrix4x4 matrix;
        m->GetMatrix(matrix);
        f.tool = Eigen::Vector3d(-matrix[0][3], -matrix[1][3], matrix[2][3]);
      } else if (name == "RetractorState") {
        igtl::StringMessage::Pointer m = igtl::StringMessage::New();
        read(*m, h);
        f.state = m->GetString();
      } else {
        std::vector<char> rest(static_cast<std::size_t>(h->GetBodySizeToRead()));
        socket_->Receive(rest.data(), static_cast<int>(rest.size()));
        return f;  // the force ends a frame
      }
    }
  }

 private:
  template <typename Message>
  void read(Message& m, igtl::MessageHeader::Pointer& header) {
    m.SetMessageHeader(header);
    m.AllocatePack();
    socket_->Receive(m.GetPackBodyPointer(), static_cast<int>(m.GetPackBodySize()));
    EXPECT_TRUE(m.Unpack(1) & igtl::MessageHeader::UNPACK_BODY);
  }
  igtl::ClientSocket::Pointer socket_;
};

class Live : public testing::Test {
 protected:
  Live()
      : points_{{20.0, 20.0, 20.0}, {33.0, 5.0, 11.0}, {40.0, 30.0, 40.0}},
        livers_{std::make_unique<retraction::CondensedRetraction>(block(9.0f), hoist(), points_, false),
                std::make_unique<retraction::CondensedRetraction>(block(6.0f), hoist(), points_, false)},
        mre_(static_cast<const retraction::CondensedRetraction&>(*livers_.mre)) {}

  /// Serves in a thread of its own until this object goes.
  int start(ServerOptions options = {}) {
    options.port = 0;
    std::promise<int> port;
    auto open = port.get_future();
    served_ = std::async(std::launch::async, [this, options, promise = std::move(port)]() mutable {
      return serve(
          livers_, points_, options, [&](int p) { promise.set_value(p); }, Progress({}, stop_.get_token()));
    });
    return open.get();
  }
  ServerStatistics finish() {
    stop_.request_stop();
    return served_.get();
  }

  std::vector<Eigen::Vector3d> points_;
  retraction::LiveLivers livers_;
  const retraction::CondensedRetraction& mre_;
  std::stop_source stop_;
  std::future<ServerStatistics> served_;
};

TEST_F(Live, SendsTheScenesOwnHoistFirst) {
  Client client(start());
  const Frame f = client.next();
  finish();
  ASSERT_EQ(f.mre.size(), 3u);
  ASSERT_EQ(f.atlas.size(), 3u);
  Eigen::Matrix3Xd u_mm;
  mre_.evaluate(mre_.sceneForce_N(), u_mm);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT((f.mre[i] - points_[i] - u_mm.col(static_cast<Eigen::Index>(i))).norm(), 1e-4);
  EXPECT_GT((f.atlas[0] - f.mre[0]).norm(), 1e-3);
}

TEST_F(Live, FollowsTheToolWithinAVideoFrame) {
  Client client(start());
  client.next();
  std::vector<double> waited_ms;
  for (int k = 1; k <= 40; ++k) {
    const Eigen::Vector3d at = mre_.toolPoint_mm() + Eigen::Vector3d(0.05 * k, -0.1 * k, 0.02 * k);
    const auto sent = Clock::now();
    client.take(at);
    Frame f;
    do f = client.next();
    while ((f.tool - at).norm() > 1e-3 && Clock::now() - sent < std::chrono::seconds(5));
    waited_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - sent).count());
    ASSERT_LT((f.tool - at).norm(), 1e-3) << "the tool did not arrive";
    Eigen::Matrix3Xd u_mm;
    mre_.evaluate(mre_.forceFor(at - mre_.toolPoint_mm()), u_mm);
    EXPECT_LT((f.mre[1] - points_[1] - u_mm.col(1)).norm(), 1e-3);
  }
  const ServerStatistics s = finish();
  EXPECT_EQ(s.poses, 40);
  EXPECT_GT(s.frames, 40);
  std::sort(waited_ms.begin(), waited_ms.end());
  RecordProperty("latency_median_ms", std::to_string(waited_ms[20]));
  std::printf("pose to landmarks over loopback: median %.2f ms, worst %.2f ms; one answer %.1f us\n", waited_ms[20],
              waited_ms.back(), s.evaluate_us);
}

TEST_F(Live, IgnoresWhatIsNoPoseOfTheTool) {
  Client client(start());
  const Frame rest = client.next();
  client.take(mre_.toolPoint_mm() + Eigen::Vector3d(0.0, 3.0, 0.0), "Needle");
  client.take(mre_.toolPoint_mm() + Eigen::Vector3d(0.0, 500.0, 0.0));
  client.take(Eigen::Vector3d::Constant(std::nan("")));
  for (int i = 0; i < 10; ++i) EXPECT_LT((client.next().tool - rest.tool).norm(), 1e-6);
  EXPECT_EQ(finish().poses, 0);
}

TEST_F(Live, LetsABrokenClientGoAndServesTheNext) {
  const int port = start();
  {
    Client broken(port);
    broken.next();
    broken.sendRubbish();
    while (!broken.next().mre.empty()) {
    }
  }
  Client client(port);
  EXPECT_EQ(client.next().mre.size(), 3u);
  finish();
}

TEST_F(Live, EndsAfterTheFramesAskedForAtTheRateAskedFor) {
  ServerOptions options;
  options.frames = 30;
  options.rate_hz = 200.0;
  options.landmarks = 2;
  Client client(start(options));
  const auto begin = Clock::now();
  EXPECT_EQ(client.next().mre.size(), 2u);
  const ServerStatistics s = served_.get();
  EXPECT_EQ(s.frames, 30);
  EXPECT_GT(std::chrono::duration<double>(Clock::now() - begin).count(), 0.1);
}

/// A liver of one point that does not bear a force beyond 1 N.
class Brittle : public retraction::LiveRetraction {
 public:
  explicit Brittle(double scene_N, retraction::LiveOutcome beyond = retraction::LiveOutcome::Slips) : outcome_(beyond) {
    points_ = 1;
    sceneForce_N_ = {0.0, -scene_N, 0.0};
    sceneTarget_.force_N = sceneForce_N_;
  }
  retraction::LiveAnswer follow(const retraction::LiveTarget& target) override {
    retraction::LiveAnswer at;
    at.tool_mm = target.tool_mm;
    if (!target.force_N) return at;
    at.force_N = *target.force_N;
    if (at.force_N.norm() > 1.0) {
      at.outcome = outcome_;
      at.force_N *= 0.7;
    }
    return at;
  }
  void displacements(Eigen::Matrix3Xd& u_mm) const override { u_mm = Eigen::Matrix3Xd::Zero(3, 1); }

 private:
  retraction::LiveOutcome outcome_;
};

TEST(LiveSlip, IsToldInEveryFrameUntilItIsOver) {
  const retraction::LiveLivers livers{std::make_unique<Brittle>(0.8), std::make_unique<Brittle>(2.0)};
  std::stop_source stop;
  std::promise<int> port;
  auto open = port.get_future();
  ServerOptions options;
  options.port = 0;
  auto served = std::async(std::launch::async, [&] {
    return serve(
        livers, {Eigen::Vector3d::Zero()}, options, [&](int p) { port.set_value(p); }, Progress({}, stop.get_token()));
  });
  Client client(open.get());
  for (int n = 0; n < 3; ++n) EXPECT_EQ(client.next().state, "slips: atlas");
  // Led by the hand no force is asked for: told once, then no more.
  client.take({0.0, -3.0, 0.0});
  std::string state;
  do state = client.next().state;
  while (state == "slips: atlas");
  EXPECT_EQ(state, "holds");
  for (int n = 0; n < 3; ++n) EXPECT_EQ(client.next().state, "");
  stop.request_stop();
  const ServerStatistics s = served.get();
  EXPECT_GE(s.slipping, 3);
  EXPECT_LT(s.slipping, s.frames);
  EXPECT_EQ(s.last.atlas.outcome, retraction::LiveOutcome::Borne);
}

TEST(LiveRehearsal, CountsItsFramesWithoutAClient) {
  using retraction::LiveOutcome;
  const retraction::LiveLivers livers{std::make_unique<Brittle>(2.0),
                                      std::make_unique<Brittle>(1.5, LiveOutcome::Cuts)};
  const ServerStatistics s = rehearse(livers, 25);
  EXPECT_EQ(s.frames, 25);
  EXPECT_EQ(s.slipping, 25);
  EXPECT_EQ(s.cutting, 25);
  EXPECT_EQ(s.last.mre.outcome, LiveOutcome::Slips);
  EXPECT_EQ(s.last.atlas.outcome, LiveOutcome::Cuts);
  EXPECT_GT(s.rate_hz, 0.0);
  EXPECT_THROW(rehearse(livers, 0), BadArgument);
}

TEST_F(Live, RefusesAPortThatIsTaken) {
  ServerOptions options;
  options.port = start();
  EXPECT_THROW(serve(livers_, points_, options), BadInput);
  finish();
}

}  // namespace
}  // namespace glisson::live
