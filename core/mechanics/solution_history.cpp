// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/solution_history.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t chunk = 4096;  ///< the vectors' parts stay in the nearest caches

/// Inner products with the images, of the right side and of what was solved last.
struct Products {
  Eigen::VectorXd ofRight, ofLast;
  double lastTwice = 0, lastWithRight = 0;
};

/// One pass over the images for both.
Products productsWith(const std::vector<std::vector<double>>& images, const std::vector<double>& b,
                      const std::vector<double>* last) {
  const std::size_t count = images.size();
  const std::size_t chunks = (b.size() + chunk - 1) / chunk;
  std::vector<Eigen::VectorXd> parts(chunks);
  const auto at = [](std::size_t i) { return static_cast<Eigen::Index>(i); };
  parallelChunks(b.size(), chunk, [&](std::size_t begin, std::size_t end) {
    using Part = Eigen::Map<const Eigen::VectorXd>;
    const Eigen::Index n = at(end - begin);
    Eigen::VectorXd& sums = parts[begin / chunk];
    sums.setZero(at(2 * count + 2));
    const Part right(b.data() + begin, n);
    if (!last) {
      for (std::size_t v = 0; v < count; ++v) sums[at(v)] = right.dot(Part(images[v].data() + begin, n));
      return;
    }
    const Part lastPart(last->data() + begin, n);
    for (std::size_t v = 0; v < count; ++v) {
      const Part image(images[v].data() + begin, n);
      sums[at(v)] = right.dot(image);
      sums[at(count + v)] = lastPart.dot(image);
    }
    sums[at(2 * count)] = lastPart.squaredNorm();
    sums[at(2 * count + 1)] = lastPart.dot(right);
  });
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(at(2 * count + 2));
  for (const Eigen::VectorXd& part : parts) sum += part;
  return {sum.head(at(count)), sum.segment(at(count), at(count)), sum[at(2 * count)], sum[at(2 * count + 1)]};
}

}  // namespace

void SolutionHistory::clear() {
  vectors_.clear();
  images_.clear();
  solutions_.clear();
  coordinates_.resize(0);
  pending_ = false;
}

void SolutionHistory::add(std::vector<double>& e, std::vector<double>& Ae) {
  e_.swap(e);
  Ae_.swap(Ae);
  pending_ = true;
}

void SolutionHistory::start(const std::vector<double>& b, std::vector<double>& x, std::vector<double>& r) {
  if (pending_ && images_.size() == largest) compress();
  const Products p = productsWith(images_, b, pending_ ? &Ae_ : nullptr);
  const std::size_t count = images_.size();
  // What was solved last is orthogonal to the space already, but for what the solver left of the residual.
  const double square = p.lastTwice - p.ofLast.squaredNorm();
  if (pending_) coordinates_ += p.ofLast;
  // A step that its start has solved already adds nothing but rounding.
  const bool grows =
      pending_ && std::isfinite(square) && square > 0.25 * p.lastTwice && square > 1e-26 * coordinates_.squaredNorm();
  const double length = grows ? std::sqrt(square) : 1;
  if (grows) {
    vectors_.push_back(std::move(e_));
    images_.push_back(std::move(Ae_));
  }
  const double share = grows ? (p.lastWithRight - p.ofLast.dot(p.ofRight)) / length : 0;
  x.resize(b.size());
  r.resize(b.size());
  parallelChunks(b.size(), chunk, [&](std::size_t begin, std::size_t end) {
    const std::size_t n = end - begin;
    double* to = x.data() + begin;
    double* left = r.data() + begin;
    std::fill_n(to, n, 0.0);
    std::copy_n(b.data() + begin, n, left);
    double* e = grows ? vectors_.back().data() + begin : nullptr;
    double* Ae = grows ? images_.back().data() + begin : nullptr;
    for (std::size_t v = 0; v < count; ++v) {
      const double* V = vectors_[v].data() + begin;
      const double* W = images_[v].data() + begin;
      const double c = p.ofRight[static_cast<Eigen::Index>(v)];
      for (std::size_t i = 0; i < n; ++i) {
        to[i] += c * V[i];
        left[i] -= c * W[i];
      }
      if (!grows) continue;
      const double s = p.ofLast[static_cast<Eigen::Index>(v)];
      for (std::size_t i = 0; i < n; ++i) {
        e[i] -= s * V[i];
        Ae[i] -= s * W[i];
      }
    }
    if (!grows) return;
    for (std::size_t i = 0; i < n; ++i) {
      to[i] += share * (e[i] /= length);
      left[i] -= share * (Ae[i] /= length);
    }
  });
  if (pending_) remember(grows, length);
  pending_ = false;
  coordinates_ = p.ofRight;
  if (grows) {
    coordinates_.conservativeResize(coordinates_.size() + 1);
    coordinates_[coordinates_.size() - 1] = share;
  }
}

/// The last start's coordinates, with what was solved beyond it, are the last solution's.
void SolutionHistory::remember(bool grows, double length) {
  if (grows) {
    const auto lengthen = [](Eigen::VectorXd& y, double last) {
      y.conservativeResize(y.size() + 1);
      y[y.size() - 1] = last;
    };
    for (Eigen::VectorXd& y : solutions_) lengthen(y, 0);
    lengthen(coordinates_, length);
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
