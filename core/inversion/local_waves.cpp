#include "inversion/detail/local_waves.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "base/error.h"
#include "base/parallel.h"
#include "elastography/statistics.h"
#include "image/morphology.h"
#include "inversion/detail/wave_basis.h"

namespace glisson::inversion::detail {
namespace {

using Complex = std::complex<double>;
constexpr double leastCover = 0.4;  // of a window: at a straight border half of it lies inside
constexpr int gridSize = 24;
constexpr double softest = 4.0, stiffest = 0.125;  // q / q0: a fourth to eight times the textbook modulus
constexpr double tapsPerRadius = 8.0;              // more are left out by a stride
constexpr int mostSteps = 6;
constexpr double lossSpread = 0.3;  // prior standard deviation of Im q / Re q: loss tangents of soft tissue

/// Part of a disc of radius 1 that another one at this distance covers: how far the errors of two windows are shared.
double overlap(double distance) {
  if (distance >= 2.0) return 0.0;
  const double half = 0.5 * distance;
  return 2.0 / std::numbers::pi * (std::acos(half) - half * std::sqrt(1.0 - half * half));
}

/// A window's own answer.
struct Window {
  Complex x = 0.0;           ///< q R²; 0: none
  double lossless = 0.0;     ///< the best real one
  double information = 0.0;  ///< |g⊥|²
  double leftOver = 0.0;     ///< |ρ|²
  double samples = 0.0;      ///< taps in the mask × directions
  std::array<Complex, 2> noiseScore{};  ///< g⊥ᴴn of each noise field
  std::vector<std::complex<float>> centre;  ///< ρ in the middle, of each direction
};

class Fitter {
 public:
  Fitter(const Waves& waves, const LocalWaveOptions& o)
      : waves_(waves),
        grid_(waves.grid),
        options_(o),
        basis_(grid_.spacing_mm, o.radius_mm, ordersOf(o), o.affine, strideOf(grid_, o.radius_mm)),
        noises_(std::min<std::size_t>(waves.directions.front().noise.size(), 2)) {
    const double area_mm2 = o.radius_mm * o.radius_mm;
    for (int g = 0; g < gridSize; ++g) {
      const double part = static_cast<double>(g) / (gridSize - 1);
      x_.push_back(area_mm2 * o.q0_mm2 * stiffest * std::pow(softest / stiffest, part));
      values_.push_back(basis_.at(x_.back()));
      const Eigen::HouseholderQR<Eigen::MatrixXd> qr(values_.back());
      orthonormal_.emplace_back(qr.householderQ() * Eigen::MatrixXd::Identity(values_.back().rows(), basis_.columns()));
    }
    findVoxels();
  }

  LocalWaves run(const Progress& progress) {
    const std::vector<float> energy = energies(progress.part(0.0, 0.45));
    windows_.resize(voxels_.size());
    forEach(progress.part(0.45, 0.95), [&](std::size_t n) {
      if (const double start = startingPoint(energy, n); start > 0.0) windows_[n] = refined(n, start);
    });
    return pooled();
  }

 private:
  static int ordersOf(const LocalWaveOptions& o) {
    // J_m(z) falls below a tenth of the wave beyond m = z + 1; all that counts of a textbook wave at the window's rim.
    return std::max(2, static_cast<int>(std::floor(std::sqrt(o.q0_mm2) * o.radius_mm)) + 1);
  }
  static int strideOf(const image::Grid& grid, double radius_mm) {
    return std::max(1, static_cast<int>(std::lround(radius_mm / (tapsPerRadius * grid.spacing_mm.head<2>().maxCoeff()))));
  }

  void findVoxels() {
    index_.assign(waves_.mask.values.size(), -1);
    const auto least = static_cast<std::size_t>(std::ceil(leastCover * static_cast<double>(basis_.taps().size())));
    std::vector<int> taps;
    for (std::size_t v = 0; v < index_.size(); ++v) {
      if (waves_.mask.values[v] == 0) continue;
      tapsInside(v, taps);
      if (taps.size() < least || taps.size() < static_cast<std::size_t>(2 * basis_.columns())) continue;
      index_[v] = static_cast<int>(voxels_.size());
      voxels_.push_back(v);
    }
    if (voxels_.empty())
      throw BadInput("nowhere in the mask is there room for a window of radius " + std::to_string(options_.radius_mm) +
                     " mm; take a smaller window or a larger mask");
    for (int j = -reach().y(); j <= reach().y(); ++j)
      for (int i = -reach().x(); i <= reach().x(); ++i)
        if (grid_.spacing_mm.head<2>().cwiseProduct(Eigen::Vector2d(i, j)).norm() <= options_.averaging_mm * (1 + 1e-9))
          around_.emplace_back(i, j);
  }

  Eigen::Vector2i reach() const {
    return (options_.averaging_mm / grid_.spacing_mm.head<2>().array() + 1e-9).floor().cast<int>();
  }
  Eigen::Vector3i placeOf(std::size_t v) const {
    const auto nx = static_cast<std::size_t>(grid_.size.x()), ny = static_cast<std::size_t>(grid_.size.y());
    return {static_cast<int>(v % nx), static_cast<int>(v / nx % ny), static_cast<int>(v / (nx * ny))};
  }

  /// Numbers of the taps that lie in the mask.
  void tapsInside(std::size_t v, std::vector<int>& taps) const {
    taps.clear();
    const Eigen::Vector3i p = placeOf(v);
    for (std::size_t t = 0; t < basis_.taps().size(); ++t) {
      const Eigen::Vector3i at(p.x() + basis_.taps()[t].x(), p.y() + basis_.taps()[t].y(), p.z());
      if (grid_.contains(at) && waves_.mask.at(at) != 0) taps.push_back(static_cast<int>(t));
    }
  }

  Eigen::VectorXcd gathered(const ComplexVolume& field, std::size_t v, const std::vector<int>& taps) const {
    const Eigen::Vector3i p = placeOf(v);
    Eigen::VectorXcd out(static_cast<Eigen::Index>(taps.size()));
    for (std::size_t n = 0; n < taps.size(); ++n) {
      const Eigen::Vector2i& tap = basis_.taps()[static_cast<std::size_t>(taps[n])];
      out[static_cast<Eigen::Index>(n)] = Complex(field.at(p.x() + tap.x(), p.y() + tap.y(), p.z()));
    }
    return out;
  }

  void forEach(const Progress& progress, const std::function<void(std::size_t)>& body) const {
    parallelChunks(voxels_.size(), 256, [&](std::size_t begin, std::size_t end) {
      progress.check();
      for (std::size_t n = begin; n < end; ++n) body(n);
    });
  }

  /// What is left over at every q of the grid; gridSize values for each window.
  std::vector<float> energies(const Progress& progress) const {
    std::vector<float> energy(voxels_.size() * gridSize);
    forEach(progress, [&](std::size_t n) {
      std::vector<int> taps;
      tapsInside(voxels_[n], taps);
      const bool whole = taps.size() == basis_.taps().size();
      Eigen::MatrixXd data(static_cast<Eigen::Index>(taps.size()),
                           2 * static_cast<Eigen::Index>(waves_.directions.size()));
      for (std::size_t d = 0; d < waves_.directions.size(); ++d) {
        const Eigen::VectorXcd u = gathered(waves_.directions[d].wave, voxels_[n], taps);
        data.col(2 * static_cast<Eigen::Index>(d)) = u.real();
        data.col(2 * static_cast<Eigen::Index>(d) + 1) = u.imag();
      }
      const double all = data.squaredNorm();
      for (std::size_t g = 0; g < gridSize; ++g) {
        double explained = 0.0;
        if (whole) {
          explained = (orthonormal_[g].transpose() * data).squaredNorm();
        } else {
          const Eigen::MatrixXd b = values_[g](taps, Eigen::all);
          Eigen::MatrixXd gram = b.transpose() * b;
          gram.diagonal() *= 1.0 + 1e-10;
          const Eigen::MatrixXd right = b.transpose() * data;
          explained = gram.ldlt().solve(right).cwiseProduct(right).sum();
        }
        energy[n * gridSize + g] = static_cast<float>(std::max(0.0, all - explained));
      }
    });
    return energy;
  }

  /// x where the pooled energy is least; 0 where that is at an end of the grid.
  double startingPoint(const std::vector<float>& energy, std::size_t n) const {
    std::array<double, gridSize> sum{};
    const Eigen::Vector3i p = placeOf(voxels_[n]);
    for (const Eigen::Vector2i& shift : around_) {
      const Eigen::Vector3i at(p.x() + shift.x(), p.y() + shift.y(), p.z());
      if (!grid_.contains(at) || index_[grid_.linear(at)] < 0) continue;
      const auto other = static_cast<std::size_t>(index_[grid_.linear(at)]);
      for (std::size_t g = 0; g < gridSize; ++g) sum[g] += static_cast<double>(energy[other * gridSize + g]);
    }
    const auto best = static_cast<std::size_t>(std::min_element(sum.begin(), sum.end()) - sum.begin());
    return best == 0 || best + 1 == gridSize ? 0.0 : x_[best];
  }

  /// One window's projections at x; moves x, or where at rest fills the window.
  struct Projection {
    Complex score = 0.0;  ///< g⊥ᴴρ
    double information = 0.0, leftOver = 0.0;
    std::vector<Eigen::VectorXcd> rho, g;
  };
  Projection projected(const std::vector<Eigen::VectorXcd>& u, const std::vector<int>& taps, Complex x) const {
    Eigen::MatrixXcd value, slope;
    basis_.at(x, value, slope);
    if (taps.size() != basis_.taps().size()) {
      value = Eigen::MatrixXcd(value(taps, Eigen::all));
      slope = Eigen::MatrixXcd(slope(taps, Eigen::all));
    }
    Eigen::MatrixXcd gram = value.adjoint() * value;
    gram.diagonal() *= 1.0 + 1e-10;
    const Eigen::LDLT<Eigen::MatrixXcd> solver(gram);
    Projection p;
    for (const Eigen::VectorXcd& direction : u) {
      const Eigen::VectorXcd c = solver.solve(value.adjoint() * direction);
      p.rho.push_back(direction - value * c);
      const Eigen::VectorXcd along = slope * c;
      p.g.push_back(along - value * solver.solve(value.adjoint() * along));
      p.score += p.g.back().dot(p.rho.back());
      p.information += p.g.back().squaredNorm();
      p.leftOver += p.rho.back().squaredNorm();
    }
    return p;
  }

  bool within(Complex x) const {
    return x.real() > 0.0 && std::abs(x) > 0.5 * x_.front() && std::abs(x) < 2.0 * x_.back() &&
           std::abs(x.imag()) < x.real() * 2.0;
  }

  /// Gauss-Newton's method from x on; 0 where it leaves the range. p: at the last point but one.
  Complex converged(const std::vector<Eigen::VectorXcd>& u, const std::vector<int>& taps, Complex x, bool lossless,
                    Projection& p) const {
    for (int step = 0; step < mostSteps; ++step) {
      p = projected(u, taps, x);
      if (!(p.information > 0.0)) return 0.0;
      Complex change = p.score / p.information;
      if (lossless) change = change.real();
      const double size = std::abs(change), largest = 0.3 * std::abs(x);
      x += size > largest ? change * (largest / size) : change;
      if (!within(x)) return 0.0;
      if (size < (lossless ? 1e-2 : 1e-4) * std::abs(x)) break;
    }
    return x;
  }

  Window refined(std::size_t n, double start) const {
    std::vector<int> taps;
    tapsInside(voxels_[n], taps);
    std::vector<Eigen::VectorXcd> u;
    for (const Waves::Direction& d : waves_.directions) u.push_back(gathered(d.wave, voxels_[n], taps));
    Projection p;
    const Complex real = converged(u, taps, start, true, p);
    if (real == 0.0) return {};
    const Complex x = converged(u, taps, real, false, p);
    if (x == 0.0) return {};
    Window w;
    w.x = x;
    w.lossless = real.real();
    w.information = p.information;
    w.leftOver = p.leftOver;
    w.samples = static_cast<double>(taps.size() * u.size());
    for (std::size_t m = 0; m < noises_; ++m)
      for (std::size_t d = 0; d < u.size(); ++d)
        w.noiseScore[m] += p.g[d].dot(gathered(waves_.directions[d].noise[m], voxels_[n], taps));
    const auto middle = static_cast<int>(basis_.taps().size() / 2);
    const auto at = std::lower_bound(taps.begin(), taps.end(), middle) - taps.begin();
    for (const Eigen::VectorXcd& rho : p.rho) w.centre.emplace_back(std::complex<float>(rho[at]));
    return w;
  }

  /// How many voxels of what is left over count as one.
  double correlated() const {
    image::Mask counts(grid_);
    for (std::size_t n = 0; n < windows_.size(); ++n) counts.values[voxels_[n]] = windows_[n].x != 0.0 ? 1 : 0;
    double sum = 0.0;
    const std::size_t fields = 2 * waves_.directions.size();
    for (std::size_t f = 0; f < fields; ++f) {
      image::ScalarVolume field(grid_);
      for (std::size_t n = 0; n < windows_.size(); ++n)
        if (windows_[n].x != 0.0) {
          const std::complex<float> rho = windows_[n].centre[f / 2];
          field.values[voxels_[n]] = f % 2 == 0 ? rho.real() : rho.imag();
        }
      sum += elastography::meanUncertainty(field, counts).correlatedVoxels;
    }
    return sum / static_cast<double>(fields);
  }

  /// Standard deviation of a window's q R² from what its fit leaves over; either component has 1/√2 of it.
  double misfitOf(const Window& w, double correlatedTaps) const {
    const double unknowns = static_cast<double>(basis_.columns()) * static_cast<double>(waves_.directions.size()) + 1.0;
    const double freedom = std::max(w.samples / correlatedTaps - unknowns, 1.0);
    return std::sqrt(w.leftOver / (freedom * w.information));
  }

  /// Between the best complex and the best real one: the loss is held to lossSpread as far as the data leave it open.
  static Complex heldToLoss(const Window& w, double misfit) {
    const double prior = lossSpread * w.lossless;
    return w.lossless + (w.x - w.lossless) * prior * prior / (prior * prior + 0.5 * misfit * misfit);
  }

  /// Variance of the mean of windows about one place against that of a single one: their errors are shared by overlap.
  double sharedPart() const {
    double sum = 0.0;
    for (const Eigen::Vector2i& a : around_)
      for (const Eigen::Vector2i& b : around_)
        sum += overlap(grid_.spacing_mm.head<2>().cwiseProduct((a - b).cast<double>()).norm() / options_.radius_mm);
    return sum / static_cast<double>(around_.size() * around_.size());
  }

  LocalWaves pooled() const {
    LocalWaves out;
    out.q_mm2.assign(index_.size(), 0.0);
    out.relativeVariance.assign(index_.size(), 0.0);
    out.correlatedVoxels = correlated();
    const double area_mm2 = options_.radius_mm * options_.radius_mm;
    const double stride = strideOf(grid_, options_.radius_mm), shared = sharedPart();
    const double correlatedTaps = std::max(1.0, out.correlatedVoxels / (stride * stride));
    for (std::size_t n = 0; n < voxels_.size(); ++n) {
      if (windows_[n].x == 0.0) continue;
      const Eigen::Vector3i p = placeOf(voxels_[n]);
      Complex sum = 0.0;
      std::array<Complex, 2> noise{};
      double weight = 0.0, misfit = 0.0;
      for (const Eigen::Vector2i& shift : around_) {
        const Eigen::Vector3i at(p.x() + shift.x(), p.y() + shift.y(), p.z());
        if (!grid_.contains(at) || index_[grid_.linear(at)] < 0) continue;
        const Window& w = windows_[static_cast<std::size_t>(index_[grid_.linear(at)])];
        if (w.x == 0.0) continue;
        const double own = misfitOf(w, correlatedTaps);
        sum += w.information * heldToLoss(w, own);
        weight += w.information;
        misfit += w.information * own;
        for (std::size_t m = 0; m < noises_; ++m) noise[m] += w.noiseScore[m];
      }
      const Complex x = sum / weight;
      double noiseVariance = 0.0;
      for (std::size_t m = 0; m < noises_; ++m)
        noiseVariance += std::norm(noise[m] / weight) / static_cast<double>(noises_);
      out.q_mm2[voxels_[n]] = x / area_mm2;
      out.relativeVariance[voxels_[n]] =
          std::max(noiseVariance, shared * misfit * misfit / (weight * weight)) / std::norm(x);
      ++out.resolved;
    }
    return out;
  }

  const Waves& waves_;
  const image::Grid& grid_;
  LocalWaveOptions options_;
  WaveBasis basis_;
  std::size_t noises_;
  std::vector<double> x_;
  std::vector<Eigen::MatrixXd> values_, orthonormal_;
  std::vector<int> index_;  ///< of each voxel in voxels_, −1: no window
  std::vector<std::size_t> voxels_;
  std::vector<Eigen::Vector2i> around_;
  std::vector<Window> windows_;
};

}  // namespace

LocalWaves fitLocalWaves(const Waves& waves, const LocalWaveOptions& options, const Progress& progress) {
  LocalWaves out = Fitter(waves, options).run(progress);
  progress.report(1.0, "local waves");
  return out;
}

}  // namespace glisson::inversion::detail
