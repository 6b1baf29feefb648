// SPDX-License-Identifier: GPL-3.0-or-later
#include "comparison/difference.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/order_statistics.h"
#include "retraction/contact_path.h"

namespace glisson::comparison {
namespace {

double mean(const std::vector<double>& v) {
  double sum = 0.0;
  for (const double x : v) sum += x;
  return v.empty() ? 0.0 : sum / static_cast<double>(v.size());
}

double percentile95(std::vector<double> v) {
  return v.empty() ? 0.0 : percentile(v, 0.95);
}

double largest(const std::vector<double>& v) {
  return v.empty() ? 0.0 : *std::max_element(v.begin(), v.end());
}

/// A mean that weighs.
struct WeightedMean {
  double sum = 0.0, weight = 0.0;
  void add(double value, double w) {
    sum += w * value;
    weight += w;
  }
  double value() const { return weight > 0.0 ? sum / weight : 0.0; }
};

/// In the bar's window at rest: under its length and diameter, looking against the hoist, within 30 mm of it.
bool inWindow(const retraction::RigidContact& c, std::size_t sample) {
  constexpr double depth_mm = 30.0;
  const Eigen::Vector3d &a = c.bar_mm.front(), &b = c.bar_mm.back();
  const Eigen::Vector3d axis = (b - a).normalized(), d = c.sample_mm[sample] - 0.5 * (a + b);
  return std::abs(d.dot(axis)) <= 0.5 * (b - a).norm() && std::abs(d.dot(c.hoist.cross(axis))) <= c.barRadius_mm &&
         std::abs(d.dot(c.hoist)) <= depth_mm;
}

void compareContacts(const retraction::RigidContact& a, const retraction::RigidContact& b, Difference& d) {
  if (a.sample_mm.size() != b.sample_mm.size())
    throw BadArgument("compare: the two retractions were made on different surfaces");
  WeightedMean under, window, pressed;
  for (std::size_t i = 0; i < a.sample_mm.size(); ++i) {
    const double apart_mm = (a.sample_u_mm[i] - b.sample_u_mm[i]).norm(), area = a.sample_mm2[i];
    if (a.pressure_kPa[i] > 0.0 || b.pressure_kPa[i] > 0.0) under.add(apart_mm, area);
    pressed.add(apart_mm, area * (a.pressure_kPa[i] + b.pressure_kPa[i]));
    if (inWindow(a, i)) window.add(apart_mm, area);
  }
  d.at_retractor_mm = under.value();
  d.window_at_rest_mm = window.value();
  d.contact_mean_mm = pressed.value();
  d.travel_mm = a.travel_mm - b.travel_mm;
  // Where both have travelled alike, the answers themselves say it.
  constexpr double alike_mm = 1e-6;
  if (std::abs(*d.travel_mm) < alike_mm) {
    d.equal_lift = {a.travel_mm, a.force_N.dot(a.hoist), b.force_N.dot(b.hoist), false};
    return;
  }
  // At the smaller of the two travels one answer bears its own force; the other's is on the way there.
  const double lift_mm = std::min(a.travel_mm, b.travel_mm);
  d.equal_lift = {lift_mm, retraction::answersForceAt(a, lift_mm), retraction::answersForceAt(b, lift_mm), true};
}

}  // namespace

Difference compare(const retraction::Model& model, const retraction::Result& a, const retraction::Result& b,
                   const std::vector<Eigen::Vector3d>& landmarks_mm, Length significant) {
  if (a.nodal_u_m.cols() != b.nodal_u_m.cols() || a.u_mm.values.size() != b.u_mm.values.size())
    throw BadArgument("compare: the two retractions were made on different meshes");
  Difference d;
  std::vector<double> body;
  body.reserve(model.cells);
  for (std::size_t i = 0; i < a.u_mm.values.size(); ++i)
    if (model.youngs_kPa.values[i] > 0)
      body.push_back(static_cast<double>((a.u_mm.values[i] - b.u_mm.values[i]).norm()));
  d.mean_mm = mean(body);
  d.p95_mm = percentile95(body);
  d.max_mm = largest(body);

  std::vector<double> contact;
  for (const int node : a.contactNodes) contact.push_back(1e3 * (a.nodal_u_m.col(node) - b.nodal_u_m.col(node)).norm());
  d.at_retractor_mm = mean(contact);
  if (a.contact && b.contact) compareContacts(*a.contact, *b.contact, d);
  d.clinically_significant = (contact.empty() && !a.contact ? d.max_mm : d.at_retractor_mm) >= significant.mm();

  if (!landmarks_mm.empty()) {
    const std::vector<Eigen::Vector3d> ua = retraction::displacementAt(model, a, landmarks_mm);
    const std::vector<Eigen::Vector3d> ub = retraction::displacementAt(model, b, landmarks_mm);
    std::vector<double> inside;
    for (std::size_t i = 0; i < ua.size(); ++i) {
      d.vessel_mm.push_back((ua[i] - ub[i]).norm());
      if (std::isfinite(d.vessel_mm.back())) inside.push_back(d.vessel_mm.back());
    }
    d.vesselMean_mm = mean(inside);
    d.vesselP95_mm = percentile95(inside);
    d.vesselMax_mm = largest(inside);
    const auto beyond = std::count_if(inside.begin(), inside.end(), [&](double x) { return x >= significant.mm(); });
    if (!inside.empty()) d.vesselFractionBeyond = static_cast<double>(beyond) / static_cast<double>(inside.size());
  }
  return d;
}

}  // namespace glisson::comparison
