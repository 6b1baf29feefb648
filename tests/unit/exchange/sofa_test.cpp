// SPDX-License-Identifier: GPL-3.0-or-later
#include "exchange/sofa.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <regex>

#include "base/error.h"
#include "bodies.h"
#include "support/support.h"

namespace glisson::exchange {
namespace {

using namespace testing_bodies;
using testing::HasSubstr;

retraction::Setup retractionSetup() {
  retraction::Setup s;
  s.poisson = 0.4;
  retraction::SupportSpec clamp;
  clamp.region = retraction::BoxRegion{Eigen::Vector3d::Constant(-1e3), Eigen::Vector3d(1e3, -21.0, 1e3)};
  s.supports.push_back(clamp);
  retraction::SupportSpec springs;
  springs.kind = retraction::SupportSpec::Kind::Spring;
  springs.region = retraction::SurfaceRegion{"outer"};
  springs.stiffness_kPa_per_mm = 0.2;
  s.supports.push_back(springs);
  s.loads.emplace_back(retraction::BodyForce{Eigen::Vector3d(0.0, 0.0, -10398.6)});
  return s;
}

struct Mesh {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::vector<int>> cells;
  std::vector<int> types;
  std::vector<double> youngs;
};

Mesh readMesh(const std::filesystem::path& file) {
  std::istringstream in(readText(file));
  Mesh m;
  std::string word;
  std::size_t n = 0, size = 0;
  while (in >> word) {
    if (word == "POINTS") {
      in >> n >> word;
      m.points.resize(n);
      for (auto& p : m.points) in >> p.x() >> p.y() >> p.z();
    } else if (word == "CELLS") {
      in >> n >> size;
      m.cells.resize(n);
      for (auto& c : m.cells) {
        in >> size;
        c.resize(size);
        for (int& v : c) in >> v;
      }
    } else if (word == "CELL_TYPES") {
      in >> n;
      m.types.resize(n);
      for (int& t : m.types) in >> t;
    } else if (word == "default") {
      for (double E = 0.0; in >> E;) m.youngs.push_back(E);
    }
  }
  return m;
}

/// Values of an attribute of the component with a name.
std::vector<double> attribute(const std::string& xml, const std::string& name, const std::string& key) {
  const std::regex element("<[A-Za-z]+ name=\"" + name + "\"[^>]*");
  std::smatch found;
  if (!std::regex_search(xml, found, element)) return {};
  const std::string text = found.str();
  const std::size_t at = text.find(' ' + key + "=\"");
  if (at == std::string::npos) return {};
  const std::size_t start = at + key.size() + 3;
  std::istringstream in(text.substr(start, text.find('"', start) - start));
  std::vector<double> out;
  for (double v = 0.0; in >> v;) out.push_back(v);
  return out;
}

double sum(const std::vector<double>& values) {
  double s = 0.0;
  for (const double v : values) s += v;
  return s;
}

/// Six times the volume of the tetrahedron at corner 0 of a hexahedron along its three edges there.
double triple(const Mesh& m, const std::vector<int>& cell, int x, int y, int z) {
  const auto at = [&](int c) { return m.points[static_cast<std::size_t>(cell[static_cast<std::size_t>(c)])]; };
  return (at(x) - at(0)).cross(at(y) - at(0)).dot(at(z) - at(0));
}

class SofaOnGrids : public testing::TestWithParam<int> {
 protected:
  Eigen::Matrix3d direction() const {
    Eigen::Matrix3d d = Eigen::Matrix3d::Identity();
    if (GetParam() == 1) d = oblique();
    if (GetParam() == 2) d(2, 2) = -1.0;  // left-handed: slices stored from the top
    return d;
  }
};

TEST_P(SofaOnGrids, HexahedraAreRightHandedAndFillTheBody) {
  const retraction::Model model = lBody(direction());
  retraction::Setup setup = retractionSetup();
  const test::TemporaryFolder folder;
  writeSofa(folder.path(), model, setup, {});
  const Mesh m = readMesh(folder.path() / "liver.vtk");
  ASSERT_EQ(m.cells.size(), model.cells);
  ASSERT_EQ(m.youngs.size(), model.cells);
  double volume_mm3 = 0.0, modulus = 0.0, expected = 0.0;
  for (std::size_t c = 0; c < m.cells.size(); ++c) {
    EXPECT_EQ(m.types[c], 12);
    const double v = triple(m, m.cells[c], 1, 3, 4);
    EXPECT_NEAR(v, 120.0, 1e-9);
    volume_mm3 += v;
    modulus += m.youngs[c];
  }
  for (const float E : model.youngs_kPa.values) expected += static_cast<double>(E);
  EXPECT_NEAR(volume_mm3, 1e3 * model.volume_mL, 1e-6);
  EXPECT_NEAR(modulus, expected, 1e-9 * expected);
}

TEST_P(SofaOnGrids, CarriesMassForceAndSpringsInItsUnits) {
  const retraction::Model model = lBody(direction());
  const test::TemporaryFolder folder;
  const SofaExport out = writeSofa(folder.path(), model, retractionSetup(), {});
  const std::string xml = readText(folder.path() / "retraction.scn");
  EXPECT_EQ(out.files.front().filename(), "retraction.scn");
  EXPECT_NEAR(sum(attribute(xml, "mass", "vertexMass")), model.mass_kg, 1e-12);
  const std::vector<double> f = attribute(xml, "body_force", "forces");
  ASSERT_EQ(f.size(), 3 * readMesh(folder.path() / "liver.vtk").points.size());
  double fx = 0.0, fz = 0.0;
  for (std::size_t i = 0; i < f.size(); i += 3) {
    fx += f[i];
    fz += f[i + 2];
  }
  EXPECT_NEAR(fz, -1e3 * model.mass_kg * 9.81, 1e-9);
  EXPECT_NEAR(fx, 0.0, 1e-12);
  const retraction::Body body(model);
  double area_mm2 = 0.0;
  for (const retraction::SurfaceFace& s : body.surface()) area_mm2 += 1e6 * s.area_m2;
  EXPECT_NEAR(sum(attribute(xml, "abdomen1", "stiffness")), 0.2 * area_mm2, 1e-9 * area_mm2)
      << "kPa is mN/mm²: 0.2 kPa/mm over an area in mm² is mN/mm";
  EXPECT_EQ(attribute(xml, "held1", "indices").size(), body.nodes(retractionSetup().supports[0].region).size());
}

std::string gridName(const testing::TestParamInfo<int>& grid) {
  constexpr std::array<const char*, 3> names = {"straight", "oblique", "left_handed"};
  return names[static_cast<std::size_t>(grid.param)];
}
INSTANTIATE_TEST_SUITE_P(Grids, SofaOnGrids, testing::Values(0, 1, 2), gridName);

/// What SOFA 26.06 offers: component → its module and those of its data that are used here.
const std::map<std::string, std::pair<std::string, std::vector<std::string>>>& components() {
  static const std::map<std::string, std::pair<std::string, std::vector<std::string>>> known = {
      {"DefaultAnimationLoop", {"AnimationLoop", {}}},
      {"VisualStyle", {"Visual", {"displayFlags"}}},
      {"EulerImplicitSolver", {"ODESolver.Backward", {"rayleighStiffness", "rayleighMass"}}},
      {"SparseLDLSolver", {"LinearSolver.Direct", {"template"}}},
      {"CGLinearSolver", {"LinearSolver.Iterative", {"iterations", "tolerance", "threshold"}}},
      {"MeshVTKLoader", {"IO.Mesh", {"filename"}}},
      {"VTKExporter",
       {"IO.Mesh", {"filename", "position", "XMLformat", "edges", "tetras", "hexas", "exportEveryNumberOfSteps"}}},
      {"MeshTopology", {"Topology.Container.Constant", {"src"}}},
      {"MechanicalObject", {"StateContainer", {"template", "position"}}},
      {"DiagonalMass", {"Mass", {"vertexMass"}}},
      {"HexahedronFEMForceField", {"SolidMechanics.FEM.Elastic", {"youngModulus", "poissonRatio", "method"}}},
      {"TetrahedronFEMForceField", {"SolidMechanics.FEM.Elastic", {"youngModulus", "poissonRatio", "method"}}},
      {"FixedProjectiveConstraint", {"Constraint.Projective", {"indices"}}},
      {"PartialFixedProjectiveConstraint", {"Constraint.Projective", {"indices", "fixedDirections"}}},
      {"LinearMovementProjectiveConstraint", {"Constraint.Projective", {"indices", "keyTimes", "movements"}}},
      {"PartialLinearMovementProjectiveConstraint",
       {"Constraint.Projective", {"indices", "keyTimes", "movements", "movedDirections"}}},
      {"RestShapeSpringsForceField", {"SolidMechanics.Spring", {"points", "stiffness", "activeDirections"}}},
      {"ConstantForceField", {"MechanicalLoad", {"indices", "forces"}}},
      {"WriteState", {"Playback", {"filename", "writeX", "period"}}},
      {"BarycentricMapping", {"Mapping.Linear", {"input", "output"}}}};
  return known;
}

void expectKnownComponents(const std::string& xml) {
  const std::regex element("<([A-Za-z]+)((?: [A-Za-z]+=\"[^\"]*\")*)/?>"), key(" ([A-Za-z]+)=");
  for (std::sregex_iterator it(xml.begin(), xml.end(), element), end; it != end; ++it) {
    const std::string name = (*it)[1], attributes = (*it)[2];
    if (name == "Node" || name == "RequiredPlugin" || name == "include") continue;
    const auto known = components().find(name);
    ASSERT_NE(known, components().end()) << name;
    EXPECT_THAT(xml, HasSubstr("pluginName=\"Sofa.Component." + known->second.first + "\"")) << name;
    for (std::sregex_iterator a(attributes.begin(), attributes.end(), key), none; a != none; ++a) {
      if ((*a)[1] == "name") continue;
      EXPECT_THAT(known->second.second, testing::Contains((*a)[1].str())) << name;
    }
  }
}

TEST(Sofa, UsesOnlyComponentsAndDataThatItHas) {
  retraction::Setup setup = retractionSetup();
  setup.supports[0].axes = {true, false, true};
  retraction::SupportSpec moved;
  moved.region = retraction::BoxRegion{Eigen::Vector3d(-1e3, -9.0, -1e3), Eigen::Vector3d::Constant(1e3)};
  moved.displacement_mm = {0.0, 1.5, 0.0};
  setup.supports.push_back(moved);
  const test::TemporaryFolder folder;
  const SofaLandmarks landmarks{{{12.0, -18.0, 33.0}, {13.0, -18.0, 34.0}}, {{0, 1}}};
  for (const retraction::ModelKind kind : {retraction::ModelKind::FemHex, retraction::ModelKind::FemTet}) {
    setup.model.kind = kind;
    writeSofa(folder.path(), lBody(), setup, landmarks);
    for (const char* file : {"retraction.scn", "liver_node.xml"}) expectKnownComponents(readText(folder.path() / file));
  }
  const std::string xml = readText(folder.path() / "retraction.scn");
  EXPECT_THAT(xml, HasSubstr("fixedDirections=\"1 0 1\""));
  EXPECT_THAT(xml, HasSubstr("movements=\"0 0 0  0 1.5 0  0 1.5 0\""));
  EXPECT_THAT(xml, HasSubstr("<BarycentricMapping"));
}

TEST(Sofa, TetrahedraArePositiveAlsoOnLeftHandedGrids) {
  Eigen::Matrix3d flipped = Eigen::Matrix3d::Identity();
  flipped(0, 0) = -1.0;
  for (const Eigen::Matrix3d& direction : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), flipped}) {
    retraction::Setup setup = retractionSetup();
    setup.model.kind = retraction::ModelKind::FemTet;
    const retraction::Model model = lBody(direction);
    const test::TemporaryFolder folder;
    writeSofa(folder.path(), model, setup, {});
    const Mesh m = readMesh(folder.path() / "liver.vtk");
    EXPECT_EQ(m.cells.size(), 6 * model.cells);
    double volume_mm3 = 0.0;
    for (const auto& c : m.cells) {
      EXPECT_GT(triple(m, c, 1, 2, 3), 0.0);
      volume_mm3 += triple(m, c, 1, 2, 3) / 6.0;
    }
    EXPECT_NEAR(volume_mm3, 1e3 * model.volume_mL, 1e-6);
  }
}

TEST(Sofa, SaysWhatItCannotCarry) {
  retraction::Setup setup = retractionSetup();
  setup.supports[1].normalOnly = true;
  const test::TemporaryFolder folder;
  EXPECT_NO_THROW(writeSofa(folder.path(), lBody(), setup, {}));
  EXPECT_THAT(readText(folder.path() / "retraction.scn"), HasSubstr("activeDirections=\"0 1 0\""));
  try {
    writeSofa(folder.path(), lBody(oblique()), setup, {});
    FAIL() << "springs along the normal of an oblique grid were exported";
  } catch (const BadInput& e) {
    EXPECT_THAT(e.what(), HasSubstr("oblique"));
  }
  SofaOptions small;
  small.matrixDofLimit = 10;
  const SofaExport out = writeSofa(folder.path(), lBody(), setup, {}, small);
  EXPECT_THAT(out.notes, testing::Contains(HasSubstr("K.mtx")));
}

}  // namespace
}  // namespace glisson::exchange
