// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/factorisation.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "base/error.h"
#include "mechanics/detail/sparse_cholesky.h"

namespace glisson::mechanics {
namespace {

/// Summed from the cells. dofOf: 3 nodeSlots() numbers, −1 where inactive.
LowerTriangle assemble(const LatticeOperator<double>& A, const HexMatrix& K0, const Eigen::Matrix<double, 8, 8>& M0,
                       const std::vector<int>& dofOf, int dofs) {
  const RowLattice& L = *A.lattice;
  const std::size_t n = L.nodeSlots();
  std::size_t filled = 0;
  for (const double E : A.E) filled += E != 0;
  std::vector<Eigen::Triplet<double, std::int64_t>> entries;
  entries.reserve(300 * filled + 6 * A.springs.size());
  const auto add = [&](int a, int b, double v) {
    if (a < b || b < 0) return;
    entries.emplace_back(a, b, v);
  };
  for (int k = 0; k < L.cells().z(); ++k)
    for (int j = 0; j < L.cells().y(); ++j) {
      const RowLattice::Row& cells = L.cellRow(j, k);
      for (int s = 0; s < cells.length; ++s) {
        const double E = A.E[cells.offset + static_cast<std::size_t>(s)];
        if (E == 0) continue;
        const double rho = A.rho.empty() ? 0.0 : A.rho[cells.offset + static_cast<std::size_t>(s)];
        std::array<int, 24> dof{};
        for (int a = 0; a < 8; ++a)
          for (int c = 0; c < 3; ++c)
            dof[static_cast<std::size_t>(3 * a + c)] =
                dofOf[static_cast<std::size_t>(c) * n +
                      L.slot(cells.begin + s + (a & 1), j + (a >> 1 & 1), k + (a >> 2 & 1))];
        for (int a = 0; a < 24; ++a)
          for (int b = 0; b < 24; ++b)
            add(dof[static_cast<std::size_t>(a)], dof[static_cast<std::size_t>(b)],
                E * K0(a, b) + (a % 3 == b % 3 ? rho * M0(a / 3, b / 3) : 0.0));
      }
    }
  for (const auto& [slot, k] : A.springs) {
    const std::array<int, 3> d = {dofOf[slot], dofOf[n + slot], dofOf[2 * n + slot]};
    for (const auto& [a, b, v] :
         {std::tuple{0, 0, k[0]}, {1, 0, k[1]}, {2, 0, k[2]}, {1, 1, k[3]}, {2, 1, k[4]}, {2, 2, k[5]}}) {
      const int p = d[static_cast<std::size_t>(a)];
      const int q = d[static_cast<std::size_t>(b)];
      if (p >= 0 && q >= 0) add(std::max(p, q), std::min(p, q), v);
    }
  }
  LowerTriangle K(dofs, dofs);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

}  // namespace

struct Factorisation::State {
  std::vector<std::size_t> slotOf;  ///< position in row storage per degree of freedom
  std::size_t size = 0;
  std::vector<double> right;
  std::optional<SparseCholesky> cholesky;
};

Factorisation::Factorisation(const LatticeOperator<double>& A, const HexMatrix& K0,
                             const Eigen::Matrix<double, 8, 8>& M0)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.size = A.size();
  std::vector<int> dofOf(A.size(), -1);
  const RowLattice& L = *A.lattice;
  const std::size_t n = L.nodeSlots();
  for (int k = 0; k < L.cells().z(); ++k)
    for (int j = 0; j < L.cells().y(); ++j) {
      const RowLattice::Row& cells = L.cellRow(j, k);
      for (int i = 0; i < cells.length; ++i)
        if (A.E[cells.offset + static_cast<std::size_t>(i)] != 0)
          for (int a = 0; a < 8; ++a)
            for (std::size_t c = 0; c < 3; ++c)
              dofOf[c * n + L.slot(cells.begin + i + (a & 1), j + (a >> 1 & 1), k + (a >> 2 & 1))] = 0;
    }
  for (const std::size_t f : A.fixed) dofOf[f] = -1;
  for (std::size_t slot = 0; slot < n; ++slot)
    for (std::size_t c = 0; c < 3; ++c)
      if (dofOf[c * n + slot] == 0) {
        dofOf[c * n + slot] = static_cast<int>(s.slotOf.size());
        s.slotOf.push_back(c * n + slot);
      }
  s.right.resize(s.slotOf.size());
  const LowerTriangle K = assemble(A, K0, M0, dofOf, dofs());
  s.cholesky.emplace(K);
  if (!s.cholesky->factorise(K))
    throw SolverFailed(
        "the stiffness of " + std::to_string(dofs()) +
            " degrees of freedom is not positive definite to double precision: the body is hardly held, or "
            "its moduli span more decades than double precision does",
        0, 1.0, 0.0);
}

Factorisation::~Factorisation() = default;
Factorisation::Factorisation(Factorisation&&) noexcept = default;
Factorisation& Factorisation::operator=(Factorisation&&) noexcept = default;

int Factorisation::dofs() const {
  return static_cast<int>(state_->slotOf.size());
}

double Factorisation::bytes() const {
  return state_->cholesky->bytes();
}

double Factorisation::expectedBytes(double dofs) {
  return SparseCholesky::expectedBytes(dofs);
}

void Factorisation::solve(const double* b, double* x) {
  State& s = *state_;
  std::fill(x, x + s.size, 0.0);
  for (std::size_t i = 0; i < s.slotOf.size(); ++i) s.right[i] = b[s.slotOf[i]];
  s.cholesky->solve(s.right.data(), s.right.data());
  for (std::size_t i = 0; i < s.slotOf.size(); ++i) x[s.slotOf[i]] = s.right[i];
}

}  // namespace glisson::mechanics
