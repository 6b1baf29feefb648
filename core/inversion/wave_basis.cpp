#include "inversion/detail/wave_basis.h"

#include <cmath>
#include <map>
#include <sstream>

#include "base/error.h"

namespace glisson::inversion::detail {

WaveBasis::WaveBasis(const Eigen::Vector3d& spacing_mm, double radius_mm, int orders, bool affine, int stride)
    : orders_(orders), affine_(affine ? 3 : 0) {
  const Eigen::Vector2d step_mm = stride * spacing_mm.head<2>();
  const Eigen::Vector2i reach = (radius_mm / step_mm.array() + 1e-9).floor().cast<int>();
  if (reach.minCoeff() < 1) {
    std::ostringstream why;
    why << "a window of radius " << radius_mm << " mm holds fewer than three voxels along an axis (spacing "
        << step_mm.maxCoeff() << " mm); take a larger window";
    throw BadInput(why.str());
  }
  std::map<long long, int> rings;  // by r² in units of 1e-9 R²
  std::vector<Eigen::Vector2d> places;
  for (int j = -reach.y(); j <= reach.y(); ++j)
    for (int i = -reach.x(); i <= reach.x(); ++i) {
      const Eigen::Vector2d p = step_mm.cwiseProduct(Eigen::Vector2d(i, j)) / radius_mm;
      if (p.norm() > 1.0 + 1e-9) continue;
      const auto [found, fresh] = rings.try_emplace(std::llround(1e9 * p.squaredNorm()), static_cast<int>(radii_.size()));
      if (fresh) radii_.push_back(p.norm());
      ring_.push_back(found->second);
      taps_.emplace_back(stride * i, stride * j);
      places.push_back(p);
    }
  const auto n = static_cast<Eigen::Index>(taps_.size());
  angular_.resize(n, 1 + 2 * orders);
  affineValues_.resize(n, affine_);
  for (Eigen::Index t = 0; t < n; ++t) {
    const Eigen::Vector2d& p = places[static_cast<std::size_t>(t)];
    const double angle = std::atan2(p.y(), p.x());
    angular_(t, 0) = 1.0;
    for (int m = 1; m <= orders; ++m) {
      angular_(t, 2 * m - 1) = std::cos(m * angle);
      angular_(t, 2 * m) = std::sin(m * angle);
    }
    if (affine) affineValues_.row(t) << 1.0, p.x(), p.y();
  }
}

template <typename Scalar>
void WaveBasis::fill(Scalar x, Eigen::Matrix<Scalar, -1, -1>& value, Eigen::Matrix<Scalar, -1, -1>* slope) const {
  const auto n = static_cast<Eigen::Index>(taps_.size());
  // ρ^m Σ_j (−xρ²/4)^j m!/(j! (j+m)!), and its derivative by x; at the distinct radii.
  Eigen::Matrix<Scalar, -1, -1> radial(static_cast<Eigen::Index>(radii_.size()), orders_ + 1), derivative = radial;
  for (Eigen::Index r = 0; r < radial.rows(); ++r) {
    const double rho = radii_[static_cast<std::size_t>(r)], quarter = -0.25 * rho * rho;
    for (int m = 0; m <= orders_; ++m) {
      Scalar term = std::pow(rho, m), sum = term, change = 0.0;
      for (int j = 1; j < 60; ++j) {
        const double factor = quarter / (static_cast<double>(j) * (j + m));
        change += term * factor * static_cast<double>(j);
        term *= x * factor;
        sum += term;
        if (std::abs(term) * j < 1e-15 * (std::abs(sum) + 1e-30)) break;
      }
      radial(r, m) = sum;
      derivative(r, m) = change;
    }
  }
  value.resize(n, columns());
  value.leftCols(affine_) = affineValues_.template cast<Scalar>();
  if (slope != nullptr) slope->setZero(n, columns());
  for (Eigen::Index t = 0; t < n; ++t) {
    const int ring = ring_[static_cast<std::size_t>(t)];
    for (Eigen::Index c = 0; c < 1 + 2 * orders_; ++c) {
      const Eigen::Index m = (c + 1) / 2;
      value(t, affine_ + c) = radial(ring, m) * angular_(t, c);
      if (slope != nullptr) (*slope)(t, affine_ + c) = derivative(ring, m) * angular_(t, c);
    }
  }
}

Eigen::MatrixXd WaveBasis::at(double x) const {
  Eigen::MatrixXd value;
  fill<double>(x, value, nullptr);
  return value;
}

void WaveBasis::at(Complex x, Eigen::MatrixXcd& value, Eigen::MatrixXcd& slope) const {
  fill<Complex>(x, value, &slope);
}

}  // namespace glisson::inversion::detail
