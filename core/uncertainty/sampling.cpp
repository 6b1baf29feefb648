// SPDX-License-Identifier: GPL-3.0-or-later
#include "uncertainty/sampling.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "base/random.h"

namespace glisson::uncertainty {
namespace {

using Eigen::Index;

constexpr std::size_t chunk = 128;   ///< places
constexpr int drawsOverCells = 400;  ///< of which the mean over the cells is made
constexpr int drawsOfSource = 500;
constexpr int drawsOfMap = 1000;  ///< of which the probability at every cell is made: ± .016 at one half

double squared(double v) {
  return v * v;
}

double sdOf(const Eigen::VectorXd& v) {
  return v.size() > 1 ? std::sqrt((v.array() - v.mean()).square().sum() / static_cast<double>(v.size() - 1)) : 0.0;
}

/// The middle 95 % of the values.
Interval middleOf(Eigen::VectorXd v) {
  std::sort(v.begin(), v.end());
  const auto at = [&](double share) {
    return v[std::clamp<Index>(static_cast<Index>(std::floor(share * static_cast<double>(v.size()))), 0, v.size() - 1)];
  };
  return {at(0.025), at(0.975)};
}

/// Of lengths about the one at hand: the middle 95 % joined with its reflection at that. Near nothing, draws of a
/// vector are nearly all longer than it is, though it may as well be what they are taken for.
Interval aboutLength(Eigen::VectorXd v, double here) {
  const Interval middle = middleOf(std::move(v));
  return {std::max(0.0, std::min(middle.low, 2 * here - middle.high)), std::max(middle.high, 2 * here - middle.low)};
}

double shareBeyond(const Eigen::VectorXd& v) {
  return static_cast<double>((v.array() >= defaults::clinicallySignificant.mm()).count()) /
         static_cast<double>(v.size());
}

/// The middle 95 % of figures between two values, joined with the figure at hand.
Interval withHere(const Interval& middle, double here) {
  return {std::min(middle.low, here), std::max(middle.high, here)};
}

/// Standard normal draws, columns of the gain by draws, the fields' part scaled as Student's t; and further ones.
struct Draws {
  Eigen::MatrixXf z;
  Eigen::MatrixXd further;  ///< six per further error: a direction of three for places, one each for the figures

  Draws(const FirstOrder& first, std::size_t errors, int count, std::uint64_t seed)
      : z(static_cast<Index>(first.kind.size()), count), further(static_cast<Index>(6 * errors), count) {
    Random random(seed);
    const auto fields = static_cast<Index>(first.fields);
    for (Index d = 0; d < count; ++d) {
      for (Index k = 0; k < z.rows(); ++k) z(k, d) = static_cast<float>(random.normal());
      double squares = 0;
      for (Index k = 0; k < fields; ++k) squares += squared(random.normal());
      if (fields > 0) z.col(d).head(fields) *= static_cast<float>(std::sqrt(static_cast<double>(fields) / squares));
      for (Index k = 0; k < further.rows(); ++k) further(k, d) = random.normal();
    }
  }
};

/// What the further errors add to the differences in every draw, mm: the same everywhere, and per mm of a place's
/// spread.
struct Shift {
  Eigen::MatrixXf everywhere, ofSpread;  ///< 3 × draws
};

/// Lengths of the differences at places [begin, end) in every draw: places × draws, mm.
class Lengths {
 public:
  explicit Lengths(const FirstOrder& first)
      : base_(first.measured - first.textbook), gain_(first.measuredGain - first.textbookGain) {}

  /// shift: or null.
  Eigen::MatrixXf of(std::size_t begin, std::size_t end, const Eigen::MatrixXf& z, const Shift* shift) const {
    const auto from = static_cast<Index>(3 * begin), rows = static_cast<Index>(3 * (end - begin));
    Eigen::MatrixXf d = gain_.middleRows(from, rows) * z;
    d.colwise() += base_.segment(from, rows);
    Eigen::MatrixXf lengths(rows / 3, z.cols());
    for (Index p = 0; p < rows / 3; ++p) {
      const float spread = gain_.middleRows(from + 3 * p, 3).norm();
      for (Index s = 0; s < z.cols(); ++s) {
        Eigen::Vector3f v = d.col(s).segment<3>(3 * p);
        if (shift != nullptr) v += shift->everywhere.col(s) + spread * shift->ofSpread.col(s);
        lengths(p, s) = v.norm();
      }
    }
    return lengths;
  }
  double atBase(std::size_t place) const {
    return static_cast<double>(base_.segment<3>(static_cast<Index>(3 * place)).norm());
  }

 private:
  Eigen::VectorXf base_;
  Eigen::MatrixXf gain_;
};

/// Σ weight × length over places [first, first + weights) in every draw.
Eigen::VectorXd weighted(const Lengths& lengths, std::size_t first, std::size_t count,
                         const std::vector<double>* weights, const Eigen::MatrixXf& z) {
  const std::size_t chunks = (count + chunk - 1) / chunk;
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(z.cols(), static_cast<Index>(chunks));
  parallelChunks(count, chunk, [&](std::size_t begin, std::size_t end) {
    const Eigen::MatrixXf l = lengths.of(first + begin, first + end, z, nullptr);
    Eigen::VectorXd w = Eigen::VectorXd::Ones(l.rows());
    for (Index p = 0; weights != nullptr && p < l.rows(); ++p) w[p] = (*weights)[begin + static_cast<std::size_t>(p)];
    sums.col(static_cast<Index>(begin / chunk)) = l.cast<double>().transpose() * w;
  });
  return sums.rowwise().sum();
}

Eigen::VectorXd atRetractor(const FirstOrder& first, const Lengths& lengths, const Eigen::MatrixXf& z) {
  const std::vector<double>& w = first.places.sample_mm2;
  const double area = std::accumulate(w.begin(), w.end(), 0.0);
  if (!(area > 0)) return Eigen::VectorXd::Zero(z.cols());
  return weighted(lengths, first.places.landmark.size(), w.size(), &w, z) / area;
}

Eigen::VectorXd meanOf(const FirstOrder& first, const Lengths& lengths, const Eigen::MatrixXf& z) {
  const std::size_t begin = first.places.landmark.size() + first.places.sample.size();
  return weighted(lengths, begin, first.places.cells, nullptr, z) / static_cast<double>(first.places.cells);
}

/// Root mean square length of the rows' error, places by places, of columns that `takes` names.
Eigen::VectorXd lengthsOfGain(const Eigen::MatrixXf& gain, std::size_t places) {
  Eigen::VectorXd sd(static_cast<Index>(places));
  for (Index p = 0; p < sd.size(); ++p) sd[p] = std::sqrt(static_cast<double>(gain.middleRows(3 * p, 3).squaredNorm()));
  return sd;
}

/// The draws with all columns but those of one kind at 0.
Eigen::MatrixXf only(const FirstOrder& first, SourceKind kind, const Eigen::MatrixXf& z) {
  Eigen::MatrixXf out = z.leftCols(std::min<Index>(z.cols(), drawsOfSource));
  for (std::size_t k = 0; k < first.kind.size(); ++k)
    if (first.kind[k] != kind) out.row(static_cast<Index>(k)).setZero();
  return out;
}

std::vector<SourceSpread> sourcesOf(const FirstOrder& first, const Lengths* lengths, const Eigen::MatrixXf& z) {
  std::vector<SourceSpread> out;
  for (std::size_t k = 0; k < first.kind.size(); ++k) {
    if (k > 0 && first.kind[k] == first.kind[k - 1]) continue;
    SourceSpread s;
    s.kind = first.kind[k];
    double vessels = 0, travel = 0;
    const auto landmarks = static_cast<Index>(first.places.landmark.size());
    for (std::size_t c = 0; c < first.kind.size(); ++c) {
      if (first.kind[c] != s.kind) continue;
      const auto column = static_cast<Index>(c);
      vessels += static_cast<double>(first.measuredGain.col(column).head(3 * landmarks).squaredNorm());
      travel += squared(first.travelGain[column] - (lengths != nullptr ? first.textbookTravelGain[column] : 0.0));
    }
    s.travel_sd_mm = std::sqrt(travel);
    s.vessels_sd_mm = landmarks > 0 ? std::sqrt(vessels / static_cast<double>(landmarks)) : 0.0;
    s.sd_mm = s.vessels_sd_mm;
    if (lengths != nullptr) {
      const Eigen::MatrixXf own = only(first, s.kind, z);
      s.sd_mm = sdOf(atRetractor(first, *lengths, own));
      s.mean_sd_mm = sdOf(meanOf(first, *lengths, own.leftCols(std::min<Index>(own.cols(), 100))));
    }
    out.push_back(s);
  }
  return out;
}

Shift shiftOf(const std::vector<FurtherErrors>& further, const Draws& draws) {
  Shift shift{Eigen::MatrixXf::Zero(3, draws.z.cols()), Eigen::MatrixXf::Zero(3, draws.z.cols())};
  for (std::size_t e = 0; e < further.size(); ++e) {
    const Eigen::MatrixXf directions =
        (draws.further.middleRows(static_cast<Index>(6 * e), 3) / std::sqrt(3.0)).cast<float>();
    shift.everywhere += static_cast<float>(further[e].difference_mm) * directions;
    shift.ofSpread += static_cast<float>(further[e].difference) * directions;
  }
  return shift;
}

Eigen::VectorXd shifted(Eigen::VectorXd figure, const std::vector<FurtherErrors>& further, const Draws& draws,
                        double FurtherErrors::*error, Index which) {
  for (std::size_t e = 0; e < further.size(); ++e)
    figure +=
        further[e].*error * draws.further.row(static_cast<Index>(6 * e) + 3 + which).head(figure.size()).transpose();
  return figure;
}

/// What the landmarks' differences are together, draw by draw: chunks of them, added up.
struct Together {
  Eigen::MatrixXf largest, sum, beyond;  ///< draws × chunks
  Together(Index draws, std::size_t chunks)
      : largest(Eigen::MatrixXf::Zero(draws, static_cast<Index>(chunks))), sum(largest), beyond(largest) {}
  void add(std::size_t which, const Eigen::MatrixXf& lengths) {
    const auto at = static_cast<Index>(which);
    largest.col(at) = lengths.colwise().maxCoeff().transpose();
    sum.col(at) = lengths.colwise().sum().transpose();
    const auto line = static_cast<float>(defaults::clinicallySignificant.mm());
    beyond.col(at) = (lengths.array() >= line).cast<float>().colwise().sum().transpose();
  }
};

VesselHeadline vesselsOf(const Lengths& lengths, const Together& together, const std::vector<LandmarkSpread>& each) {
  VesselHeadline h;
  const auto count = static_cast<double>(each.size());
  double mean = 0, beyond = 0;
  std::size_t furthest = 0;
  for (std::size_t l = 0; l < each.size(); ++l) {
    const double here = lengths.atBase(l);
    mean += here / count;
    beyond += here >= defaults::clinicallySignificant.mm() ? 1 / count : 0.0;
    if (here <= h.furthest_mm) continue;
    h.furthest_mm = here;
    furthest = l;
  }
  h.mean_mm = aboutLength(together.sum.rowwise().sum().cast<double>() / count, mean);
  h.max_mm = aboutLength(together.largest.rowwise().maxCoeff().cast<double>(), h.furthest_mm);
  h.beyond = withHere(middleOf(together.beyond.rowwise().sum().cast<double>() / count), beyond);
  h.furthest = each[furthest].landmark;
  h.furthest95_mm = each[furthest].difference95_mm.value();
  h.furthestBeyond = each[furthest].beyond.value();
  return h;
}

void addLandmarks(const FirstOrder& first, const std::vector<FurtherErrors>& further, const Lengths* lengths,
                  const Draws& draws, Spread& out) {
  const std::size_t count = first.places.landmark.size();
  double place_mm2 = 0, place = 0;
  for (const FurtherErrors& f : further) place_mm2 += squared(f.place_mm), place += squared(f.place);
  const auto total = [&](double spread_mm) { return std::sqrt((1 + place) * squared(spread_mm) + place_mm2); };
  const Eigen::VectorXd sd = lengthsOfGain(first.measuredGain, count);
  out.landmarks.resize(count);
  for (std::size_t l = 0; l < count; ++l) {
    out.landmarks[l].landmark = first.places.landmark[l];
    out.landmarks[l].sd_mm = total(sd[static_cast<Index>(l)]);
    const Eigen::MatrixXd gain =
        first.toLps * first.measuredGain.middleRows(static_cast<Index>(3 * l), 3).cast<double>();
    // Further errors have no direction of their own.
    out.landmarks[l].place_mm2 = gain * gain.transpose() + (place_mm2 + place * squared(sd[static_cast<Index>(l)])) /
                                                               3 * Eigen::Matrix3d::Identity();
  }
  if (lengths == nullptr) return;
  const Eigen::VectorXd other = lengthsOfGain(first.textbookGain, count);
  const Shift shift = shiftOf(further, draws);
  const std::size_t chunks = (count + chunk - 1) / chunk;
  Together together(draws.z.cols(), chunks);
  parallelChunks(count, chunk, [&](std::size_t begin, std::size_t end) {
    const Eigen::MatrixXf d = lengths->of(begin, end, draws.z, &shift);
    together.add(begin / chunk, d);
    for (std::size_t l = begin; l < end; ++l) {
      const Eigen::VectorXd one = d.row(static_cast<Index>(l - begin)).transpose().cast<double>();
      LandmarkSpread& s = out.landmarks[l];
      s.textbook_sd_mm = total(other[static_cast<Index>(l)]);
      s.difference_sd_mm = sdOf(one);
      s.difference95_mm = aboutLength(one, lengths->atBase(l));
      s.beyond = shareBeyond(one);
    }
  });
  if (count > 0) out.headline->vessels = vesselsOf(*lengths, together, out.landmarks);
}

/// What each source alone does to the difference at one landmark, by its place among those that are followed.
void addFurthest(const FirstOrder& first, const std::vector<FurtherErrors>& further, const Lengths& lengths,
                 const Draws& draws, std::size_t landmark, std::vector<SourceSpread>& sources) {
  const auto ofOne = [&](const Eigen::MatrixXf& z, const Shift* shift) {
    return sdOf(lengths.of(landmark, landmark + 1, z, shift).row(0).transpose().cast<double>());
  };
  const std::size_t own = sources.size() - further.size();
  for (std::size_t s = 0; s < own; ++s)
    sources[s].furthest_sd_mm = ofOne(only(first, sources[s].kind, draws.z), nullptr);
  const Eigen::MatrixXf none = Eigen::MatrixXf::Zero(draws.z.rows(), draws.z.cols());
  for (std::size_t e = 0; e < further.size(); ++e) {
    std::vector<FurtherErrors> alone(further.size());
    alone[e] = further[e];
    const Shift shift = shiftOf(alone, draws);
    sources[own + e].furthest_sd_mm = ofOne(none, &shift);
  }
}

/// The probability of 5 mm at every cell, of all sources together.
std::vector<float> beyondPerCell(const FirstOrder& first, const std::vector<FurtherErrors>& further,
                                 const Lengths& lengths, const Draws& draws) {
  const std::size_t begin = first.places.landmark.size() + first.places.sample.size();
  const Index few = std::min<Index>(drawsOfMap, draws.z.cols());
  const Eigen::MatrixXf z = draws.z.leftCols(few);
  Shift shift = shiftOf(further, draws);
  shift.everywhere.conservativeResize(3, few);
  shift.ofSpread.conservativeResize(3, few);
  const auto line = static_cast<float>(defaults::clinicallySignificant.mm());
  std::vector<float> beyond(first.places.cells);
  parallelChunks(beyond.size(), chunk, [&](std::size_t from, std::size_t to) {
    const Eigen::MatrixXf l = lengths.of(begin + from, begin + to, z, &shift);
    for (Index c = 0; c < l.rows(); ++c)
      beyond[from + static_cast<std::size_t>(c)] =
          static_cast<float>((l.row(c).array() >= line).count()) / static_cast<float>(few);
  });
  return beyond;
}

}  // namespace

Figures figuresOf(const Places& places, const Eigen::VectorXf& measured, const Eigen::VectorXf& textbook) {
  Figures f;
  const Eigen::VectorXf d = measured - textbook;
  const auto length = [&](std::size_t p) {
    return static_cast<double>(d.segment<3>(static_cast<Index>(3 * p)).norm());
  };
  const std::size_t landmarks = places.landmark.size(), samples = places.sample.size();
  double area = 0;
  for (std::size_t s = 0; s < samples; ++s) {
    f.at_retractor_mm += places.sample_mm2[s] * length(landmarks + s);
    area += places.sample_mm2[s];
  }
  if (area > 0) f.at_retractor_mm /= area;
  for (std::size_t c = 0; c < places.cells; ++c) f.mean_mm += length(landmarks + samples + c);
  if (places.cells > 0) f.mean_mm /= static_cast<double>(places.cells);
  return f;
}

Spread sampled(const FirstOrder& first, const std::vector<FurtherErrors>& further, int count, std::uint64_t seed) {
  Spread out;
  const Draws draws(first, further.size(), count, seed);
  std::optional<Lengths> lengths;
  if (first.textbook.size() > 0) {
    lengths.emplace(first);
    Headline& h = out.headline.emplace();
    const Eigen::VectorXd there =
        shifted(atRetractor(first, *lengths, draws.z), further, draws, &FurtherErrors::at_retractor_mm, 0).cwiseAbs();
    const Figures here = figuresOf(first.places, first.measured, first.textbook);
    h.at_retractor_mm = aboutLength(there, here.at_retractor_mm);
    h.beyond = shareBeyond(there);
    const Eigen::MatrixXf few = draws.z.leftCols(std::min<Index>(drawsOverCells, draws.z.cols()));
    const Eigen::VectorXd mean =
        shifted(meanOf(first, *lengths, few), further, draws, &FurtherErrors::mean_mm, 1).cwiseAbs();
    h.mean_mm = aboutLength(mean, here.mean_mm);
    h.withinVoxel =
        static_cast<double>((mean.array() <= defaults::mriVoxel.mm()).count()) / static_cast<double>(mean.size());
    const Eigen::VectorXd travel =
        ((first.travelGain - first.textbookTravelGain).transpose() * draws.z.cast<double>()).transpose().array() +
        (first.travel_mm - first.textbookTravel_mm);
    const Eigen::VectorXd travelled = shifted(travel, further, draws, &FurtherErrors::travel_mm, 2);
    h.travel_mm = middleOf(travelled);
    h.travelBeyond = shareBeyond(travelled.cwiseAbs());
    out.cellBeyond = beyondPerCell(first, further, *lengths, draws);
  }
  addLandmarks(first, further, lengths ? &*lengths : nullptr, draws, out);
  out.sources = sourcesOf(first, lengths ? &*lengths : nullptr, draws.z);
  double spread_mm2 = 0;
  const auto landmarks = static_cast<Index>(first.places.landmark.size());
  if (landmarks > 0)
    spread_mm2 =
        static_cast<double>(first.measuredGain.topRows(3 * landmarks).squaredNorm()) / static_cast<double>(landmarks);
  for (const FurtherErrors& f : further) {
    const double vessels_mm = std::sqrt(squared(f.place_mm) + squared(f.place) * spread_mm2);
    out.sources.push_back({f.kind, lengths ? f.at_retractor_mm : vessels_mm, f.mean_mm, f.travel_mm, vessels_mm, 0.0});
  }
  if (lengths && out.headline->vessels) {
    const auto& all = first.places.landmark;
    const auto at = std::find(all.begin(), all.end(), out.headline->vessels->furthest);
    addFurthest(first, further, *lengths, draws, static_cast<std::size_t>(at - all.begin()), out.sources);
  }
  return out;
}

}  // namespace glisson::uncertainty
