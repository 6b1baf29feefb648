// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/solution_history.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "mechanics/krylov.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t chunk = 4096;  ///< the vectors' parts stay in the nearest caches

/// to += sign Σ weights[v] from[v].
void addCombination(const std::vector<std::vector<double>>& from, const Eigen::VectorXd& weights, double sign,
                    std::vector<double>& to) {
  parallelChunks(to.size(), chunk, [&, y = to.data()](std::size_t begin, std::size_t end) {
    for (std::size_t v = 0; v < from.size(); ++v) {
      const double w = sign * weights[static_cast<Eigen::Index>(v)];
      const double* x = from[v].data();
      for (std::size_t i = begin; i < end; ++i) y[i] += w * x[i];
    }
  });
}

Eigen::VectorXd products(const std::vector<std::vector<double>>& with, const std::vector<double>& b) {
  Eigen::VectorXd c(static_cast<Eigen::Index>(with.size()));
  for (std::size_t v = 0; v < with.size(); ++v) c[static_cast<Eigen::Index>(v)] = dot(with[v], b);
  return c;
}

void scale(std::vector<double>& x, double by) {
  parallelChunks(x.size(), chunk, [by, y = x.data()](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) y[i] *= by;
  });
}

}  // namespace

void SolutionHistory::clear() {
  vectors_.clear();
  images_.clear();
  solutions_.clear();
  coordinates_.resize(0);
}

void SolutionHistory::start(const std::vector<double>& b, std::vector<double>& x, std::vector<double>& r) {
  coordinates_ = products(images_, b);
  x.assign(b.size(), 0.0);
  addCombination(vectors_, coordinates_, 1, x);
  r = b;
  addCombination(images_, coordinates_, -1, r);
}

void SolutionHistory::add(std::vector<double>& e, std::vector<double>& Ae) {
  const double before = norm(Ae);
  if (images_.size() == largest) compress();
  // Orthogonal to the space already but for what the solver left of the residual.
  const Eigen::VectorXd share = products(images_, Ae);
  addCombination(images_, share, -1, Ae);
  addCombination(vectors_, share, -1, e);
  coordinates_ += share;
  const double length = norm(Ae);
  // A step that its start has solved already adds nothing but rounding.
  if (length > 0.5 * before && std::isfinite(length) && length > 1e-13 * coordinates_.norm()) {
    scale(e, 1 / length);
    scale(Ae, 1 / length);
    vectors_.push_back(e);
    images_.push_back(Ae);
    coordinates_.conservativeResize(coordinates_.size() + 1);
    coordinates_[coordinates_.size() - 1] = length;
    for (Eigen::VectorXd& y : solutions_) {
      y.conservativeResize(y.size() + 1);
      y[y.size() - 1] = 0;
    }
  }
  solutions_.push_front(coordinates_);
  if (solutions_.size() > kept) solutions_.pop_back();
}

/// vectors ← vectors Q.
void SolutionHistory::turn(Vectors& vectors, const Eigen::MatrixXd& Q) {
  const auto columns = static_cast<std::size_t>(Q.cols());
  parallelChunks(vectors.front().size(), chunk, [&](std::size_t begin, std::size_t end) {
    Vectors part(columns, std::vector<double>(end - begin, 0.0));
    for (std::size_t c = 0; c < columns; ++c) {
      double* to = part[c].data();
      for (std::size_t v = 0; v < vectors.size(); ++v) {
        const double w = Q(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(c));
        const double* from = vectors[v].data() + begin;
        for (std::size_t i = 0; i < end - begin; ++i) to[i] += w * from[i];
      }
    }
    for (std::size_t c = 0; c < columns; ++c) std::copy(part[c].begin(), part[c].end(), vectors[c].data() + begin);
  });
  vectors.resize(columns);
}

/// Turns the space so that its first vectors span the last solutions and the start at hand, and drops the others.
void SolutionHistory::compress() {
  const std::size_t count = std::min(kept - 1, solutions_.size());
  Eigen::MatrixXd Y(coordinates_.size(), static_cast<Eigen::Index>(count) + 1);
  Y.col(0) = coordinates_;
  for (std::size_t s = 0; s < count; ++s) Y.col(static_cast<Eigen::Index>(s) + 1) = solutions_[s];
  const Eigen::MatrixXd Q =
      Eigen::HouseholderQR<Eigen::MatrixXd>(Y).householderQ() * Eigen::MatrixXd::Identity(Y.rows(), Y.cols());
  turn(vectors_, Q);
  turn(images_, Q);
  coordinates_ = (Q.transpose() * coordinates_).eval();
  for (Eigen::VectorXd& y : solutions_) y = (Q.transpose() * y).eval();
}

}  // namespace glisson::mechanics
