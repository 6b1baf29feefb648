// SPDX-License-Identifier: GPL-3.0-or-later

// The error that a run in voxels is said to have, at the retractor and of a difference, against the answer in finer
// voxels of the same shape.
//
// Where the error falls with order p, the estimate from cells twice as large, |u_h − u_2h|, is 2^p times |u_h − u_h/2|;
// that from half cells, 2 |u_h − u_h/2|, is 2 / (1 + 2^-p) times |u_h − u_h/4|: between 1 and 2 for every p. Half of
// that is allowed downwards, for cells that are not small beside the bar.
#include <gtest/gtest.h>

#include <cmath>

#include "retraction/body.h"
#include "retraction/discretisation.h"

namespace glisson::retraction {
namespace {

using Eigen::Vector3d;

/// In voxels, stiffer towards one end.
Model ellipsoid(double cell_mm, double youngs_kPa, double steeper_kPa) {
  const Vector3d semi(60, 45, 40);
  image::Grid g;
  g.spacing_mm.setConstant(cell_mm);
  g.size = (2.0 * semi / cell_mm).array().ceil().cast<int>() + 1;
  g.origin_lps_mm = -0.5 * cell_mm * (g.size.cast<double>().array() - 1.0).matrix();
  image::ScalarVolume E(g);
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) {
        const Vector3d x = g.indexToLps(Vector3d(i, j, k));
        if (x.cwiseQuotient(semi).norm() < 1)
          E.at(i, j, k) = static_cast<float>(youngs_kPa + steeper_kPa * (0.5 + x.x() / 120));
      }
  return makeModel(std::move(E), 0.45, defaults::liverDensity, false);
}

/// Held on the right, lifted by a bar behind.
retraction::Setup underABar(SupportSpec::Kind kind) {
  retraction::Setup s;
  s.poisson = 0.45;
  SupportSpec bed;
  bed.kind = kind;
  bed.region = BoxRegion{Vector3d(-100, -100, -100), Vector3d(-24, 100, 100)};
  if (kind == SupportSpec::Kind::Spring) bed.stiffness_kPa_per_mm = 2.0;
  s.supports = {bed};
  Retractor bar;
  bar.at_mm = Vector3d(18, 45, 0);
  bar.length_mm = 40;
  bar.force_N = 0.5;
  s.loads = {BodyForce{{0, -400, -800}}, bar};
  return s;
}

/// Points of a model's answers: cells, then the nodes of the contact.
struct Points {
  std::vector<Vector3d> all_mm;
  std::size_t cells = 0;
  Points(const Model& model, const Result& result) {
    const image::Grid& g = model.youngs_kPa.grid;
    for (int k = 0; k < g.size.z(); ++k)
      for (int j = 0; j < g.size.y(); ++j)
        for (int i = 0; i < g.size.x(); ++i)
          if (model.youngs_kPa.at(i, j, k) > 0) all_mm.push_back(g.indexToLps(Vector3d(i, j, k)));
    cells = all_mm.size();
    const Body body(model);
    for (const int node : result.contactNodes) all_mm.push_back(body.nodePosition_mm(node));
  }
};

double meanLength(const std::vector<Vector3d>& v, std::size_t begin, std::size_t end) {
  double sum = 0.0;
  for (std::size_t i = begin; i < end; ++i) sum += v[i].norm() / static_cast<double>(end - begin);
  return sum;
}

/// Estimate over error of displacement and difference, mean and at the retractor; `times` halved are the finer cells.
void expectTold(double cell_mm, int times, double most) {
  const retraction::Setup s = underABar(SupportSpec::Kind::Spring);
  const Model measured = times == 1 ? refined(ellipsoid(2 * cell_mm, 6, 8)) : ellipsoid(cell_mm, 6, 8);
  const Model atlas = times == 1 ? refined(ellipsoid(2 * cell_mm, 6, 0)) : ellipsoid(cell_mm, 6, 0);
  const Result a = simulate(measured, s, {}), b = simulate(atlas, s, {});
  const SecondAnswer second{atlas, b};
  const DiscretisationError told = discretisationError(measured, s, a, {}, &second);
  ASSERT_TRUE(told.known && told.at_retractor_mm && told.difference && told.difference->at_retractor_mm) << told.note;
  EXPECT_EQ(told.coarse_mm, (times == 1 ? 2.0 : 0.5) * cell_mm);

  Model finer = refined(measured), finerAtlas = refined(atlas);
  if (times == 2) finer = refined(finer), finerAtlas = refined(finerAtlas);
  const Points at(measured, a);
  std::vector<Vector3d> u = displacementAt(measured, a, at.all_mm), d = u;
  const auto fine = displacementAt(finer, simulate(finer, s, {}), at.all_mm);
  const auto fineAtlas = displacementAt(finerAtlas, simulate(finerAtlas, s, {}), at.all_mm);
  const auto own = displacementAt(atlas, b, at.all_mm);
  for (std::size_t i = 0; i < u.size(); ++i) {
    u[i] -= fine[i];
    d[i] = u[i] - (own[i] - fineAtlas[i]);
  }
  const struct {
    const char* what;
    double told_mm, off_mm;
  } rows[] = {{"mean", told.mean_mm, meanLength(u, 0, at.cells)},
              {"at the retractor", *told.at_retractor_mm, meanLength(u, at.cells, u.size())},
              {"difference, mean", told.difference->mean_mm, meanLength(d, 0, at.cells)},
              {"difference, at the retractor", *told.difference->at_retractor_mm, meanLength(d, at.cells, d.size())}};
  for (const auto& row : rows) {
    std::printf("  cells of %.0f against %.0f mm, %s: %.4f mm told, %.4f mm off (%.2f)\n", told.cell_mm, told.coarse_mm,
                row.what, row.told_mm, row.off_mm, row.told_mm / row.off_mm);
    EXPECT_GT(row.told_mm, 0.5 * row.off_mm) << row.what;
    EXPECT_LT(row.told_mm, most * row.off_mm) << row.what;
  }
  EXPECT_LT(told.difference->mean_mm, told.mean_mm) << "what the two have in common cancels";
}

TEST(VoxelError, AtTheRetractorAndOfTheDifferenceFromHalfCells) {
  expectTold(8.0, 2, 2.0);
}

TEST(VoxelError, AtTheRetractorAndOfTheDifferenceFromLargerCells) {
  expectTold(4.0, 1, 4.0);  // second order at best: linear shape functions
}

TEST(VoxelError, OfNoDifferenceIsNone) {
  const retraction::Setup s = underABar(SupportSpec::Kind::Spring);
  const Model m = ellipsoid(8.0, 6, 0);
  const Result r = simulate(m, s, {});
  const SecondAnswer second{m, r};
  const DiscretisationError e = discretisationError(m, s, r, {}, &second);
  ASSERT_TRUE(e.difference && e.difference->at_retractor_mm) << e.note;
  EXPECT_EQ(e.difference->mean_mm, 0.0);
  EXPECT_EQ(*e.difference->at_retractor_mm, 0.0);
  EXPECT_GT(*e.at_retractor_mm, 0.0);
}

// Clamped bodies move by 1/E: half the modulus, twice the error, and the difference has the error of the first.
TEST(VoxelError, OfTheDifferenceToHalfTheModulusIsTheErrorItself) {
  const retraction::Setup s = underABar(SupportSpec::Kind::Fixed);
  const Model stiff = ellipsoid(8.0, 6, 0), soft = ellipsoid(8.0, 3, 0);
  const Result a = simulate(stiff, s, {}), b = simulate(soft, s, {});
  const SecondAnswer second{soft, b};
  const DiscretisationError e = discretisationError(stiff, s, a, {}, &second);
  ASSERT_TRUE(e.difference && e.difference->at_retractor_mm) << e.note;
  EXPECT_NEAR(e.difference->mean_mm / e.mean_mm, 1.0, 1e-4);
  EXPECT_NEAR(*e.difference->at_retractor_mm / *e.at_retractor_mm, 1.0, 1e-4);
  EXPECT_NE(e.note.find("at the retractor"), std::string::npos) << e.note;
}

TEST(VoxelError, WithoutARetractorNothingIsSaidOfIt) {
  retraction::Setup s = underABar(SupportSpec::Kind::Fixed);
  s.loads.pop_back();
  const Model m = ellipsoid(8.0, 6, 0);
  const DiscretisationError e = discretisationError(m, s, simulate(m, s, {}));
  EXPECT_TRUE(e.known) << e.note;
  EXPECT_FALSE(e.at_retractor_mm || e.difference);
}

}  // namespace
}  // namespace glisson::retraction
