// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>

#include "base/error.h"
#include "base/frames.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/quantity.h"
#include "base/random.h"
#include "base/sha256.h"
#include "support/support.h"

namespace glisson {
namespace {

TEST(Quantity, YoungsIsThreeTimesShearWhenIncompressible) {
  EXPECT_DOUBLE_EQ(toYoungs(ShearModulus::fromKPa(2.1), 0.5).kPa(), 6.3);
  const auto mu = ShearModulus::fromKPa(3.7);
  EXPECT_DOUBLE_EQ(toShear(toYoungs(mu, 0.45), 0.45).kPa(), mu.kPa());
  EXPECT_DOUBLE_EQ(mu.Pa(), 3700.0);
}

TEST(Frames, FlipIsItsOwnInverse) {
  const Eigen::Vector3d p(1, 2, 3);
  EXPECT_EQ(lpsToRas(p), Eigen::Vector3d(-1, -2, 3));
  EXPECT_EQ(rasToLps(lpsToRas(p)), p);
}

TEST(Parallel, SumHasTheSameBitsWithAnyNumberOfThreads) {
  std::vector<double> x(100003);
  Random random(7);
  for (double& v : x) v = random.normal() * std::pow(10.0, random.uniform(-8, 8));
  auto sum = [&] {
    return parallelSum(x.size(), 1000, [&](std::size_t b, std::size_t e) {
      double s = 0;
      for (std::size_t i = b; i < e; ++i) s += x[i];
      return s;
    });
  };
  setThreadCount(1);
  const double one = sum();
  for (const int threads : {2, 3, 4}) {
    setThreadCount(threads);
    EXPECT_EQ(one, sum()) << threads << " threads";
  }
  setThreadCount(0);
}

TEST(Parallel, EveryIndexOnceAndExceptionsArrive) {
  std::vector<std::atomic<int>> seen(1013);
  parallelChunks(seen.size(), 10, [&](std::size_t b, std::size_t e) {
    for (std::size_t i = b; i < e; ++i) ++seen[i];
  });
  for (const auto& s : seen) EXPECT_EQ(s.load(), 1);
  EXPECT_THROW(parallelChunks(100, 1,
                              [](std::size_t b, std::size_t) {
                                if (b == 57) throw BadInput("57");
                              }),
               BadInput);
}

TEST(Progress, PartsNestAndStopThrows) {
  std::vector<double> seen;
  std::stop_source stop;
  const Progress whole([&](double f, const std::string&) { seen.push_back(f); }, stop.get_token());
  whole.part(0.5, 1.0).part(0.0, 0.5).report(1.0, "x");
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_DOUBLE_EQ(seen[0], 0.75);
  stop.request_stop();
  EXPECT_THROW(whole.check(), Cancelled);
  EXPECT_THROW(whole.part(0, 1).report(0, ""), Cancelled);
}

TEST(Sha256, KnownAnswers) {
  EXPECT_EQ(sha256("abc", 3), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  const test::TemporaryFolder folder;
  std::ofstream(folder / "abc.txt") << "abc";
  EXPECT_EQ(sha256OfFile(folder / "abc.txt"), sha256("abc", 3));
  EXPECT_THROW(sha256OfFile(folder / "none"), BadInput);
}

TEST(Random, UniformMomentsAndRepeatability) {
  Random a(3), b(3);
  double mean = 0, square = 0;
  constexpr int n = 200000;
  for (int i = 0; i < n; ++i) {
    const double v = a.normal();
    EXPECT_EQ(v, b.normal());
    mean += v / n;
    square += v * v / n;
  }
  EXPECT_NEAR(mean, 0.0, 5.0 / std::sqrt(n));
  EXPECT_NEAR(square, 1.0, 5.0 * std::sqrt(2.0 / n));
}

}  // namespace
}  // namespace glisson
