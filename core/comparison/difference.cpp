#include "comparison/difference.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace glisson::comparison {
namespace {

double mean(const std::vector<double>& v) {
  double sum = 0.0;
  for (const double x : v) sum += x;
  return v.empty() ? 0.0 : sum / static_cast<double>(v.size());
}

/// The value that 95 % of the others do not exceed (nearest rank).
double percentile95(std::vector<double> v) {
  if (v.empty()) return 0.0;
  const auto rank = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(v.size()))) - 1;
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(rank), v.end());
  return v[rank];
}

double largest(const std::vector<double>& v) {
  return v.empty() ? 0.0 : *std::max_element(v.begin(), v.end());
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
  d.clinically_significant = (contact.empty() ? d.max_mm : d.at_retractor_mm) >= significant.mm();

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
