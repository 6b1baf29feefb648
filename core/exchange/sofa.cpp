// SPDX-License-Identifier: GPL-3.0-or-later
#include "exchange/sofa.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "exchange/detail/matrices.h"
#include "exchange/detail/sofa_scene.h"
#include "exchange/text_file.h"
#include "mechanics/tet_mesh.h"

namespace glisson::exchange {
namespace detail {
namespace {

constexpr double mPerMm = 1e-3;
constexpr double mNPerN = 1e3;
constexpr double kPaPerPa = 1e-3;

/// Grid axis → the patient axis it runs along and its sign; throws where the grid is oblique.
std::array<int, 3> patientAxes(const retraction::Body& body, const std::string& what) {
  std::array<int, 3> axes{};
  for (int a = 0; a < 3; ++a) {
    Eigen::Index along = 0;
    if (body.vectorToLps(Eigen::Vector3d::Unit(a)).cwiseAbs().maxCoeff(&along) < 1.0 - 1e-6)
      throw BadInput(what +
                     " on an oblique grid has no counterpart in SOFA: hold all axes, or let springs act in "
                     "every direction");
    axes[static_cast<std::size_t>(a)] = static_cast<int>(along);
  }
  return axes;
}

void addHexahedra(const retraction::Body& body, bool mirrored, SofaScene& scene) {
  // VTK's order of a hexahedron: once round the bottom, once round the top. A left-handed grid swaps the two.
  constexpr std::array<int, 8> round = {0, 1, 3, 2, 4, 5, 7, 6};
  const mechanics::VoxelMesh& mesh = body.mesh();
  for (int c = 0; c < mesh.cellCount(); ++c) {
    const std::array<int, 8> corners = mesh.nodesOf(c);
    std::vector<int> nodes(8);
    for (std::size_t a = 0; a < 8; ++a) nodes[a] = corners[static_cast<std::size_t>(round[mirrored ? (a + 4) % 8 : a])];
    scene.elements.push_back(std::move(nodes));
    const Eigen::Vector3i at = mesh.cellOf(c);
    scene.youngs_kPa.push_back(kPaPerPa * body.voxels().E_Pa[body.voxels().cell(at.x(), at.y(), at.z())]);
  }
}

void addTetrahedra(const retraction::Body& body, bool mirrored, SofaScene& scene) {
  const mechanics::TetMesh tets = mechanics::tetrahedra(body.voxels(), body.mesh());
  for (int t = 0; t < tets.tetCount(); ++t) {
    std::vector<int> nodes(4);
    for (int a = 0; a < 4; ++a) nodes[static_cast<std::size_t>(a)] = tets.tets(a, t);
    if (mirrored) std::swap(nodes[0], nodes[1]);
    scene.elements.push_back(std::move(nodes));
    scene.youngs_kPa.push_back(kPaPerPa * tets.E_Pa[t]);
  }
}

/// Every corner of a cell carries an eighth of it.
std::vector<double> nodalMass_kg(const retraction::Body& body) {
  const mechanics::VoxelMesh& mesh = body.mesh();
  std::vector<double> mass(static_cast<std::size_t>(mesh.nodeCount()), 0.0);
  const double share = body.voxels().density_kg_m3 * mesh.h_m().prod() / 8.0;
  for (int c = 0; c < mesh.cellCount(); ++c)
    for (const int node : mesh.nodesOf(c)) mass[static_cast<std::size_t>(node)] += share;
  return mass;
}

std::vector<SofaHeld> heldNodes(const retraction::Body& body, const mechanics::Supports& supports) {
  std::vector<SofaHeld> groups;
  for (const mechanics::Fixation& f : supports.fixations) {
    SofaHeld held;
    if (f.axis[0] && f.axis[1] && f.axis[2]) {
      held.axis = f.axis;
    } else {
      const std::array<int, 3> axes = patientAxes(body, "a support that holds single axes");
      for (std::size_t a = 0; a < 3; ++a) held.axis[static_cast<std::size_t>(axes[a])] = f.axis[a];
    }
    held.displacement_mm = body.vectorToLps(f.value_m) / mPerMm;
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const SofaHeld& g) {
      return g.axis == held.axis && g.displacement_mm == held.displacement_mm;
    });
    if (same == groups.end()) {
      held.nodes = {f.node};
      groups.push_back(std::move(held));
    } else {
      same->nodes.push_back(f.node);
    }
  }
  return groups;
}

std::vector<SofaSprings> springs(const retraction::Body& body, const mechanics::Supports& supports) {
  std::map<int, Eigen::Matrix3d> perNode;
  for (const mechanics::Spring& s : supports.springs)
    perNode.try_emplace(s.node, Eigen::Matrix3d::Zero()).first->second += s.k_N_m;
  // N/m and mN/mm are the same number.
  SofaSprings every{{true, true, true}, {}, {}};
  std::array<SofaSprings, 3> single;
  for (std::size_t a = 0; a < 3; ++a) single[a].axis[a] = true;
  for (const auto& [node, k] : perNode) {
    const double size = k.cwiseAbs().maxCoeff();
    if ((k - k(0, 0) * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= 1e-12 * size) {
      every.nodes.push_back(node);
      every.stiffness_mN_mm.push_back(k(0, 0));
      continue;
    }
    const std::array<int, 3> axes = patientAxes(body, "a spring that resists along the surface normal");
    for (std::size_t a = 0; a < 3; ++a) {
      const double stiffness = k(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(a));
      if (stiffness <= 0.0) continue;
      SofaSprings& group = single[static_cast<std::size_t>(axes[a])];
      group.nodes.push_back(node);
      group.stiffness_mN_mm.push_back(stiffness);
    }
  }
  std::vector<SofaSprings> out;
  if (!every.nodes.empty()) out.push_back(std::move(every));
  for (SofaSprings& s : single)
    if (!s.nodes.empty()) out.push_back(std::move(s));
  return out;
}

std::string loadName(const retraction::LoadSpec& load) {
  constexpr std::array<const char*, 4> names = {"body_force", "traction", "pressure", "hoist"};
  return names[load.index()];
}

std::vector<SofaLoad> loads(const retraction::Body& body, const retraction::Setup& setup,
                            const retraction::MechanicsScene& mechanics) {
  std::vector<SofaLoad> out;
  for (std::size_t i = 0; i < mechanics.loads_N.size(); ++i) {
    SofaLoad load;
    load.name = loadName(setup.loads[i]) + (mechanics.loads_N.size() > 1 ? std::to_string(i + 1) : "");
    const mechanics::NodalField& f = mechanics.loads_N[i];
    for (Eigen::Index n = 0; n < f.cols(); ++n) {
      if (f.col(n).isZero(0.0)) continue;
      load.nodes.push_back(static_cast<int>(n));
      load.force_mN.push_back(mNPerN * body.vectorToLps(f.col(n)));
    }
    if (!load.nodes.empty()) out.push_back(std::move(load));
  }
  return out;
}

void noteDifferences(const retraction::Setup& setup, SofaScene& scene) {
  using retraction::ModelKind;
  if (setup.model.kind == ModelKind::Meshfree)
    scene.notes.push_back(
        "SOFA has no such mesh-free model: the node carries the hexahedra that it was projected from");
  if (setup.model.kind == ModelKind::FemTet && setup.model.quadraticTets)
    scene.notes.push_back("SOFA's tetrahedra are linear: the node carries the corners of the quadratic ones");
  if (setup.model.kind == ModelKind::FemHex && setup.model.element != mechanics::HexElement::H8)
    scene.notes.push_back(
        "SOFA's hexahedra are plain, fully integrated ones, which are too stiff in bending and as Poisson's ratio "
        "nears "
        "0.5: compare with the element H8 of this project; K.mtx holds the scene's own element");
  if (setup.analysis.dynamic && setup.analysis.scheme != mechanics::TimeScheme::ImplicitEuler)
    scene.notes.push_back(std::string("the scene moves by ") + mechanics::nameOf(setup.analysis.scheme) +
                          "; the node takes implicit Euler steps, which damp the motion more");
  if (setup.kinematics == retraction::Kinematics::Hyperelastic)
    scene.notes.push_back("the scene is neo-Hookean; the node uses SOFA's corotational elements (method polar)");
}

}  // namespace

SofaScene sofaScene(const retraction::Body& body, const retraction::Model& model, const retraction::Setup& setup,
                    const retraction::MechanicsScene& mechanics, const SofaLandmarks& landmarks,
                    const SofaOptions& options) {
  if (model.poisson < 0.0)
    throw BadInput("SOFA takes Poisson's ratios from 0 to below 0.5; this scene has " + std::to_string(model.poisson));
  SofaScene scene;
  scene.tetrahedra = setup.model.kind == retraction::ModelKind::FemTet;
  for (int n = 0; n < body.mesh().nodeCount(); ++n) scene.points_mm.push_back(body.nodePosition_mm(n));
  const bool mirrored = model.youngs_kPa.grid.direction.determinant() < 0.0;
  if (scene.tetrahedra)
    addTetrahedra(body, mirrored, scene);
  else
    addHexahedra(body, mirrored, scene);
  scene.mass_kg = nodalMass_kg(body);
  scene.poisson = model.poisson;
  scene.method = setup.kinematics == retraction::Kinematics::Linear ? "small" : "polar";
  scene.held = heldNodes(body, mechanics.problem.supports);
  scene.springs = springs(body, mechanics.problem.supports);
  scene.loads = loads(body, setup, mechanics);
  scene.landmarks = landmarks;
  if (setup.analysis.dynamic) {
    scene.dt_s = 1e-3 * setup.analysis.h_ms;
    scene.steps = std::max(1, static_cast<int>(std::lround(setup.analysis.end_s / scene.dt_s)));
    scene.rayleighMass_1_s = setup.analysis.rayleigh[0];
    scene.rayleighStiffness_s = setup.analysis.rayleigh[1];
  } else {
    scene.dt_s = options.dt_s;
    scene.steps = options.steps;
    scene.rayleighStiffness_s = options.rayleighStiffness_s;
  }
  noteDifferences(setup, scene);
  return scene;
}

}  // namespace detail

SofaExport writeSofa(const std::filesystem::path& folder, const retraction::Model& model,
                     const retraction::Setup& asked, const SofaLandmarks& landmarks, const SofaOptions& options) {
  const retraction::Setup setup = retraction::exportable(asked);
  const retraction::Body body(model);
  const retraction::MechanicsScene mechanics = retraction::toMechanics(body, model, setup);
  detail::SofaScene scene = detail::sofaScene(body, model, setup, mechanics, landmarks, options);
  SofaExport out;
  const auto write = [&](const char* name, const std::string& text) {
    writeTextFile(folder / name, text);
    out.files.push_back(folder / name);
  };
  const std::size_t dofs = 3 * scene.points_mm.size();
  const bool matrices = dofs <= options.matrixDofLimit;
  scene.matrices = matrices;
  if (!matrices)
    scene.notes.push_back("K.mtx and M.mtx are left out above " + std::to_string(options.matrixDofLimit) +
                          " degrees of freedom (this body has " + std::to_string(dofs) +
                          "); export the scene to \"mtx\" to have them");
  write("retraction.scn", detail::sofaExample(scene));
  write("liver_node.xml", detail::sofaNode(scene, false, ""));
  write("liver.vtk", detail::sofaMesh(scene));
  if (!landmarks.points_lps_mm.empty()) write("vessels.vtk", detail::sofaLandmarkMesh(landmarks));
  if (matrices) {
    for (const std::filesystem::path& file : writeMatrices(folder, body, setup.model.element))
      out.files.push_back(file);
    for (const std::filesystem::path& file : writeSpringMatrix(folder, body, mechanics.problem.supports))
      out.files.push_back(file);
  }
  write("README.txt", detail::sofaReadme(scene));
  out.notes = scene.notes;
  return out;
}

}  // namespace glisson::exchange
