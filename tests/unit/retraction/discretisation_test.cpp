// SPDX-License-Identifier: GPL-3.0-or-later

// The error that a run on Delaunay tetrahedra is said to have, against the answer in much finer ones.
//
// The estimate is |u_h − u_rh| / (r − 1), r = 2 or less. Where the error falls with order p that is (r^p − 1) / (r − 1)
// times the error: once for p = 1, the least that staircases of forces leave, and at r = 2 three times for p = 2, seven
// times for p = 3, the best that linear and quadratic tetrahedra can do. Half of the first is allowed, for cells that
// are not small beside the body.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "retraction/discretisation.h"

namespace glisson::retraction {
namespace {

using Eigen::Vector3d;

template <class Inside>
Model bodyOf(const Vector3d& low_mm, const Vector3d& high_mm, Inside&& inside) {
  constexpr double h_mm = 3.0;
  image::Grid g;
  g.spacing_mm.setConstant(h_mm);
  g.size = ((high_mm - low_mm) / h_mm).array().ceil().cast<int>() + 2;
  g.origin_lps_mm = 0.5 * (low_mm + high_mm) - 0.5 * h_mm * (g.size.cast<double>().array() - 1.0).matrix();
  image::ScalarVolume E(g);
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) E.at(i, j, k) = inside(g.indexToLps(Vector3d(i, j, k))) ? 6.0F : 0.0F;
  return makeModel(std::move(E), 0.45, defaults::liverDensity, false);
}

Model ellipsoid() {
  const Vector3d semi(60, 45, 40);
  return bodyOf(-semi, semi, [&](const Vector3d& x) { return x.cwiseQuotient(semi).norm() < 1; });
}

/// A ball with a finger.
Model fingered() {
  return bodyOf(Vector3d(-65, -40, -40), Vector3d(65, 40, 40), [](const Vector3d& x) {
    return (x - Vector3d(-25, 0, 0)).norm() < 40 || (x.x() > 0 && x.x() < 65 && std::hypot(x.y(), x.z()) < 10);
  });
}

/// Held by springs on the right, heavy to one side.
retraction::Setup heldAtOneEnd() {
  retraction::Setup s;
  s.poisson = 0.45;
  SupportSpec bed;
  bed.kind = SupportSpec::Kind::Spring;
  bed.region = BoxRegion{Vector3d(-100, -100, -100), Vector3d(-24, 100, 100)};
  bed.stiffness_kPa_per_mm = 2.0;
  s.supports = {bed};
  s.loads = {BodyForce{{0, -400, -800}}};
  s.model.kind = ModelKind::FemTet;
  s.model.delaunay = true;
  return s;
}

retraction::Setup with(retraction::Setup s, bool quadratic, double cell_mm, double toolCell_mm) {
  s.model.quadraticTets = quadratic;
  s.model.cell_mm = cell_mm;
  s.model.toolCell_mm = toolCell_mm;
  return s;
}

/// The answer in fine quadratic tetrahedra, and what coarser ones miss of it.
class Truth {
 public:
  Truth(const Model& model, const retraction::Setup& setup, double cell_mm, double toolCell_mm)
      : model_(model), setup_(setup) {
    const image::Grid& g = model.youngs_kPa.grid;
    for (int k = 0; k < g.size.z(); ++k)
      for (int j = 0; j < g.size.y(); ++j)
        for (int i = 0; i < g.size.x(); ++i)
          if (model.youngs_kPa.at(i, j, k) > 0) points_.push_back(g.indexToLps(Vector3d(i, j, k)));
    u_mm_ = displacementAt(model, simulate(model, with(setup, true, cell_mm, toolCell_mm), {}), points_);
  }

  struct Run {
    DiscretisationError told;
    double mean_mm = 0.0, max_mm = 0.0;  ///< the error itself
  };

  Run coarser(bool quadratic, double cell_mm) const {
    const retraction::Setup s = with(setup_, quadratic, cell_mm, 0.5 * cell_mm);
    const Result r = simulate(model_, s, {});
    Run run{discretisationError(model_, s, r)};
    EXPECT_TRUE(run.told.known) << run.told.note;
    const std::vector<Vector3d> u_mm = displacementAt(model_, r, points_);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double off_mm = (u_mm[i] - u_mm_[i]).norm();
      run.mean_mm += off_mm / static_cast<double>(points_.size());
      run.max_mm = std::max(run.max_mm, off_mm);
    }
    std::printf("  %s of %.1f against %.1f mm: mean %.4f mm told, %.4f mm off (%.2f); most %.4f, %.4f (%.2f)\n",
                quadratic ? "T10" : "T4", run.told.cell_mm, run.told.coarse_mm, run.told.mean_mm, run.mean_mm,
                run.told.mean_mm / run.mean_mm, run.told.max_mm, run.max_mm, run.told.max_mm / run.max_mm);
    const double times = run.told.coarse_mm / run.told.cell_mm;
    const double best = (std::pow(times, quadratic ? 3.0 : 2.0) - 1.0) / (times - 1.0);
    EXPECT_GT(run.told.mean_mm, 0.5 * run.mean_mm);
    EXPECT_LT(run.told.mean_mm, best * run.mean_mm);
    EXPECT_GT(run.told.max_mm, 0.5 * run.max_mm);
    EXPECT_LT(run.told.max_mm, best * run.max_mm);
    return run;
  }

 private:
  const Model& model_;
  retraction::Setup setup_;
  std::vector<Vector3d> points_;
  std::vector<Vector3d> u_mm_;
};

/// Half the cells: half the error where it falls with first order, which nothing here does more slowly; the estimate
/// follows, more slowly while the larger of its two meshes is coarse.
void expectSmaller(const Truth::Run& half, const Truth::Run& whole) {
  EXPECT_LT(half.mean_mm, 0.5 * whole.mean_mm);
  EXPECT_LT(half.told.mean_mm, whole.told.mean_mm);
}

TEST(DelaunayError, UnderWeight) {
  const Model m = ellipsoid();
  const Truth truth(m, heldAtOneEnd(), 7.0, 7.0);
  expectSmaller(truth.coarser(false, 5.0), truth.coarser(false, 10.0));
  expectSmaller(truth.coarser(true, 10.0), truth.coarser(true, 20.0));
}

TEST(DelaunayError, UnderABar) {
  const Model m = ellipsoid();
  retraction::Setup s = heldAtOneEnd();
  Retractor bar;
  bar.at_mm = Vector3d(18, 45, 0);
  bar.length_mm = 40;
  bar.force_N = 0.3;
  s.loads.push_back(bar);
  const Truth truth(m, s, 10.0, 4.0);
  truth.coarser(false, 12.0);
}

// Where tetrahedra of twice the edge fail their gates, smaller ones are taken and the difference is scaled. Quadratic
// ones: the finger is one cell thick, and what linear ones make of its bending differs less between two sizes than both
// do from the truth.
TEST(DelaunayError, WhereTwiceTheEdgeIsRefused) {
  const Model m = fingered();
  const retraction::Setup s = heldAtOneEnd();
  const Truth truth(m, s, 8.0, 8.0);
  int refused = 0;
  for (const double cell_mm : {16.0, 18.0}) {
    bool doubled = true;
    try {
      simulate(m, with(s, true, 2.0 * cell_mm, cell_mm), {});
    } catch (const BadInput&) {
      doubled = false;
    }
    const Truth::Run run = truth.coarser(true, cell_mm);
    if (doubled) {
      EXPECT_EQ(run.told.coarse_mm, 2.0 * cell_mm);
    } else {
      EXPECT_LT(run.told.coarse_mm, 2.0 * cell_mm);
      EXPECT_GE(run.told.coarse_mm, 1.5 * cell_mm);
    }
    refused += doubled ? 0 : 1;
  }
  EXPECT_GT(refused, 0) << "no body here has what the test is about";
}

}  // namespace
}  // namespace glisson::retraction
