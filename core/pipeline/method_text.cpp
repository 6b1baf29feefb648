// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/detail/method_text.h"

#include "pipeline/detail/record.h"
#include "report/text.h"
#include "retraction/ligaments.h"

namespace glisson::pipeline::detail {
namespace {

using report::number;

std::string inWords(const Eigen::Vector3d& v) {
  return "(" + number(v.x()) + ", " + number(v.y()) + ", " + number(v.z()) + ")";
}

struct RegionInWords {
  std::string operator()(const retraction::FaceRegion& r) const { return "the face " + r.face; }
  std::string operator()(const retraction::SurfaceRegion& r) const { return "the " + r.surface + " surface"; }
  std::string operator()(const retraction::BoxRegion& r) const {
    return "the box from " + inWords(r.low_mm) + " to " + inWords(r.high_mm) + " mm";
  }
  std::string operator()(const retraction::PlaneRegion& r) const {
    return "the plane through " + inWords(r.point_mm) + " mm with normal " + inWords(r.normal);
  }
  std::string operator()(const retraction::MaskRegion&) const { return "what lies in a mask that was given"; }
};

std::string regionInWords(const retraction::Region& region) {
  return std::visit(RegionInWords{}, region);
}

std::string supportInWords(const retraction::SupportSpec& s) {
  const std::string where = regionInWords(s.region);
  if (s.kind == retraction::SupportSpec::Kind::Spring)
    return where + " rests on springs of " + number(s.stiffness_kPa_per_mm) + " kPa/mm (Winkler foundation" +
           (s.unilateral
                ? ", pressing only" +
                      (s.tangential > 0 ? ", " + number(s.tangential) + " of it along the surface" : std::string()) +
                      ")"
            : s.normalOnly ? ", along the surface normal only)"
                           : ")");
  if (s.kind == retraction::SupportSpec::Kind::Ligament)
    return where + " hangs on the " + retraction::nameOf(s.ligament.name) + " ligament (fibres of " +
           number(s.ligament.length_mm) + " mm" +
           (s.ligament.stiffness_N_per_mm ? ", " + number(*s.ligament.stiffness_N_per_mm) + " N/mm" : std::string()) +
           (s.ligament.twoSided ? ")" : ", pulling only)");
  std::string axes;
  for (std::size_t a = 0; a < 3; ++a)
    if (s.axes[a]) axes += std::string(axes.empty() ? "" : ", ") + static_cast<char>('x' + a);
  return where + " is held in " + axes +
         (s.displacement_mm.isZero(0) ? "" : " at a displacement of " + inWords(s.displacement_mm) + " mm");
}

std::string followingInWords(bool follows) {
  return follows ? " that follows its faces as they turn and grow" : "";
}

struct LoadInWords {
  const RunResult& r;
  std::string operator()(const retraction::BodyForce& l) const {
    return "a body force of " + inWords(l.N_per_m3) + " N/m³";
  }
  std::string operator()(const retraction::Traction& l) const {
    return "a traction of " + inWords(l.kPa) + " kPa on " + regionInWords(l.region) + followingInWords(l.follows);
  }
  std::string operator()(const retraction::Pressure& l) const {
    return "a pressure of " + number(l.kPa) + " kPa on " + regionInWords(l.region) + followingInWords(l.follows);
  }
  std::string operator()(const retraction::Retractor& l) const {
    std::string t = "a retractor bar of " + number(l.diameter_mm) + " mm diameter and " + number(l.length_mm) +
                    " mm length along " + inWords(l.patchAxis()) + ", ";
    t += l.at_mm ? "put at " + inWords(*l.at_mm) + " mm" : "put under the inferior right lobe";
    t += ", lifting along " + inWords(l.direction) + " " +
         (l.travel_mm ? "by a travel of " + number(*l.travel_mm) + " mm"
          : l.force_N ? "with " + number(*l.force_N) + " N"
                      : "with the weight of the body");
    if (r.primary.contact)
      t += l.shape == retraction::BarShape::Hook ? "; a rigid bar, bent by 90 degrees, that pushes and does not pull"
                                                 : "; a rigid bar that pushes and does not pull";
    else
      t += l.spread_mm > 0
               ? "; its pressure spreads into the tissue with a standard deviation of " + number(l.spread_mm) + " mm"
               : "; bare bar";
    if (r.primary.contactArea_mm2 > 0)
      t += " (contact " + number(r.primary.contactArea_mm2) + " mm² seen along the hoist)";
    return t + "; no friction";
  }
};

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : "; ") + part;
  return text;
}

std::string bodyInWords(const Scene& scene, const RunResult& r) {
  const GeometrySpec& g = scene.geometry;
  const std::string what = g.kind == GeometrySpec::Kind::Box    ? "a box of " + inWords(g.size_mm) + " mm"
                           : g.kind == GeometrySpec::Kind::Mask ? "a mask of voxels"
                                                                : "the liver as outlined on the MRI";
  return "The body is " + what + ", in " + std::to_string(r.model.cells) + " cells of " +
         inWords(r.model.youngs_kPa.grid.spacing_mm) + " mm: " + number(r.model.volume_mL) + " mL, " +
         number(r.model.mass_kg) + " kg at " + number(scene.setup.density.kgPerM3()) + " kg/m³. ";
}

std::string stiffnessInWords(const Scene& scene, const RunResult& r) {
  const std::string poisson = number(scene.setup.poisson);
  const std::string conversion = "E = 2 (1 + ν) µ";
  std::string t;
  switch (scene.material.kind) {
    case MaterialSpec::Kind::Uniform:
      t = "Its stiffness is " + number(scene.material.value_kPa) + " kPa throughout (" +
          (scene.material.quantity == StiffnessQuantity::Shear ? "shear modulus µ, " + conversion
                                                               : "Young's modulus E") +
          ")";
      break;
    case MaterialSpec::Kind::Map:
      t = std::string("Its stiffness is that of a map, voxel by voxel (") +
          (scene.material.quantity == StiffnessQuantity::Shear ? "shear modulus µ, " + conversion
                                                               : "Young's modulus E") +
          ")";
      break;
    case MaterialSpec::Kind::Mre:
      t = "Its stiffness is measured by MR elastography, voxel by voxel (shear modulus µ, " + conversion +
          "), in the outline mapped from the MRI by patient position";
      if (r.stiffness)
        t += "; voxels with a confidence below " + number(defaults::confidenceThreshold) + " are left out";
      break;
    case MaterialSpec::Kind::Atlas:
      t = "Its stiffness is that of the textbook, µ = " + number(defaults::atlasShear.kPa()) + " kPa (" + conversion +
          ")";
      break;
  }
  return t + "; Poisson's ratio ν = " + poisson + ".";
}

std::string modelInWords(const Scene& scene, const RunResult& r) {
  const retraction::Setup& s = scene.setup;
  std::string t;
  switch (s.model.kind) {
    case retraction::ModelKind::FemHex:
      t = std::string("Voxel finite elements (hexahedra, ") +
          (r.primary.contact                                ? "trilinear with mean dilatation, cut by the surface"
           : s.model.element == mechanics::HexElement::H8   ? "trilinear"
           : s.model.element == mechanics::HexElement::BBar ? "trilinear with mean dilatation"
                                                            : "with nine incompatible modes") +
          ")";
      break;
    case retraction::ModelKind::FemTet:
      t = s.model.quadraticTets ? "Quadratic tetrahedra (T10)" : "Linear tetrahedra (T4)";
      break;
    case retraction::ModelKind::Meshfree:
      t = "A mesh-free model of " + std::to_string(s.model.meshfree.frames) + " frames, order " +
          std::to_string(s.model.meshfree.order);
      break;
  }
  t += ", " + std::to_string(r.primary.dofs) + " degrees of freedom, " + nameOf(r.primary.kinematics) + " kinematics. ";
  if (r.primary.contact && r.primary.kinematics != retraction::Kinematics::Linear)
    t += s.law == mechanics::SolidLaw::Logarithmic
             ? "Material: compressible neo-Hookean, U(J) = -µ ln J + λ/2 (ln J)². "
             : "Material: compressible neo-Hookean, U(J) polynomial in J. ";
  if (r.primary.contact && s.capsule)
    t += "Glisson's capsule of " + number(s.capsule->tension_N_per_mm) +
         " N/mm (Young's modulus times thickness; Umale " + "et al. 2011) " +
         (s.capsule->form == retraction::CapsuleForm::Membrane ? "as a membrane on the surface. "
                                                               : "in the cells below the surface. ");
  if (s.analysis.dynamic)
    t += std::string("Time scheme ") + mechanics::nameOf(s.analysis.scheme) + " with steps of " +
         number(s.analysis.h_ms) + " ms to " + number(s.analysis.end_s) + " s, Rayleigh damping " +
         number(s.analysis.rayleigh[0]) + " 1/s and " + number(s.analysis.rayleigh[1]) + " s (" +
         std::to_string(r.primary.steps) + " steps taken). ";
  else
    t += "Static equilibrium. ";
  return t + "Solver: " + r.primary.solver.kind + ", " + std::to_string(r.primary.solver.iterations) +
         " iterations, relative residual " + number(r.primary.solver.residual, 2) + " (asked for " +
         number(r.primary.solver.tolerance, 2) + ").";
}

}  // namespace

std::vector<std::string> methodText(const Scene& scene, const RunResult& r) {
  std::vector<std::string> text;
  text.push_back(bodyInWords(scene, r) + stiffnessInWords(scene, r));
  std::vector<std::string> supports, loads;
  for (const auto& s : scene.setup.supports) supports.push_back(supportInWords(s));
  for (const auto& l : scene.setup.loads) loads.push_back(std::visit(LoadInWords{r}, l));
  text.push_back((supports.empty() ? "Nothing supports the body. " : "Supports: " + joined(supports) + ". ") +
                 (loads.empty() ? "There is no load." : "Loads: " + joined(loads) + "."));
  text.push_back(modelInWords(scene, r));
  if (scene.compare) {
    const bool shear = scene.compare->quantity == StiffnessQuantity::Shear;
    text.push_back("The comparison is with the same body under the same load and supports, at one textbook " +
                   std::string(shear ? "shear modulus µ = " : "Young's modulus E = ") +
                   number(scene.compare->value_kPa) +
                   " kPa. Differences are distances between the places to which the two move the same tissue; 5 mm and "
                   "more at the retractor count as clinically significant.");
  }
  text.push_back("Points are in the patient's frame (LPS: x to the left, y to posterior, z to superior), millimetres.");
  return text;
}

}  // namespace glisson::pipeline::detail
