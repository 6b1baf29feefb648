// SPDX-License-Identifier: GPL-3.0-or-later
#include <sstream>

#include "exchange/detail/sofa_scene.h"
#include "exchange/text_file.h"

namespace glisson::exchange::detail {
namespace {

/// Below this, factorising once per step costs less than the iterations, and is exact.
constexpr std::size_t factorisedNodes = 3000;

template <typename Values, typename Say>
std::string list(const Values& values, const Say& say) {
  std::string out;
  for (const auto& v : values) {
    if (!out.empty()) out += ' ';
    out += say(v);
  }
  return out;
}
std::string list(const std::vector<int>& values) {
  return list(values, [](int v) { return std::to_string(v); });
}
std::string list(const std::vector<double>& values) {
  return list(values, [](double v) { return shortest(v); });
}
std::string inWords(const Eigen::Vector3d& v) {
  return shortest(v.x()) + ' ' + shortest(v.y()) + ' ' + shortest(v.z());
}
std::string flags(const std::array<bool, 3>& axis) {
  return std::string(axis[0] ? "1" : "0") + (axis[1] ? " 1" : " 0") + (axis[2] ? " 1" : " 0");
}
bool all(const std::array<bool, 3>& axis) {
  return axis[0] && axis[1] && axis[2];
}

/// One component per line.
class Lines {
 public:
  Lines(std::ostringstream& out, std::string indent) : out_(out), indent_(std::move(indent)) {}
  void operator()(const std::string& line) { out_ << indent_ << line << '\n'; }

 private:
  std::ostringstream& out_;
  std::string indent_;
};

void plugins(const SofaScene& s, bool example, Lines& line) {
  std::vector<std::string> names = {"IO.Mesh",
                                    "Mass",
                                    "ODESolver.Backward",
                                    "SolidMechanics.FEM.Elastic",
                                    "StateContainer",
                                    "Topology.Container.Constant"};
  names.push_back(s.points_mm.size() <= factorisedNodes ? "LinearSolver.Direct" : "LinearSolver.Iterative");
  if (!s.held.empty()) names.push_back("Constraint.Projective");
  if (!s.springs.empty()) names.push_back("SolidMechanics.Spring");
  if (!s.landmarks.points_lps_mm.empty()) names.push_back("Mapping.Linear");
  if (example) names.insert(names.end(), {"AnimationLoop", "MechanicalLoad", "Playback", "Visual"});
  for (const std::string& n : names) line("<RequiredPlugin pluginName=\"Sofa.Component." + n + "\"/>");
}

void supports(const SofaScene& s, Lines& line) {
  int number = 0;
  for (const SofaHeld& h : s.held) {
    const std::string name = "name=\"held" + std::to_string(++number) + "\" indices=\"" + list(h.nodes) + "\"";
    const bool moved = !h.displacement_mm.isZero(0.0);
    // Moved along a straight line over the first quarter of the run, then held there.
    const std::string movement = " keyTimes=\"0 " + shortest(0.25 * s.dt_s * s.steps) + " 1e9\" movements=\"0 0 0  " +
                                 inWords(h.displacement_mm) + "  " + inWords(h.displacement_mm) + "\"";
    if (!moved && all(h.axis))
      line("<FixedProjectiveConstraint " + name + "/>");
    else if (!moved)
      line("<PartialFixedProjectiveConstraint " + name + " fixedDirections=\"" + flags(h.axis) + "\"/>");
    else if (all(h.axis))
      line("<LinearMovementProjectiveConstraint " + name + movement + "/>");
    else
      line("<PartialLinearMovementProjectiveConstraint " + name + movement + " movedDirections=\"" + flags(h.axis) +
           "\"/>");
  }
  number = 0;
  for (const SofaSprings& spring : s.springs)
    line("<RestShapeSpringsForceField name=\"abdomen" + std::to_string(++number) + "\" points=\"" + list(spring.nodes) +
         "\" stiffness=\"" + list(spring.stiffness_mN_mm) + "\"" +
         (all(spring.axis) ? "" : " activeDirections=\"" + flags(spring.axis) + "\"") + "/>");
}

void bodyOf(const SofaScene& s, Lines& line) {
  line("<EulerImplicitSolver name=\"time\" rayleighStiffness=\"" + shortest(s.rayleighStiffness_s) +
       "\" rayleighMass=\"" + shortest(s.rayleighMass_1_s) + "\"/>");
  // The threshold of SOFA's conjugate gradients is absolute; with its default, tissue in these units never moves.
  line(s.points_mm.size() <= factorisedNodes
           ? "<SparseLDLSolver name=\"linear\" template=\"CompressedRowSparseMatrixMat3x3\"/>"
           : "<CGLinearSolver name=\"linear\" iterations=\"500\" tolerance=\"1e-9\" threshold=\"1e-30\"/>");
  line("<MeshVTKLoader name=\"loader\" filename=\"liver.vtk\"/>");
  line("<MeshTopology name=\"mesh\" src=\"@loader\"/>");
  line("<MechanicalObject name=\"dofs\" template=\"Vec3\" position=\"@loader.position\"/>");
  line("<DiagonalMass name=\"mass\" vertexMass=\"" + list(s.mass_kg) + "\"/>");
  line(std::string("<") + (s.tetrahedra ? "TetrahedronFEMForceField" : "HexahedronFEMForceField") +
       " name=\"elasticity\" youngModulus=\"@loader.youngModulus\" poissonRatio=\"" + shortest(s.poisson) +
       "\" method=\"" + s.method + "\"/>");
}

void vessels(const SofaLandmarks& landmarks, const std::string& indent, std::ostringstream& out) {
  if (landmarks.points_lps_mm.empty()) return;
  out << indent << "<Node name=\"vessels\">\n";
  Lines line(out, indent + "  ");
  line("<MeshVTKLoader name=\"loader\" filename=\"vessels.vtk\"/>");
  line("<MeshTopology name=\"lines\" src=\"@loader\"/>");
  line("<MechanicalObject name=\"points\" template=\"Vec3\" position=\"@loader.position\"/>");
  line("<BarycentricMapping name=\"mapping\" input=\"@../dofs\" output=\"@points\"/>");
  out << indent << "</Node>\n";
}

std::string units() {
  return "Units: mm, kg, s; so stress is in kPa, force in mN, spring stiffness in mN/mm. Points are in LPS "
         "(x to the patient's left, y to posterior, z to superior).";
}

}  // namespace

std::string sofaNode(const SofaScene& s, bool withLoads, const std::string& indent) {
  std::ostringstream out;
  out << indent << "<Node name=\"liver\">\n";
  Lines line(out, indent + "  ");
  if (!withLoads) {
    line("<!-- " + units() + " -->");
    plugins(s, false, line);
  }
  bodyOf(s, line);
  supports(s, line);
  if (withLoads) {
    for (const SofaLoad& l : s.loads)
      line("<ConstantForceField name=\"" + l.name + "\" indices=\"" + list(l.nodes) + "\" forces=\"" +
           list(l.force_mN, inWords) + "\"/>");
    const std::string every = std::to_string(s.steps);
    line(
        "<VTKExporter name=\"deformed\" filename=\"liver_deformed\" position=\"@dofs.position\" XMLformat=\"true\" "
        "edges=\"0\" " +
        std::string(s.tetrahedra ? "tetras" : "hexas") + "=\"1\" exportEveryNumberOfSteps=\"" + every + "\"/>");
    line("<WriteState name=\"positions\" filename=\"liver_positions.txt\" writeX=\"1\" period=\"" +
         shortest(s.dt_s * std::max(1, s.steps / 10)) + "\"/>");
  }
  vessels(s.landmarks, indent + "  ", out);
  out << indent << "</Node>\n";
  return out.str();
}

std::string sofaExample(const SofaScene& s) {
  std::ostringstream out;
  out << "<?xml version=\"1.0\"?>\n<!-- Research use only, not for clinical use.\n     " << units()
      << "\n     Run: runSofa -g batch -n " << s.steps
      << " retraction.scn\n     The load acts from the first step on; after " << s.steps << " steps ("
      << shortest(s.dt_s * s.steps) << " s) "
      << "the last frame of liver_positions.txt and liver_deformed*.vtu hold the result. -->\n";
  out << "<Node name=\"root\" dt=\"" << shortest(s.dt_s) << "\" gravity=\"0 0 0\">\n";
  Lines line(out, "  ");
  plugins(s, true, line);
  line("<VisualStyle displayFlags=\"showForceFields showBehaviorModels\"/>");
  line("<DefaultAnimationLoop/>");
  out << sofaNode(s, true, "  ") << "</Node>\n";
  return out.str();
}

std::string sofaReadme(const SofaScene& s) {
  std::ostringstream out;
  out << "A patient's liver for SOFA. Research use only, not for clinical use.\n\n"
      << units() << "\n\n"
      << "retraction.scn   the whole scene: runSofa -g batch -n " << s.steps << " retraction.scn\n"
      << "liver_node.xml   the node alone; in a scene of your own, beside these files:\n"
      << "                 <include href=\"liver_node.xml\"/>\n"
      << "liver.vtk        " << s.points_mm.size() << " nodes, " << s.elements.size() << ' '
      << (s.tetrahedra ? "tetrahedra" : "hexahedra") << ", one Young's modulus each (youngModulus, kPa)\n";
  if (!s.landmarks.points_lps_mm.empty()) out << "vessels.vtk      vessel centrelines, carried along by the liver\n";
  if (s.matrices)
    out << "K.mtx, M.mtx     stiffness without supports (N/m = mN/mm) and consistent mass (kg), Matrix Market, lower\n"
        << "                 triangle; unknown 3 n + a + 1 is node n of liver.vtk along axis a of LPS\n";
  if (s.matrices && !s.springs.empty()) out << "springs.mtx      the spring supports in the same numbering\n";
  out << "\nMeshVTKLoader warns that the name youngModulus is in use already: that is harmless.\n\n"
      << "When nothing moves:\n"
      << "- CGLinearSolver's threshold is absolute; keep it at 1e-30, with its default soft tissue stays where it is.\n"
      << "- No mass: the nodes of elements that were left out of liver.vtk have none; use the file as it is.\n"
      << "- No support: without a fixation or springs the body drifts instead of deforming.\n"
      << "- No load in the node: liver_node.xml carries none; add a ConstantForceField (mN) as retraction.scn does.\n";
  if (!s.notes.empty()) {
    out << "\nWhere this scene differs from the one it was made from:\n";
    for (const std::string& n : s.notes) out << "- " << n << "\n";
  }
  return out.str();
}

}  // namespace glisson::exchange::detail
