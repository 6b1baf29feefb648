// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/factorisation.h"

#include <cholmod.h>

#include <cmath>
#include <string>

#include "base/error.h"

extern "C" void openblas_set_num_threads(int);

namespace glisson::mechanics {
namespace {

/// Sparse lower triangle, summed from the cells. dofOf: 3 nodeSlots() numbers, −1 where inactive.
cholmod_sparse* assemble(const LatticeOperator<double>& A, const HexMatrix& K0, const Eigen::Matrix<double, 8, 8>& M0,
                         const std::vector<int>& dofOf, int dofs, cholmod_common* common) {
  const RowLattice& L = *A.lattice;
  const std::size_t n = L.nodeSlots();
  std::size_t filled = 0;
  for (const double E : A.E) filled += E != 0;
  const std::size_t room = 300 * filled + 6 * A.springs.size();
  cholmod_triplet* T = cholmod_l_allocate_triplet(static_cast<std::size_t>(dofs), static_cast<std::size_t>(dofs), room,
                                                  -1, CHOLMOD_REAL, common);
  if (T == nullptr) return nullptr;
  auto* row = static_cast<SuiteSparse_long*>(T->i);
  auto* column = static_cast<SuiteSparse_long*>(T->j);
  auto* value = static_cast<double*>(T->x);
  std::size_t count = 0;
  const auto add = [&](int a, int b, double v) {
    if (a < b || b < 0) return;
    row[count] = a;
    column[count] = b;
    value[count++] = v;
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
  T->nnz = count;
  cholmod_sparse* S = cholmod_l_triplet_to_sparse(T, count, common);
  cholmod_l_free_triplet(&T, common);
  return S;
}

}  // namespace

struct Factorisation::State {
  cholmod_common common{};
  cholmod_factor* L = nullptr;
  std::vector<std::size_t> slotOf;  ///< position in row storage per degree of freedom
  std::size_t size = 0;
  std::vector<double> right;
  cholmod_dense* X = nullptr;
  cholmod_dense* Y = nullptr;
  cholmod_dense* W = nullptr;

  State() { cholmod_l_start(&common); }
  ~State() {
    cholmod_l_free_dense(&X, &common);
    cholmod_l_free_dense(&Y, &common);
    cholmod_l_free_dense(&W, &common);
    cholmod_l_free_factor(&L, &common);
    cholmod_l_finish(&common);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

Factorisation::Factorisation(const LatticeOperator<double>& A, const HexMatrix& K0,
                             const Eigen::Matrix<double, 8, 8>& M0)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  openblas_set_num_threads(1);
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
  if (s.slotOf.empty()) return;
  s.common.supernodal = CHOLMOD_SUPERNODAL;
  s.common.final_ll = 1;
  s.common.print = 0;
  cholmod_sparse* K = assemble(A, K0, M0, dofOf, dofs(), &s.common);
  if (K != nullptr) {
    s.L = cholmod_l_analyze(K, &s.common);
    if (s.L != nullptr) cholmod_l_factorize(K, s.L, &s.common);
    cholmod_l_free_sparse(&K, &s.common);
  }
  if (s.common.status == CHOLMOD_NOT_POSDEF)
    throw SolverFailed(
        "the stiffness of " + std::to_string(dofs()) +
            " degrees of freedom is not positive definite to double precision: the body is hardly held, or "
            "its moduli span more decades than double precision does",
        0, 1.0, 0.0);
  if (s.common.status != CHOLMOD_OK || s.L == nullptr)
    throw SolverFailed(
        "the factorisation of " + std::to_string(dofs()) + " degrees of freedom ran out of memory (about " +
            std::to_string(static_cast<long>(expectedBytes(dofs()) / 1e6)) + " MB expected); use the multigrid solver",
        0, 1.0, 0.0);
  s.right.resize(s.slotOf.size());
}

Factorisation::~Factorisation() = default;
Factorisation::Factorisation(Factorisation&&) noexcept = default;
Factorisation& Factorisation::operator=(Factorisation&&) noexcept = default;

int Factorisation::dofs() const {
  return static_cast<int>(state_->slotOf.size());
}

double Factorisation::bytes() const {
  return state_->L == nullptr ? 0 : 8 * static_cast<double>(state_->L->xsize);
}

double Factorisation::expectedBytes(double dofs) {
  return 8 * 14.0 * std::pow(dofs, 4.0 / 3.0);
}

void Factorisation::solve(const double* b, double* x) {
  State& s = *state_;
  std::fill(x, x + s.size, 0.0);
  if (s.slotOf.empty()) return;
  for (std::size_t i = 0; i < s.slotOf.size(); ++i) s.right[i] = b[s.slotOf[i]];
  cholmod_dense B{};
  B.nrow = B.nzmax = B.d = s.right.size();
  B.ncol = 1;
  B.x = s.right.data();
  B.xtype = CHOLMOD_REAL;
  B.dtype = CHOLMOD_DOUBLE;
  if (cholmod_l_solve2(CHOLMOD_A, s.L, &B, nullptr, &s.X, nullptr, &s.Y, &s.W, &s.common) == 0)
    throw SolverFailed("the triangular solve ran out of memory", 0, 1.0, 0.0);
  const auto* result = static_cast<const double*>(s.X->x);
  for (std::size_t i = 0; i < s.slotOf.size(); ++i) x[s.slotOf[i]] = result[i];
}

}  // namespace glisson::mechanics
