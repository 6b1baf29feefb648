// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/ligaments.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "base/error.h"

namespace glisson::retraction {
namespace {

constexpr double mmToM = 1e-3;
constexpr double sheets = 2.0;  ///< of peritoneum in a fold

LigamentFibres ligamentOf(const Body& body, const SupportSpec& support) {
  const LigamentSpec& spec = support.ligament;
  LigamentFibres out;
  out.name = spec.name;
  std::map<int, double> area_m2;
  double whole_m2 = 0.0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const SurfaceFace* f : body.faces(support.region)) {
    for (const int node : f->nodes) area_m2[node] += 0.25 * f->area_m2;
    whole_m2 += f->area_m2;
    normal += f->area_m2 * f->normal;
  }
  if (!spec.towards && normal.norm() < 0.1 * whole_m2)
    throw BadInput("the region of the " + nameOf(spec.name) + " ligament (" + Body::name(support.region) +
                   ") looks into all directions: say with \"towards\" where the ligament springs from");
  const Eigen::Vector3d towards = body.vectorToLocal(spec.towards.value_or(normal.normalized()));

  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9), high = -low;
  for (const auto& [node, area] : area_m2) {
    const Eigen::Vector3d p = body.mesh().position_m(node);
    const Eigen::Vector3d across = p - p.dot(towards) * towards;
    low = low.cwiseMin(across);
    high = high.cwiseMax(across);
  }
  out.width_mm = (high - low).maxCoeff() / mmToM;
  out.estimated = !spec.stiffness_N_per_mm;
  out.stiffness_N_per_mm = spec.stiffness_N_per_mm
                               ? *spec.stiffness_N_per_mm
                               : sheets * Capsule{}.tension_N_per_mm * out.width_mm / spec.length_mm;
  for (const auto& [node, area] : area_m2) {
    mechanics::Tether t;
    t.p_m = body.mesh().position_m(node);
    t.anchor_m = t.p_m + mmToM * spec.length_mm * towards;
    t.length_m = mmToM * (spec.length_mm + spec.slack_mm);
    t.k_N_m = out.stiffness_N_per_mm / mmToM * area / whole_m2;
    t.twoSided = spec.twoSided;
    out.fibres.push_back(t);
  }
  return out;
}

constexpr std::array<std::pair<LigamentName, const char*>, 5> names = {
    {{LigamentName::Falciform, "falciform"},
     {LigamentName::Coronary, "coronary"},
     {LigamentName::LeftTriangular, "left-triangular"},
     {LigamentName::RightTriangular, "right-triangular"},
     {LigamentName::Other, "other"}}};

}  // namespace

std::string nameOf(LigamentName name) {
  const auto* entry = std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.first == name; });
  if (entry == names.end()) throw BadArgument("a ligament without a name");
  return entry->second;
}

std::vector<LigamentFibres> ligamentsOf(const Body& body, const Setup& setup) {
  std::vector<LigamentFibres> all;
  for (const SupportSpec& s : setup.supports)
    if (s.kind == SupportSpec::Kind::Ligament) all.push_back(ligamentOf(body, s));
  return all;
}

Diagnostics estimatesOf(const std::vector<LigamentFibres>& ligaments) {
  Diagnostics said;
  for (const LigamentFibres& l : ligaments)
    if (l.estimated)
      said.add(DiagnosticCode::LigamentEstimated,
               {{"name", nameOf(l.name)},
                {"stiffness_N_per_mm", l.stiffness_N_per_mm},
                {"width_mm", l.width_mm},
                {"length_mm", (l.fibres.front().anchor_m - l.fibres.front().p_m).norm() / mmToM}});
  return said;
}

std::vector<LigamentPull> pullsOf(const Body& body, const std::vector<LigamentFibres>& ligaments,
                                  const std::vector<Eigen::Vector3d>& fibre_N) {
  std::vector<LigamentPull> pulls;
  std::size_t next = 0;
  for (const LigamentFibres& l : ligaments) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < l.fibres.size() && next < fibre_N.size(); ++i) sum += fibre_N[next++];
    pulls.push_back({l.name, l.stiffness_N_per_mm, body.vectorToLps(sum)});
  }
  return pulls;
}

}  // namespace glisson::retraction
