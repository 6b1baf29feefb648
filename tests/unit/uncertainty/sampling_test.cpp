// SPDX-License-Identifier: GPL-3.0-or-later
#include "uncertainty/sampling.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "base/random.h"

namespace glisson::uncertainty {
namespace {

/// One landmark, one sample and one cell, all at the same displacement; columns as given.
FirstOrder onePlace(const Eigen::Vector3f& measured,
                    const std::vector<std::pair<SourceKind, Eigen::Vector3f>>& columns) {
  FirstOrder f;
  f.places.landmark = {7};
  f.places.landmark_m = {Eigen::Vector3d::Zero()};
  f.places.sample = {3};
  f.places.sample_mm2 = {2.0};
  f.places.cells = 1;
  f.measured = measured.replicate(3, 1);
  f.textbook = Eigen::VectorXf::Zero(9);
  const auto n = static_cast<Eigen::Index>(columns.size());
  f.measuredGain = f.textbookGain = Eigen::MatrixXf::Zero(9, n);
  f.travelGain = f.textbookTravelGain = Eigen::VectorXd::Zero(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    f.kind.push_back(columns[static_cast<std::size_t>(k)].first);
    f.measuredGain.col(k) = columns[static_cast<std::size_t>(k)].second.replicate(3, 1);
    f.travelGain[k] = static_cast<double>(columns[static_cast<std::size_t>(k)].second.x());
  }
  f.travel_mm = static_cast<double>(measured.x());
  return f;
}

constexpr int draws = 40000;

TEST(Sampling, AlongADifferenceItIsThatOfANormal) {
  const FirstOrder f = onePlace({6, 0, 0}, {{SourceKind::Force, {1, 0, 0}}});
  const Spread s = sampled(f, {}, draws, 1);
  ASSERT_TRUE(s.headline);
  EXPECT_NEAR(s.headline->at_retractor_mm.low, 6 - 1.96, 0.05);
  EXPECT_NEAR(s.headline->at_retractor_mm.high, 6 + 1.96, 0.05);
  EXPECT_NEAR(s.headline->beyond, 0.8413, 0.01);
  EXPECT_NEAR(s.headline->travel_mm.low, 6 - 1.96, 0.05);
  EXPECT_NEAR(s.headline->vessels->max_mm.high, 6 + 1.96, 0.05);
  EXPECT_NEAR(s.headline->mean_mm.low, 6 - 1.96, 0.35);  // of fewer draws
  ASSERT_EQ(s.landmarks.size(), 1u);
  EXPECT_EQ(s.landmarks[0].landmark, 7u);
  EXPECT_NEAR(s.landmarks[0].sd_mm, 1, 1e-6);
  EXPECT_NEAR(*s.landmarks[0].difference_sd_mm, 1, 0.02);
  EXPECT_NEAR(*s.landmarks[0].beyond, 0.8413, 0.01);
}

TEST(Sampling, ADifferenceNearNothingHasNoNegativeHalf) {
  const FirstOrder f = onePlace({0, 0, 0}, {{SourceKind::Force, {1, 0, 0}}, {SourceKind::BarPlace, {0, 1, 0}}});
  const Spread s = sampled(f, {}, draws, 1);
  // Rayleigh; a difference of nothing may be what it is.
  EXPECT_EQ(s.headline->at_retractor_mm.low, 0.0);
  EXPECT_NEAR(s.headline->at_retractor_mm.high, std::sqrt(-2 * std::log(0.025)), 0.05);
}

TEST(Sampling, WhatBothRetractionsShareCancels) {
  FirstOrder f = onePlace({6, 0, 0}, {{SourceKind::Force, {1, 0, 0}}});
  f.textbookGain = f.measuredGain;
  f.textbookTravelGain = f.travelGain;
  const Spread s = sampled(f, {}, 2000, 1);
  EXPECT_NEAR(s.headline->at_retractor_mm.high - s.headline->at_retractor_mm.low, 0, 1e-5);
  EXPECT_NEAR(s.landmarks[0].sd_mm, 1, 1e-6);
  EXPECT_NEAR(*s.landmarks[0].textbook_sd_mm, 1, 1e-6);
  EXPECT_NEAR(s.sources[0].sd_mm, 0, 1e-5);
}

TEST(Sampling, FewFieldsMakeWiderTailsAndSourcesAreToldApart) {
  std::vector<std::pair<SourceKind, Eigen::Vector3f>> columns;
  for (int k = 0; k < 4; ++k) columns.push_back({SourceKind::ElastogramNoise, {0.5f, 0, 0}});  // together 1 mm
  columns.push_back({SourceKind::Outline, {0.5f, 0, 0}});
  FirstOrder f = onePlace({30, 0, 0}, columns);
  f.fields = 4;
  const Spread s = sampled(f, {}, draws, 1);
  ASSERT_EQ(s.sources.size(), 2u);
  EXPECT_EQ(s.sources[0].kind, SourceKind::ElastogramNoise);
  EXPECT_NEAR(s.sources[1].sd_mm, 0.5, 0.05);
  f.fields = 0;
  const Spread normal = sampled(f, {}, draws, 1);
  const auto width = [](const Interval& i) { return i.high - i.low; };
  // Student's t of four degrees: 2.78 for 1.96, here beside a normal of half its width.
  EXPECT_GT(width(s.headline->at_retractor_mm), 1.2 * width(normal.headline->at_retractor_mm));
  EXPECT_NEAR(width(normal.headline->at_retractor_mm), 2 * 1.96 * std::sqrt(1.25), 0.1);
}

TEST(Sampling, FurtherErrorsWidenEverythingTheySpeakOf) {
  const FirstOrder f = onePlace({6, 0, 0}, {{SourceKind::Force, {1e-3f, 0, 0}}});
  const FurtherErrors cells{SourceKind::Cells, 0.3, 0.6, 1.0, 0.2, 0.0};
  const Spread s = sampled(f, {cells}, draws, 1);
  EXPECT_NEAR(s.headline->at_retractor_mm.high, 7.96, 0.05);
  EXPECT_NEAR(s.landmarks[0].sd_mm, 0.3, 1e-4);
  EXPECT_NEAR(*s.landmarks[0].difference_sd_mm, 0.6 / std::sqrt(3.0), 0.01);
  EXPECT_EQ(s.sources.back().kind, SourceKind::Cells);
  EXPECT_EQ(s.sources.back().sd_mm, 1.0);
  EXPECT_NEAR(s.headline->travel_mm.high - s.headline->travel_mm.low, 0, 0.01);
}

TEST(Sampling, WhatTheFirstOrderMissesIsAShareOfEachPlacesSpread) {
  FirstOrder f = onePlace({6, 0, 0}, {{SourceKind::Force, {0.5f, 0, 0}}});
  FurtherErrors missed{SourceKind::BeyondFirstOrder};
  missed.place = 0.75;
  missed.difference = 2.0;
  const Spread s = sampled(f, {missed}, draws, 1);
  EXPECT_NEAR(s.landmarks[0].sd_mm, 0.5 * 1.25, 1e-4);
  EXPECT_NEAR(*s.landmarks[0].difference_sd_mm, 0.5 * std::sqrt(1 + 4.0 / 3), 0.02);
  EXPECT_NEAR(s.sources.back().vessels_sd_mm, 0.375, 1e-4);
}

TEST(Sampling, TheMapOfProbabilitiesIsThatOfItsCovariance) {
  const std::vector<std::pair<SourceKind, Eigen::Vector3f>> columns = {
      {SourceKind::Outline, {1.5f, 0.5f, 0}}, {SourceKind::Force, {-1, 2, 0.3f}}, {SourceKind::BarPlace, {0, 0.7f, 1}}};
  const FurtherErrors cells{SourceKind::Cells, 0.3, 1.2, 1.0, 0.2, 0.0};
  for (const Eigen::Vector3f& here : {Eigen::Vector3f(1, 0, 0), Eigen::Vector3f(4, 1, 0), Eigen::Vector3f(7, 2, 3)}) {
    const Spread s = sampled(onePlace(here, columns), {cells}, draws, 1);
    ASSERT_EQ(s.cellBeyond.size(), 1u);
    // By a root of the covariance, which has nothing to do with columns, and other draws.
    Eigen::Matrix3d covariance = 1.2 * 1.2 / 3 * Eigen::Matrix3d::Identity();
    for (const auto& [kind, gain] : columns) covariance += gain.cast<double>() * gain.cast<double>().transpose();
    const Eigen::Matrix3d root = covariance.llt().matrixL();
    Random random(99);
    int beyond = 0;
    constexpr int count = 100000;
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d z(random.normal(), random.normal(), random.normal());
      beyond += (here.cast<double>() + root * z).norm() >= 5.0;
    }
    const double p = static_cast<double>(beyond) / count;
    EXPECT_NEAR(static_cast<double>(s.cellBeyond[0]), p, 3 * std::sqrt(p * (1 - p) / 1000) + 0.005) << here.transpose();
    EXPECT_NEAR(*s.landmarks[0].beyond, p, 0.01);
    EXPECT_NEAR(s.headline->vessels->furthestBeyond, p, 0.01);
  }
}

TEST(Sampling, APlaceHasItsCovarianceInThePatientsAxes) {
  FirstOrder f = onePlace({6, 0, 0}, {{SourceKind::Force, {1, 0, 0}}, {SourceKind::BarPlace, {0, 2, 0}}});
  f.toLps << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // x becomes y
  const Spread exact = sampled(f, {}, 100, 1);
  EXPECT_TRUE(exact.landmarks[0].place_mm2.isApprox(Eigen::Vector3d(4, 1, 0).asDiagonal().toDenseMatrix(), 1e-6));
  const Spread s = sampled(f, {{SourceKind::Cells, 0.3, 0.6, 1.0, 0.2, 0.0}}, 100, 1);
  EXPECT_NEAR(s.landmarks[0].place_mm2.trace(), s.landmarks[0].sd_mm * s.landmarks[0].sd_mm, 1e-9);
  EXPECT_NEAR(s.landmarks[0].place_mm2(2, 2), 0.03, 1e-9);
}

TEST(Sampling, WhatASourceDoesToTheVesselFurthestApart) {
  const FirstOrder f = onePlace({6, 0, 0}, {{SourceKind::Force, {1, 0, 0}}, {SourceKind::BarPlace, {0, 0.01f, 0}}});
  const Spread s = sampled(f, {{SourceKind::Cells, 0.3, 0.6, 1.0, 0.2, 0.0}}, draws, 1);
  EXPECT_EQ(s.headline->vessels->furthest, 7u);
  EXPECT_NEAR(s.headline->vessels->furthest_mm, 6, 1e-5);
  ASSERT_EQ(s.sources.size(), 3u);
  EXPECT_NEAR(s.sources[0].furthest_sd_mm, 1, 0.1);
  EXPECT_NEAR(s.sources[1].furthest_sd_mm, 0, 1e-3);  // across the difference: its length hardly changes
  EXPECT_NEAR(s.sources[2].furthest_sd_mm, 0.6 / std::sqrt(3.0), 0.02);
}

TEST(Sampling, TheShareOfVesselsBeyondHasAnInterval) {
  FirstOrder f = onePlace({5, 0, 0}, {{SourceKind::Force, {0.5f, 0, 0}}});
  // A second landmark far beyond the line, of the same spread.
  f.places.landmark = {7, 9};
  f.places.landmark_m.emplace_back(Eigen::Vector3d::Zero());
  const auto grown = [](const Eigen::MatrixXf& m, const Eigen::MatrixXf& first) {
    Eigen::MatrixXf out(m.rows() + 3, m.cols());
    out << first, m;
    return out;
  };
  f.measured = grown(f.measured, Eigen::Vector3f(20, 0, 0));
  f.textbook = Eigen::VectorXf::Zero(12);
  f.measuredGain = grown(f.measuredGain, Eigen::Vector3f(0.5f, 0, 0));
  f.textbookGain = Eigen::MatrixXf::Zero(12, 1);
  const VesselHeadline v = sampled(f, {}, draws, 1).headline->vessels.value();
  EXPECT_EQ(v.beyond.low, 0.5);
  EXPECT_EQ(v.beyond.high, 1.0);
  EXPECT_NEAR(v.mean_mm.low, 12.5 - 1.96 * 0.5, 0.03);
  EXPECT_NEAR(v.max_mm.high, 20 + 1.96 * 0.5, 0.03);
  EXPECT_EQ(v.furthest, 7u);
  EXPECT_EQ(v.furthestBeyond, 1.0);
}

TEST(Sampling, TheNumberOfThreadsDoesNotChangeABit) {
  const FirstOrder f = onePlace({6, 1, 0}, {{SourceKind::Force, {1, 0, 0}}, {SourceKind::BarPlace, {0, 1, 2}}});
  setThreadCount(1);
  const Spread one = sampled(f, {}, 3000, 9);
  setThreadCount(3);
  const Spread three = sampled(f, {}, 3000, 9);
  setThreadCount(0);
  EXPECT_EQ(one.headline->at_retractor_mm.low, three.headline->at_retractor_mm.low);
  EXPECT_EQ(one.headline->mean_mm.high, three.headline->mean_mm.high);
  EXPECT_EQ(*one.landmarks[0].difference_sd_mm, *three.landmarks[0].difference_sd_mm);
}

}  // namespace
}  // namespace glisson::uncertainty
