// SPDX-License-Identifier: GPL-3.0-or-later
#include "uncertainty/columns.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/quantity.h"

namespace glisson::uncertainty {
namespace {

using mechanics::Change;

constexpr double mmToM = 1e-3;
constexpr double mostPoisson = 0.4975;

struct Builder {
  OneStiffness& measured;
  OneStiffness* textbook;
  const Case& patient;
  const Options& options;
  std::vector<Column> columns;

  Change blank(OneStiffness& liver, const Retracted& retracted) const {
    Change c;
    c.pivot_m = liver.equilibrium().bar().centre_m();
    c.shearKept = retracted.shearKnown;
    return c;
  }
  /// A source that both livers share; set(change, liver) makes it one standard deviation.
  template <class Set>
  void shared(SourceKind kind, double spread, const Set& set) {
    if (!(spread > 0)) return;
    Column c{kind, blank(measured, patient.measured), {}};
    set(c.measured, measured);
    if (textbook != nullptr) {
      c.textbook = blank(*textbook, *patient.textbook);
      set(*c.textbook, *textbook);
    }
    columns.push_back(std::move(c));
  }
  void elastogram(std::uint64_t seed) {
    if (!patient.elastogram) return;
    const int fields = options.fields;
    for (int i = 0; i < fields && patient.elastogram->noise > 0; ++i) {
      Column c{SourceKind::ElastogramNoise, blank(measured, patient.measured), {}};
      c.measured.logModuli =
          measured.noiseField(*patient.elastogram, options.spreads, seed + static_cast<std::uint64_t>(i));
      for (double& v : c.measured.logModuli) v /= std::sqrt(static_cast<double>(fields));
      columns.push_back(std::move(c));
    }
    if (!(options.spreads.repeatability > 0)) return;
    Column c{SourceKind::ElastogramRepeatability, blank(measured, patient.measured), {}};
    c.measured.logModuli.assign(measured.problem().problem.body.E_Pa.size(), options.spreads.repeatability);
    columns.push_back(std::move(c));
  }
  void body() {
    const Spreads& s = options.spreads;
    // A liver drawn larger weighs more, and is pushed by more where the bar bears its weight.
    const double N_per_m = bearsWeight() ? patient.measured.model.density.kgPerM3() * defaults::gravity_m_s2 : 0.0;
    if (patient.measured.model.smooth)
      shared(SourceKind::Outline, s.outline_mm, [&](Change& c, const OneStiffness& liver) {
        c.outward_m = mmToM * s.outline_mm;
        c.growth_Pa_m = liver.growth_Pa_m();
        c.force_N = N_per_m * liver.surface_m2() * c.outward_m;
      });
    // Two standard deviations up there is still a body that can be compressed.
    const double poisson = std::min(s.poisson, 0.5 * (mostPoisson - patient.measured.model.poisson));
    shared(SourceKind::Poisson, poisson, [&](Change& c, const OneStiffness&) { c.poisson = poisson; });
    const mechanics::ContactProblem& p = measured.problem();
    if (!p.problem.supports.springs.empty() || !p.bed.empty() || !p.tethers.empty())
      shared(SourceKind::Supports, s.supports, [&](Change& c, const OneStiffness&) { c.logSupports = s.supports; });
    if (p.skin || !p.rind_Pa.empty())
      shared(SourceKind::Capsule, s.capsule, [&](Change& c, const OneStiffness&) { c.logSkin = s.capsule; });
  }
  bool bearsWeight() const {
    for (const retraction::LoadSpec& load : patient.setup.loads)
      if (const auto* bar = std::get_if<retraction::Retractor>(&load)) return !bar->force_N && !bar->travel_mm;
    return false;
  }
  void bar() {
    const Spreads& s = options.spreads;
    const std::optional<double> force_N = measured.problem().force_N;
    if (force_N) {
      shared(SourceKind::Force, s.force, [&](Change& c, const OneStiffness&) { c.force_N = s.force * *force_N; });
      if (bearsWeight())
        shared(SourceKind::Density, s.density,
               [&](Change& c, const OneStiffness&) { c.force_N = s.density * *force_N; });
    }
    const Eigen::Vector3d along = measured.along(), hoist = measured.equilibrium().bar().hoist;
    const Eigen::Vector3d across = hoist.cross(along).normalized();
    for (const Eigen::Vector3d& way : {along, across})
      shared(SourceKind::BarPlace, s.barPlace_mm,
             [&](Change& c, const OneStiffness&) { c.barShift_m = mmToM * s.barPlace_mm * way; });
    const double turn_rad = s.barTurn_deg * std::numbers::pi / 180;
    for (const Eigen::Vector3d& about : {hoist, along, across})
      shared(SourceKind::BarDirection, turn_rad,
             [&](Change& c, const OneStiffness&) { c.barTurn_rad = turn_rad * about; });
  }
};

}  // namespace

std::vector<Column> columnsOf(OneStiffness& measured, OneStiffness* textbook, const Case& patient,
                              const Options& options, std::uint64_t seed) {
  Builder b{measured, textbook, patient, options, {}};
  b.elastogram(seed);
  b.body();
  b.bar();
  for (int liver = 0; liver < (textbook != nullptr ? 2 : 1); ++liver) b.columns.push_back({SourceKind::Solver, {}, {}});
  return std::move(b.columns);
}

Change sumOf(const std::vector<Column>& columns, const Eigen::VectorXd& factor, bool textbook) {
  Change sum;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].kind == SourceKind::Solver || (textbook && !columns[k].textbook)) continue;
    const Change& c = textbook ? *columns[k].textbook : columns[k].measured;
    const double f = factor[static_cast<Eigen::Index>(k)];
    if (!c.logModuli.empty()) {
      sum.logModuli.resize(c.logModuli.size(), 0.0);
      for (std::size_t i = 0; i < c.logModuli.size(); ++i) sum.logModuli[i] += f * c.logModuli[i];
    }
    sum.poisson += f * c.poisson;
    sum.logSupports += f * c.logSupports;
    sum.logSkin += f * c.logSkin;
    sum.force_N += f * c.force_N;
    sum.barShift_m += f * c.barShift_m;
    sum.barTurn_rad += f * c.barTurn_rad;
    sum.outward_m += f * c.outward_m;
    if (!c.growth_Pa_m.empty()) sum.growth_Pa_m = c.growth_Pa_m;
    sum.pivot_m = c.pivot_m;
    sum.shearKept = c.shearKept;
  }
  return sum;
}

}  // namespace glisson::uncertainty
