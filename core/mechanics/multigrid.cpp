// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/multigrid.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/parallel.h"
#include "mechanics/factorisation.h"
#include "mechanics/multigrid_level.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t chunk = 32768;

}  // namespace

struct Multigrid::State {
  MultigridOptions options;
  std::vector<MultigridLevel> levels;
  std::unique_ptr<Factorisation> coarsest;
  std::vector<double> right, left;

  void cycle(std::size_t l) {
    MultigridLevel& level = levels[l];
    if (l + 1 == levels.size()) {
      std::copy(level.r.begin(), level.r.end(), right.begin());
      coarsest->solve(right.data(), left.data());
      std::transform(left.begin(), left.end(), level.x.begin(), [](double v) { return static_cast<float>(v); });
      return;
    }
    MultigridLevel& next = levels[l + 1];
    level.smooth(true, options.degree, options.smoothed, true);
    restrictTo(*next.A.lattice, *level.A.lattice, level.halved, level.r.data(), next.r.data());
    next.A.project(next.r.data());
    cycle(l + 1);
    prolongTo(*level.A.lattice, *next.A.lattice, level.halved, next.x.data(), level.inverseDiagonal.data(),
              level.d.data());
    level.A.apply(level.d.data(), level.y.data());
    parallelChunks(level.x.size(), chunk,
                   [x = level.x.data(), r = level.r.data(), d = level.d.data(), y = level.y.data()](std::size_t begin,
                                                                                                    std::size_t end) {
                     for (std::size_t i = begin; i < end; ++i) {
                       x[i] += d[i];
                       r[i] -= y[i];
                     }
                   });
    level.smooth(false, options.degree, options.smoothed, false);
  }
};

MultigridOptions MultigridOptions::forPoisson(double poisson) {
  MultigridOptions o;
  if (1 - 2 * poisson < 0.015) {
    o.degree = 12;
    o.smoothed = 130;
  }
  if (1 - 2 * poisson < 0.001) {
    o.degree = 16;
    o.smoothed = 200;
  }
  return o;
}

Multigrid::Multigrid(const VoxelOperator& op, const MultigridOptions& options, const MultigridMatrix& matrix)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.options = options;
  const VoxelBody& body = op.body();
  // Float needs numbers near 1: moduli relative to the stiffest, edges to their geometric mean.
  const double unitH = std::cbrt(body.h_m.prod());
  const double density = matrix.mass * body.density_kg_m3;
  const double unitE =
      std::max(matrix.stiffness * *std::max_element(body.E_Pa.begin(), body.E_Pa.end()), density * unitH * unitH);
  LevelGeometry finest;
  finest.cells = body.cells;
  finest.h = body.h_m / unitH;
  finest.E = body.E_Pa;
  for (double& E : finest.E) E *= matrix.stiffness / unitE;
  if (density > 0)
    for (const double E : body.E_Pa) finest.rho.push_back(E != 0 ? density * unitH * unitH / unitE : 0.0);
  s.levels.push_back(makeLevel(std::move(finest), op.element(), body.poisson));
  MultigridLevel& first = s.levels.front();
  first.exact.fixed = op.lattice().fixed;
  for (auto spring : op.lattice().springs) {
    for (double& k : spring.k) k *= matrix.stiffness / (unitE * unitH);
    first.exact.springs.push_back(spring);
  }
  first.finish();
  while (s.levels.back().dofs > options.coarsestDofs && s.levels.back().geometry.cells.maxCoeff() > 1) {
    MultigridLevel next = coarsen(s.levels.back(), op.element(), body.poisson);
    next.finish();
    MultigridLevel& last = s.levels.back();
    last.bound(options.boundByCells);
    last.exact = {};
    last.geometry.E = {};
    last.geometry.rho = {};
    s.levels.push_back(std::move(next));
  }
  MultigridLevel& last = s.levels.back();
  s.coarsest = std::make_unique<Factorisation>(last.exact, last.K0, last.M0);
  s.right.resize(last.A.size());
  s.left.resize(last.A.size());
}

Multigrid::~Multigrid() = default;
Multigrid::Multigrid(Multigrid&&) noexcept = default;
Multigrid& Multigrid::operator=(Multigrid&&) noexcept = default;

template <class T>
void Multigrid::cycle(const std::vector<T>& r, std::vector<float>& z) {
  MultigridLevel& top = state_->levels.front();
  parallelChunks(r.size(), chunk, [from = r.data(), to = top.r.data()](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) to[i] = static_cast<float>(from[i]);
  });
  state_->cycle(0);
  // The next cycle writes the level's x before it reads it.
  if (z.size() == top.x.size())
    z.swap(top.x);
  else
    z = top.x;
}

void Multigrid::cycle(const std::vector<double>& r, std::vector<double>& z) {
  std::vector<float> inFloat;
  cycle(r, inFloat);
  z.assign(inFloat.begin(), inFloat.end());
}

template void Multigrid::cycle<float>(const std::vector<float>&, std::vector<float>&);
template void Multigrid::cycle<double>(const std::vector<double>&, std::vector<float>&);

bool Multigrid::boundByCells() {
  if (state_->options.boundByCells) return false;
  state_->options.boundByCells = true;
  for (std::size_t l = 0; l + 1 < state_->levels.size(); ++l) state_->levels[l].bound(true);
  return true;
}

bool Multigrid::lengthen(double factor) {
  MultigridOptions& o = state_->options;
  const int degree = std::min(MultigridOptions::longest, static_cast<int>(std::ceil(factor * o.degree)));
  if (degree <= o.degree) return false;
  o.smoothed *= static_cast<double>(degree) * degree / (static_cast<double>(o.degree) * o.degree);
  o.degree = degree;
  return true;
}

int Multigrid::degree() const {
  return state_->options.degree;
}

int Multigrid::levels() const {
  return static_cast<int>(state_->levels.size());
}

std::string Multigrid::describe() const {
  std::ostringstream out;
  for (std::size_t l = 0; l < state_->levels.size(); ++l) out << (l == 0 ? "" : " > ") << state_->levels[l].dofs;
  return out.str();
}

}  // namespace glisson::mechanics
