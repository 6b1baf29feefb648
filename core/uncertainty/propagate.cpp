// SPDX-License-Identifier: GPL-3.0-or-later
#include "uncertainty/propagate.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/random.h"
#include "uncertainty/columns.h"

namespace glisson::uncertainty {
namespace {

using Eigen::Index;
using mechanics::Change;

constexpr double mmToM = 1e-3;
constexpr double tellFrom = 0.3;  ///< share missed by the first order from which a diagnostic says so
/// Where bar or surface move, the unbalance is contact forces that nearly cancel (Equilibrium::respond).
constexpr double contactTolerance = 1e-6;

bool movesContact(const Change& c) {
  return c.outward_m != 0 || !c.barShift_m.isZero(0) || !c.barTurn_rad.isZero(0);
}

/// All sources of one case, pushed through the tangents of its two livers.
class Propagation {
 public:
  Propagation(const Case& patient, const Options& options, std::uint64_t seed, const Progress& progress)
      : case_(patient), options_(options), seed_(seed), progress_(progress) {}

  Uncertainty run() {
    measured_ = std::make_unique<OneStiffness>(case_.measured, case_.setup);
    if (case_.textbook) textbook_ = std::make_unique<OneStiffness>(*case_.textbook, case_.setup);
    columns_ = columnsOf(*measured_, textbook_.get(), case_, options_, seed_);
    first_.places = measured_->places(case_.landmarks_mm, case_.textbook ? &*case_.textbook : nullptr);
    first_.fields = static_cast<std::size_t>(std::count_if(
        columns_.begin(), columns_.end(), [](const Column& c) { return c.kind == SourceKind::ElastogramNoise; }));
    for (const Column& c : columns_) first_.kind.push_back(c.kind);
    out_.fields = static_cast<int>(first_.fields);
    first_.toLps = measured_->toLps();
    first_.measured = measured_->displacements(first_.places);
    first_.travel_mm = case_.measured.result.contact->travel_mm;
    if (textbook_) {
      first_.textbook = textbook_->displacements(first_.places);
      first_.textbookTravel_mm = case_.textbook->result.contact->travel_mm;
    }
    const double half = textbook_ ? 0.6 : 0.75;
    if (!push(*measured_, false, 0.0, half, first_.measuredGain, first_.travelGain)) return out_;
    if (textbook_ && !push(*textbook_, true, half, 0.75, first_.textbookGain, first_.textbookTravelGain)) return out_;
    out_.leverage = measured_->leverage(headline(), first_.places);
    ++out_.solves;
    const std::vector<FurtherErrors> further = furtherErrors();
    progress_.report(0.95, "draws of all sources");
    out_.spread = sampled(first_, further, options_.draws, seed_ + 77);
    if (textbook_) out_.beyond = measured_->onGrid(out_.spread.cellBeyond);
    out_.tip = tipOf(first_, out_.spread, case_.tips);
    double noise = case_.elastogram ? case_.elastogram->noise : 0.0;
    for (const SourceSpread& s : out_.spread.sources) out_.words.push_back(wordsOf(s.kind, options_.spreads, noise));
    out_.known = true;
    return out_;
  }

 private:
  bool push(OneStiffness& liver, bool textbook, double from, double to, Eigen::MatrixXf& gain,
            Eigen::VectorXd& travel) {
    const auto columns = static_cast<Index>(columns_.size());
    gain = Eigen::MatrixXf::Zero(static_cast<Index>(3 * first_.places.count()), columns);
    travel = Eigen::VectorXd::Zero(columns);
    mechanics::Equilibrium& at = liver.equilibrium();
    for (Index k = 0; k < columns; ++k) {
      progress_.report(from + (to - from) * static_cast<double>(k) / static_cast<double>(columns),
                       textbook ? "sources, textbook stiffness" : "sources, measured stiffness");
      const Column& c = columns_[static_cast<std::size_t>(k)];
      // What the two solvers left over has nothing to do with each other: a column each.
      const bool solver = c.kind == SourceKind::Solver;
      if (solver && (k + 1 == columns) != textbook && textbook_) continue;
      if (textbook && !solver && !c.textbook) continue;
      const Change& change = textbook && c.textbook ? *c.textbook : c.measured;
      const mechanics::EquilibriumMotion m =
          solver
              ? at.respond(at.left(), options_.tolerance)
              : at.respond(at.by(change), std::min(options_.tolerance, movesContact(change) ? contactTolerance : 1.0));
      ++out_.solves;
      out_.iterations += m.iterations;
      if (!m.found) {
        out_.why =
            std::string("the equilibrium with the ") + (textbook ? "textbook" : "measured") +
            " stiffness is at the edge of what bears: its tangent is not positive, and the smallest change of the "
            "sources may make the bar slip or the body snap";
        out_.diagnostics.add(DiagnosticCode::UncertaintyUnknown,
                             {{"stiffness", std::string(textbook ? "textbook" : "measured")}});
        return false;
      }
      gain.col(k) = liver.displacements(first_.places, m);
      travel[k] = m.travel_m / mmToM;
    }
    return true;
  }

  /// The difference at the retractor, the mean length over the samples under the bar, to first order in the measured
  /// liver's motion; without a comparison the travel of the bar.
  mechanics::MotionWeights headline() const {
    mechanics::MotionWeights w;
    if (!textbook_) {
      w.travel = 1;
      return w;
    }
    const Places& places = first_.places;
    w.surface = Eigen::Matrix3Xd::Zero(3, static_cast<Index>(measured_->problem().surface.size()));
    double area = 0;
    for (const double a : places.sample_mm2) area += a;
    for (std::size_t i = 0; i < places.sample.size(); ++i) {
      const auto at = static_cast<Index>(3 * (places.landmark.size() + i));
      const Eigen::Vector3d apart = (first_.measured.segment<3>(at) - first_.textbook.segment<3>(at)).cast<double>();
      if (apart.norm() > 0)
        w.surface.col(static_cast<Index>(places.sample[i])) = places.sample_mm2[i] / area * apart.normalized();
    }
    return w;
  }

  /// What the first order says of a draw, on the nodes of the problem: solved once more for their sum, loosely.
  std::optional<Eigen::VectorXf> inFull(OneStiffness& liver, const Change& change, double& travel_mm) {
    mechanics::Equilibrium& at = liver.equilibrium();
    const mechanics::EquilibriumMotion guess = at.respond(at.by(change), 1e-2);
    mechanics::EquilibriumMotion m =
        at.afterwards(change, guess.found ? &guess : nullptr, 1e-5, progress_.part(0.75, 0.95));
    out_.solves += 1;
    if (!m.found) m = liver.fromRest(change, progress_.part(0.75, 0.95));
    if (!m.found) return {};
    travel_mm = m.travel_m / mmToM;
    return liver.displacements(first_.places, m);
  }

  /// rms length over the landmarks, or over the cells where there are none; of a gain that of what it spreads.
  double lengthOf(const Eigen::Ref<const Eigen::MatrixXf>& d) const {
    const std::size_t landmarks = first_.places.landmark.size(), all = first_.places.count();
    const std::size_t begin = landmarks > 0 ? 0 : all - first_.places.cells,
                      count = landmarks > 0 ? landmarks : all - begin;
    if (count == 0) return 0.0;
    const auto part = d.middleRows(static_cast<Index>(3 * begin), static_cast<Index>(3 * count));
    return std::sqrt(static_cast<double>(part.squaredNorm()) / static_cast<double>(count));
  }

  /// One draw of all sources in full; what it adds to the errors of the first order.
  Check check(std::uint64_t draw, FurtherErrors& missed) {
    Random random(seed_ + 1000 + draw);
    Eigen::VectorXd z(static_cast<Index>(columns_.size()));
    for (double& v : z) v = random.normal();
    for (std::size_t k = 0; k < columns_.size(); ++k)
      if (columns_[k].kind == SourceKind::Solver) z[static_cast<Index>(k)] = 0;
    Check c;
    double travel_mm = 0, otherTravel_mm = 0;
    const auto own = inFull(*measured_, sumOf(columns_, z, false), travel_mm);
    if (!own) return c;
    const Eigen::VectorXf firstOwn = first_.measuredGain * z.cast<float>();
    const Eigen::VectorXf missedOwn = *own - firstOwn;
    Eigen::VectorXf missedDifference = missedOwn;
    if (textbook_) {
      const auto other = inFull(*textbook_, sumOf(columns_, z, true), otherTravel_mm);
      if (!other) return c;
      const Eigen::VectorXf firstOther = first_.textbookGain * z.cast<float>();
      missedDifference -= *other - firstOther;
      const Figures full = figuresOf(first_.places, first_.measured + *own, first_.textbook + *other);
      const Figures order = figuresOf(first_.places, first_.measured + firstOwn, first_.textbook + firstOther);
      c.at_retractor_mm = full.at_retractor_mm;
      c.first_order_mm = order.at_retractor_mm;
      missed.at_retractor_mm = full.at_retractor_mm - order.at_retractor_mm;
      missed.mean_mm = full.mean_mm - order.mean_mm;
      missed.travel_mm = travel_mm - otherTravel_mm - z.dot(first_.travelGain - first_.textbookTravelGain);
    }
    c.found = true;
    c.change_mm = lengthOf(*own);
    c.missed_mm = lengthOf(missedOwn);
    const auto share = [&](double missed_mm, const Eigen::MatrixXf& gain) {
      const double spread_mm = lengthOf(gain);
      return spread_mm > 0 ? missed_mm / spread_mm : 0.0;
    };
    missed.place = share(c.missed_mm, first_.measuredGain);
    if (textbook_) missed.difference = share(lengthOf(missedDifference), first_.measuredGain - first_.textbookGain);
    return c;
  }

  std::vector<FurtherErrors> furtherErrors() {
    std::vector<FurtherErrors> further = case_.further;
    FurtherErrors sum{SourceKind::BeyondFirstOrder};
    double change = 0, missed = 0;
    int found = 0;
    for (int i = 0; i < options_.checks; ++i) {
      progress_.report(0.75 + 0.2 * i / options_.checks, "a draw in full");
      FurtherErrors one;
      const Check c = check(static_cast<std::uint64_t>(i), one);
      out_.checks.push_back(c);
      if (!c.found) continue;
      ++found;
      change += c.change_mm * c.change_mm;
      missed += c.missed_mm * c.missed_mm;
      for (double FurtherErrors::*e :
           {&FurtherErrors::place, &FurtherErrors::difference, &FurtherErrors::at_retractor_mm, &FurtherErrors::mean_mm,
            &FurtherErrors::travel_mm})
        sum.*e += one.*e * (one.*e);
    }
    if (found > 0) {
      for (double FurtherErrors::*e :
           {&FurtherErrors::place, &FurtherErrors::difference, &FurtherErrors::at_retractor_mm, &FurtherErrors::mean_mm,
            &FurtherErrors::travel_mm})
        sum.*e = std::sqrt(sum.*e / found);
      further.push_back(sum);
    }
    if (change > 0) out_.missedShare = std::sqrt(missed / change);
    if (out_.missedShare && *out_.missedShare > tellFrom)
      out_.diagnostics.add(DiagnosticCode::UncertaintyNotLinear,
                           {{"percent", 100 * *out_.missedShare}, {"draws", std::int64_t{found}}});
    if (found < options_.checks)
      out_.diagnostics.add(DiagnosticCode::UncertaintyDrawWithoutAnswer,
                           {{"lost", std::int64_t{options_.checks - found}}, {"draws", std::int64_t{options_.checks}}});
    return further;
  }

  const Case& case_;
  const Options& options_;
  const std::uint64_t seed_;
  const Progress& progress_;
  std::unique_ptr<OneStiffness> measured_, textbook_;
  std::vector<Column> columns_;
  FirstOrder first_;
  Uncertainty out_;
};

}  // namespace

Uncertainty propagate(const Case& patient, const Options& options, std::uint64_t seed, const Progress& progress) {
  return Propagation(patient, options, seed, progress).run();
}

}  // namespace glisson::uncertainty
