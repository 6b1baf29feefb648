// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastography/roi_mapping.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "base/error.h"
#include "elastography/roi_from_structures.h"
#include "image/morphology.h"

namespace glisson::elastography {
namespace {

using testing::HasSubstr;

Eigen::Matrix3d oblique() {
  return Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix() *
         Eigen::Matrix3d(Eigen::Vector3d(1, -1, -1).asDiagonal());
}

/// MRI with 1.2 mm pixels; slice spacing and offset of the MRE against it as given, in mm along the common normal.
image::Grid mri(double spacing_mm, int slices) {
  image::Grid g;
  g.size = {120, 110, slices};
  g.spacing_mm = {1.2, 1.2, spacing_mm};
  g.origin_lps_mm = {-70, -60, 500};
  g.direction = oblique();
  return g;
}

image::Grid mre(double offset_mm, int slices) {
  image::Grid g;
  g.size = {80, 80, slices};
  g.spacing_mm = {1.64, 1.64, 10};
  g.direction = oblique();
  g.origin_lps_mm = Eigen::Vector3d(-70, -60, 500) + g.direction * Eigen::Vector3d(3.0, 2.0, offset_mm);
  return g;
}

/// A circle of radius 40 mm round the middle of the MRI, on the slices named.
roi::ContourStack circles(const image::Grid& g, std::initializer_list<double> slices) {
  roi::ContourStack s;
  for (const double k : slices) {
    roi::Polygon p;
    p.points_lps_mm.resize(3, 180);
    for (int v = 0; v < 180; ++v) {
      const double a = v * std::numbers::pi / 90.0;
      p.points_lps_mm.col(v) = g.indexToLps({57 + 40 / 1.2 * std::cos(a), 55 + 40 / 1.2 * std::sin(a), k});
    }
    s.polygons.push_back(p);
  }
  return s;
}

/// Largest misjudgement of a mask slice against the circle: voxels inside whose centre is outside by more than
/// tolerance_mm, or the reverse.
int misjudged(const image::Mask& m, int k, const image::Grid& drawnOn, double tolerance_mm) {
  const Eigen::Vector3d centre = drawnOn.indexToLps({57, 55, 0});
  const Eigen::Vector3d normal = m.grid.direction.col(2);
  int wrong = 0;
  for (int j = 0; j < m.grid.size.y(); ++j)
    for (int i = 0; i < m.grid.size.x(); ++i) {
      Eigen::Vector3d d = m.grid.indexToLps(Eigen::Vector3d(i, j, k)) - centre;
      d -= d.dot(normal) * normal;
      if (m.at(i, j, k) != 0 ? d.norm() > 40 + tolerance_mm : d.norm() < 40 - tolerance_mm) ++wrong;
    }
  return wrong;
}

TEST(MapRoi, CoincidentPlanesRasteriseThePolygonItself) {
  const image::Grid anatomy = mri(10.0, 6), elastogram = mre(10.0, 3);
  const MappedRoi r = mapRoi(circles(anatomy, {1, 2, 3}), anatomy, elastogram);
  EXPECT_EQ(r.coincidentSlices, 3);
  EXPECT_EQ(r.sampledSlices, 0);
  EXPECT_LT(r.planeDistance_mm, 1e-9);
  EXPECT_DOUBLE_EQ(r.coverage, 1.0);
  EXPECT_TRUE(r.warnings.empty());
  for (int k = 0; k < 3; ++k) EXPECT_EQ(misjudged(r.mask, k, anatomy, 0.01), 0);
  // Without the MRI's slices the answer is the same.
  const MappedRoi bare = mapRoi(circles(anatomy, {1, 2, 3}), std::nullopt, elastogram);
  EXPECT_EQ(bare.mask.values, r.mask.values);
  EXPECT_GT(bare.coverage, 0.98);
  EXPECT_TRUE(bare.warnings.empty());
}

TEST(MapRoi, PlanesInBetweenAskTheMriVoxel) {
  const image::Grid anatomy = mri(4.0, 12), elastogram = mre(9.0, 2);  // MRE at 9 and 19 mm, MRI at 8, 12, 16, 20
  const MappedRoi r = mapRoi(circles(anatomy, {1, 2, 3, 4, 5, 6}), anatomy, elastogram);
  EXPECT_EQ(r.coincidentSlices, 0);
  EXPECT_EQ(r.sampledSlices, 2);
  // A voxel of the MRI holds the centre: the border is off by at most half a voxel diagonal of the MRI.
  for (int k = 0; k < 2; ++k) EXPECT_EQ(misjudged(r.mask, k, anatomy, 0.6 * std::sqrt(2.0) + 0.01), 0);
  EXPECT_TRUE(r.warnings.empty());
}

TEST(MapRoi, PartOutsideIsMeasuredAndWarned) {
  const image::Grid anatomy = mri(10.0, 8), elastogram = mre(10.0, 3);
  const MappedRoi r = mapRoi(circles(anatomy, {1, 2, 3, 4, 5, 6}), anatomy, elastogram);
  EXPECT_NEAR(r.coverage, 0.5, 1e-12);
  EXPECT_NEAR(r.planeDistance_mm, 30.0, 1e-9);
  ASSERT_EQ(r.warnings.size(), 2u);
  EXPECT_THAT(r.warnings[0], HasSubstr("30 mm"));
  EXPECT_THAT(r.warnings[1], HasSubstr("50 %"));
  EXPECT_NEAR(mapRoi(circles(anatomy, {1, 2, 3, 4, 5, 6}), std::nullopt, elastogram).coverage, 0.5, 0.01);
}

TEST(MapRoi, ThinDrawingOnThickSlicesDoesNotCancel) {
  const image::Grid anatomy = mri(5.0, 10), elastogram = mre(10.0, 2);
  const MappedRoi with = mapRoi(circles(anatomy, {1, 2, 3, 4, 5}), anatomy, elastogram);
  const MappedRoi bare = mapRoi(circles(anatomy, {1, 2, 3, 4, 5}), std::nullopt, elastogram);
  for (int k = 0; k < 2; ++k) EXPECT_EQ(misjudged(with.mask, k, anatomy, 0.01), 0);
  EXPECT_EQ(bare.mask.values, with.mask.values);
}

TEST(MapRoi, OtherFrameOfReferenceIsWarned) {
  const image::Grid anatomy = mri(10.0, 6), elastogram = mre(10.0, 3);
  roi::ContourStack s = circles(anatomy, {1, 2, 3});
  s.frameOfReferenceUid = "1.2.3";
  EXPECT_TRUE(mapRoi(s, anatomy, elastogram, "1.2.3").warnings.empty());
  EXPECT_TRUE(mapRoi(s, anatomy, elastogram, "").warnings.empty());
  EXPECT_THAT(mapRoi(s, anatomy, elastogram, "1.2.4").warnings.at(0), HasSubstr("frames of reference"));
}

TEST(MapRoi, MaskOfAnotherGridKeepsItsPlace) {
  const image::Grid anatomy = mri(3.0, 14), elastogram = mre(10.0, 3);
  const image::Mask drawn = roi::rasterise(circles(anatomy, {2, 3, 4, 5, 6, 7, 8, 9, 10, 11}), anatomy);
  const MappedRoi r = mapRoi(drawn, elastogram);
  EXPECT_EQ(r.sampledSlices, 3);
  EXPECT_TRUE(r.warnings.empty());
  for (int k = 0; k < 3; ++k) EXPECT_EQ(misjudged(r.mask, k, anatomy, 1.2 * std::sqrt(2.0)), 0);
  EXPECT_EQ(mapRoi(drawn, anatomy).mask.values, drawn.values);
}

TEST(MapRoi, MaskOfTheSameSizeElsewhereHasPerhapsLostItsPlace) {
  const image::Grid elastogram = mre(10.0, 3);
  const image::Mask drawn = roi::rasterise(circles(elastogram, {0, 1, 2}), elastogram);
  EXPECT_TRUE(mapRoi(drawn, elastogram).warnings.empty());

  image::Mask shifted = drawn;
  shifted.grid.origin_lps_mm.x() += 4.0 * elastogram.spacing_mm.x();
  EXPECT_THAT(mapRoi(shifted, elastogram).warnings.at(0), HasSubstr("lost the place"));

  // The same voxels, counted from the other end of each axis.
  image::Mask flipped(elastogram);
  const Eigen::Vector3i last = elastogram.size - Eigen::Vector3i::Ones();
  flipped.grid.origin_lps_mm = elastogram.indexToLps(last.cast<double>());
  flipped.grid.direction *= -1.0;
  for (int k = 0; k <= last.z(); ++k)
    for (int j = 0; j <= last.y(); ++j)
      for (int i = 0; i <= last.x(); ++i) flipped.at(i, j, k) = drawn.at(last.x() - i, last.y() - j, last.z() - k);
  const MappedRoi same = mapRoi(flipped, elastogram);
  EXPECT_TRUE(same.warnings.empty());
  EXPECT_EQ(same.mask.values, drawn.values);

  image::Mask beside = drawn;
  beside.grid.origin_lps_mm += 5000.0 * elastogram.direction.col(0);
  try {
    mapRoi(beside, elastogram);
    FAIL() << "a region 5 m away was taken";
  } catch (const BadInput& e) {
    EXPECT_THAT(e.what(), HasSubstr("beside it in the same slices"));
  }
}

TEST(MapRoi, RefusesWhatDoesNotMeet) {
  const image::Grid anatomy = mri(10.0, 6);
  EXPECT_THROW(mapRoi(circles(anatomy, {0}), anatomy, mre(30.0, 2)), BadInput);
  EXPECT_THROW(mapRoi(roi::ContourStack{}, anatomy, mre(0.0, 2)), BadInput);
  EXPECT_THROW(mapRoi(image::Mask(anatomy), mre(0.0, 2)), BadInput);
}

TEST(MapRoi, ALonePlaneBetweenTwoSlicesCountsOnTheNearest) {
  const image::Grid anatomy = mri(2.0, 30), elastogram = mre(10.0, 3);  // MRE at 10, 20, 30 mm
  for (const int k : {6, 8, 9, 11, 12, 17}) {                           // 12, 16, 18, 22, 24, 34 mm
    const MappedRoi r = mapRoi(circles(anatomy, {1.0 * k}), anatomy, elastogram);
    const int nearest = std::clamp(static_cast<int>(std::lround(0.2 * k)) - 1, 0, 2);
    EXPECT_EQ(misjudged(r.mask, nearest, anatomy, 0.01), 0) << k;
    image::Mask others = r.mask;
    for (int j = 0; j < elastogram.size.y(); ++j)
      for (int i = 0; i < elastogram.size.x(); ++i) others.at(i, j, nearest) = 0;
    EXPECT_EQ(image::count(others), 0u) << k;
    EXPECT_NEAR(r.planeDistance_mm, std::abs(2.0 * k - 10.0 * (nearest + 1)), 1e-9);
    EXPECT_TRUE(r.warnings.empty()) << "within half a slice nothing is odd";
  }
  // Two planes between the same two slices: each counts on its own side.
  EXPECT_EQ(mapRoi(circles(anatomy, {6, 9}), anatomy, elastogram).coincidentSlices, 2);
  // More than half a slice away there is no number, and the distance is told.
  try {
    mapRoi(circles(anatomy, {19}), anatomy, elastogram);
    FAIL() << "8 mm above the last slice";
  } catch (const BadInput& e) {
    EXPECT_THAT(e.what(), HasSubstr("nearest slices are 8 mm apart"));
  }
}

TEST(MapRoi, AMaskBetweenTwoSlicesIsToldSo) {
  const image::Grid anatomy = mri(2.0, 30), elastogram = mre(10.0, 3);
  try {
    mapRoi(roi::rasterise(circles(anatomy, {7}), anatomy), elastogram);  // 14 mm
    FAIL() << "no voxel centre lies in that slice";
  } catch (const BadInput& e) {
    EXPECT_THAT(e.what(), HasSubstr("between two elastography slices, 4 mm from the nearest"));
  }
  image::Mask dot(anatomy);
  dot.at(57, 55, 10) = 1;  // one voxel of 1.2 mm at the height of a slice, between the centres of 1.64 mm voxels
  dot.grid.origin_lps_mm -= 0.6 * dot.grid.direction.col(0);
  const Eigen::Vector3d there = elastogram.lpsToIndex(dot.grid.indexToLps({57, 55, 10}));
  ASSERT_GT(std::abs(there.x() - std::round(there.x())) * 1.64, 0.6) << "the voxel holds a centre";
  try {
    mapRoi(dot, elastogram);
    FAIL() << "no voxel centre lies in that voxel";
  } catch (const BadInput& e) {
    EXPECT_THAT(e.what(), HasSubstr("too small"));
  }
}

TEST(RoiFromStructures, FindsTheLiver) {
  dicom::StructureSet set;
  set.frameOfReferenceUid = "1.2";
  set.referencedSeriesUid = "1.3";
  const roi::ContourStack s = circles(mri(10.0, 6), {1, 2});
  dicom::Structure liver = toStructure(s, 1);
  liver.name = "Whole LIVER";
  dicom::Structure spleen = liver;
  spleen.name = "Spleen";
  set.structures = {spleen, liver};
  const roi::ContourStack back = roiFromStructures(set);
  EXPECT_EQ(back.name, "Whole LIVER");
  EXPECT_EQ(back.frameOfReferenceUid, "1.2");
  EXPECT_EQ(back.seriesUid, "1.3");
  ASSERT_EQ(back.polygons.size(), 2u);
  EXPECT_EQ(back.polygons[1].points_lps_mm, s.polygons[1].points_lps_mm);
  EXPECT_EQ(roiFromStructures(set, "spleen").name, "Spleen");
  try {
    roiFromStructures(set, "kidney");
    FAIL();
  } catch (const BadInput& why) {
    EXPECT_THAT(why.what(), HasSubstr("number 1 'Spleen' (2 contours), number 1 'Whole LIVER' (2 contours)"));
  }
  set.structures = {liver, liver};
  EXPECT_THROW(roiFromStructures(set), BadInput);
  set.structures[1].number = 4;
  set.structures[1].contours.pop_back();
  EXPECT_EQ(roiFromStructures(set, {}, 4).polygons.size(), 1u);
  EXPECT_EQ(roiFromStructures(set, "#1").polygons.size(), 2u);
  EXPECT_THROW(roiFromStructures(set, {}, 2), BadInput);
  set.structures[0].contours.clear();
  Diagnostics said;
  EXPECT_EQ(roiFromStructures(set, "whole liver", 0, &said).polygons.size(), 1u);
  EXPECT_TRUE(said.contains(DiagnosticCode::EmptyTwins));
  set.structures = {spleen, spleen};
  EXPECT_THROW(roiFromStructures(set), BadInput);
  set.structures = {spleen};
  EXPECT_EQ(roiFromStructures(set).name, "Spleen");
  set.structures[0].contours[0].points_lps_mm.conservativeResize(3, 2);
  EXPECT_EQ(roiFromStructures(set).polygons.size(), 1u);
  set.structures[0].contours.clear();
  EXPECT_THROW(roiFromStructures(set), BadInput);
}

}  // namespace
}  // namespace glisson::elastography
