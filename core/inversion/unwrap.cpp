// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>

#include "base/order_statistics.h"
#include "base/parallel.h"
#include "inversion/waves.h"

namespace glisson::inversion {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;
constexpr std::array<std::array<int, 2>, 4> neighbours{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

double wrapped(double phase_rad) {
  return phase_rad - turn * std::round(phase_rad / turn);
}

class SliceUnwrapper {
 public:
  SliceUnwrapper(image::ScalarVolume& phase, const image::Mask& mask, int k)
      : phase_(phase), mask_(mask), k_(k), nx_(phase.grid.size.x()), ny_(phase.grid.size.y()) {
    const auto n = static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_);
    roughness_.assign(n, 0.0);
    done_.assign(n, false);
  }

  void run() {
    std::vector<std::size_t> order;
    for (int j = 0; j < ny_; ++j)
      for (int i = 0; i < nx_; ++i) {
        if (!inside(i, j)) continue;
        roughness_[at(i, j)] = roughness(i, j);
        order.push_back(at(i, j));
      }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return roughness_[a] < roughness_[b]; });
    for (const std::size_t seed : order)
      if (!done_[seed]) grow(seed);
  }

 private:
  /// The smoothest candidate first; ties by index, so that the order is the same every time.
  using Candidate = std::pair<double, std::size_t>;

  std::size_t at(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(i);
  }
  bool inside(int i, int j) const { return i >= 0 && j >= 0 && i < nx_ && j < ny_ && mask_.at(i, j, k_) != 0; }
  double value(int i, int j) const { return static_cast<double>(phase_.at(i, j, k_)); }

  double roughness(int i, int j) const {
    double sum = 0.0;
    int count = 0;
    for (const auto& n : neighbours)
      if (inside(i + n[0], j + n[1])) {
        const double step = wrapped(value(i + n[0], j + n[1]) - value(i, j));
        sum += step * step;
        ++count;
      }
    return count == 0 ? 1e9 : sum / count;
  }

  void grow(std::size_t seed) {
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue;
    std::vector<std::size_t> part;
    done_[seed] = true;
    queue.emplace(roughness_[seed], seed);
    while (!queue.empty()) {
      const std::size_t v = queue.top().second;
      queue.pop();
      part.push_back(v);
      const int i = static_cast<int>(v % static_cast<std::size_t>(nx_));
      const int j = static_cast<int>(v / static_cast<std::size_t>(nx_));
      for (const auto& n : neighbours) {
        const int a = i + n[0], b = j + n[1];
        if (!inside(a, b) || done_[at(a, b)]) continue;
        done_[at(a, b)] = true;
        phase_.at(a, b, k_) = static_cast<float>(value(i, j) + wrapped(value(a, b) - value(i, j)));
        queue.emplace(roughness_[at(a, b)], at(a, b));
      }
    }
    centre(part);
  }

  void centre(const std::vector<std::size_t>& part) {
    float* slice = &phase_.at(0, 0, k_);
    std::vector<float> values;
    for (const std::size_t v : part) values.push_back(slice[v]);
    const double shift = turn * std::round(static_cast<double>(middleValue(values)) / turn);
    if (shift != 0.0)
      for (const std::size_t v : part) slice[v] = static_cast<float>(static_cast<double>(slice[v]) - shift);
  }

  image::ScalarVolume& phase_;
  const image::Mask& mask_;
  int k_, nx_, ny_;
  std::vector<double> roughness_;
  std::vector<bool> done_;
};

}  // namespace

void unwrapSlices(image::ScalarVolume& phase_rad, const image::Mask& mask) {
  parallelChunks(static_cast<std::size_t>(phase_rad.grid.size.z()), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) SliceUnwrapper(phase_rad, mask, static_cast<int>(k)).run();
  });
}

}  // namespace glisson::inversion
