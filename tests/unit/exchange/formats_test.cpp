// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "bodies.h"
#include "exchange/markups.h"
#include "exchange/mesh_files.h"
#include "exchange/seg_nrrd.h"
#include "exchange/system_matrices.h"
#include "exchange/tidy_csv.h"
#include "image/io.h"
#include "roi/polygon.h"
#include "support/support.h"

namespace glisson::exchange {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;
using testing_bodies::lBody;
using testing_bodies::oblique;
using testing_bodies::readText;

/// Signed volume of a hexahedron in VTK's order, by its six tetrahedra.
double volumeOf(const HexMesh& m, Eigen::Index c) {
  const int tets[6][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
  double volume = 0.0;
  for (const auto& t : tets) {
    const auto p = [&](int n) { return Eigen::Vector3d(m.nodes_lps_mm.col(m.hexes(n, c))); };
    volume += (p(t[1]) - p(t[0])).cross(p(t[2]) - p(t[0])).dot(p(t[3]) - p(t[0])) / 6.0;
  }
  return volume;
}

TEST(MeshFiles, cellsAreNeverInsideOut) {
  Eigen::Matrix3d flipped = oblique();
  flipped.col(2) *= -1.0;
  for (const Eigen::Matrix3d& axes : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), oblique(), flipped}) {
    const retraction::Model model = lBody(axes);
    const HexMesh mesh = hexMeshOf(model, nullptr);
    ASSERT_EQ(static_cast<std::size_t>(mesh.hexes.cols()), model.cells);
    double total = 0.0;
    for (Eigen::Index c = 0; c < mesh.hexes.cols(); ++c) {
      EXPECT_NEAR(volumeOf(mesh, c), 120.0, 1e-9);
      total += volumeOf(mesh, c);
    }
    EXPECT_NEAR(total, 1e3 * model.volume_mL, 1e-6);
  }
}

TEST(MeshFiles, numbersLieWhereTheHeaderSaysAndTheFrameIsNamed) {
  const TemporaryFolder folder;
  const HexMesh mesh = hexMeshOf(lBody(oblique()), nullptr);
  writeVtu(folder / "b.vtu", mesh);
  const std::string text = readText(folder / "b.vtu");
  EXPECT_THAT(text, HasSubstr("points in mm, LPS"));
  EXPECT_THAT(text, Not(HasSubstr("\"String\"")));  // a text array: meshio knows none
  EXPECT_THAT(text, HasSubstr("Name=\"E_kPa\""));
  const std::size_t data = text.find("<AppendedData encoding=\"raw\">\n_") + 31;
  const std::size_t name = text.find("Name=\"Points\"");
  const std::size_t offset = std::stoul(text.substr(text.find("offset=\"", name) + 8));
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, text.data() + data + offset, 8);
  ASSERT_EQ(bytes, static_cast<std::uint64_t>(mesh.nodes_lps_mm.size()) * sizeof(double));
  Eigen::Matrix3Xd back(3, mesh.nodes_lps_mm.cols());
  std::memcpy(back.data(), text.data() + data + offset + 8, bytes);
  EXPECT_EQ(back, mesh.nodes_lps_mm);
  anatomy::TriangleMesh triangle;
  triangle.vertices_lps_mm = Eigen::Matrix3d::Identity();
  triangle.triangles.resize(3, 1);
  triangle.triangles << 0, 1, 2;
  writeVtp(folder / "s.vtp", triangle, {});
  EXPECT_THAT(readText(folder / "s.vtp"), AllOf(HasSubstr("Name=\"SPACE\""), HasSubstr("76 80 83 0")));
}

TEST(SegNrrd, readsBackAsTheSameMaskInTheSamePlace) {
  const TemporaryFolder folder;
  const image::Mask mask = test::letterF();
  writeSegNrrd(folder / "f.seg.nrrd", {{"liver", mask}});
  const image::Mask back = image::readMask(folder / "f.seg.nrrd", 1);
  EXPECT_TRUE(back.grid.sameGeometry(mask.grid, 1e-9));
  EXPECT_EQ(back.values, mask.values);
  writeSegNrrd(folder / "two.seg.nrrd", {{"a", mask}, {"b", mask}});
  const std::string header = readText(folder / "two.seg.nrrd");
  EXPECT_THAT(header, HasSubstr("dimension: 4"));
  EXPECT_THAT(header, HasSubstr("Segment1_Layer:=1"));
}

TEST(Markups, readBackAsTheSamePolygons) {
  roi::ContourStack contours = roi::contoursOf(test::letterF());
  contours.polygons[0].exclude = true;
  const roi::ContourStack back = markupsToContours(contoursToMarkups(contours));
  ASSERT_EQ(back.polygons.size(), contours.polygons.size());
  for (std::size_t n = 0; n < back.polygons.size(); ++n) {
    EXPECT_EQ(back.polygons[n].points_lps_mm, contours.polygons[n].points_lps_mm);
    EXPECT_EQ(back.polygons[n].exclude, contours.polygons[n].exclude);
  }
}

TEST(TidyCsv, quotesAndKeepsSpreadsheetsFromComputing) {
  const std::string text = tidyCsv({{"=1+1", "a,b", "1", "li\"ver", "mu", "mean", 2.5, "kPa"}});
  EXPECT_THAT(text, HasSubstr("\r\n'=1+1,\"a,b\",1,\"li\"\"ver\",mu,mean,2.5,kPa\r\n"));
}

TEST(System, loadsAreInThePatientsAxes) {
  const TemporaryFolder folder;
  const retraction::Model model = lBody(oblique());
  retraction::Setup setup;
  setup.poisson = 0.4;
  setup.loads.push_back(retraction::BodyForce{{1.0, -2.0, 3.0}});
  setup.supports.push_back({retraction::SupportSpec::Kind::Fixed, retraction::SurfaceRegion{"all"}});
  const auto files = writeSystem(folder.path(), model, setup);
  EXPECT_EQ(files.size(), 5U);
  std::istringstream in(readText(folder / "f.mtx"));
  std::string line;
  while (std::getline(in, line) && line[0] == '%') {
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double value = 0.0;
  for (int n = 0; in >> value; ++n) sum[n % 3] += value;
  EXPECT_LT((sum - 1e-6 * model.volume_mL * Eigen::Vector3d(1.0, -2.0, 3.0)).norm(), 1e-15);
}

}  // namespace
}  // namespace glisson::exchange
