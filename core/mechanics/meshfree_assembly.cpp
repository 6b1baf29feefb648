// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/detail/meshfree_assembly.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>

#include "base/parallel.h"
#include "mechanics/hex_element.h"

namespace glisson::mechanics {
namespace {

using Eigen::Vector3i;

struct Block {
  int row = 0;        ///< frame, ≤ the column's frame
  Eigen::MatrixXd K;  ///< 3 NB × 3 NB
  Eigen::MatrixXd M;  ///< NB × NB per axis, side by side (one copy where the axes agree)
};

struct Box {
  Vector3i low = Vector3i::Constant(1 << 28), high = Vector3i::Constant(-1);
  void add(const Vector3i& p) { low = low.cwiseMin(p), high = high.cwiseMax(p); }
  bool meets(const Box& o) const { return ((low - o.high).array() <= 1).all() && ((o.low - high).array() <= 1).all(); }
};

/// Computes the block column of one frame. NB: functions per frame.
template <int NB>
class Projector {
 public:
  Projector(const VoxelBody& body, const VoxelMesh& mesh, const std::vector<Spring>& springs, const FrameBasis& basis,
            const ActiveFunctions& active, const Clamp& clamp, HexElement element)
      : body_(body), mesh_(mesh), springs_(springs), basis_(basis), active_(active), clamp_(clamp) {
    const HexMatrix K0 = hexStiffness(element, body.poisson, mesh.h_m());
    for (int d = 0; d < 3; ++d)
      for (int b = 0; b < 8; ++b)
        for (int r = 0; r < 24; ++r)
          K0_[static_cast<std::size_t>(d)][static_cast<std::size_t>(b)][static_cast<std::size_t>(r)] = K0(r, 3 * b + d);
    mass_ = body.density_kg_m3 * hexMass(mesh.h_m());
    masses_ = clamp.sameOnAllAxes ? 1 : 3;
    boxes_.resize(static_cast<std::size_t>(basis.frames()));
    for (int f = 0; f < basis.frames(); ++f)
      for (Eigen::SparseMatrix<double>::InnerIterator it(basis.weights(), f); it; ++it)
        boxes_[static_cast<std::size_t>(f)].add(mesh.latticeOf(static_cast<int>(it.row())));
  }

  int masses() const { return masses_; }

  std::vector<Block> column(int frame) const {
    Scratch s;
    s.local.assign(static_cast<std::size_t>(mesh_.nodeCount()), -1);
    const auto& W = basis_.weights();
    for (Eigen::SparseMatrix<double>::InnerIterator it(W, frame); it; ++it) {
      s.local[static_cast<std::size_t>(it.row())] = static_cast<int>(s.phi.size());
      s.phi.push_back(values(frame, static_cast<int>(it.row()), it.value()));
      s.append();
    }
    applyElements(frame, s);
    for (const Spring& spring : springs_) applySpring(spring, s);
    std::vector<Block> blocks;
    for (int i = 0; i <= frame; ++i)
      if (boxes_[static_cast<std::size_t>(i)].meets(boxes_[static_cast<std::size_t>(frame)])) contract(i, s, blocks);
    return blocks;
  }

 private:
  using Values = std::array<double, NB>;
  static constexpr std::size_t stiffnessRows = 9 * NB;  ///< [row axis][column axis][function]
  static constexpr std::size_t massRows = 3 * NB;       ///< [axis][function]
  struct Scratch {
    std::vector<int> local;   ///< place of a node below, −1 where the frame's columns of D K D Φ vanish
    std::vector<Values> phi;  ///< the frame's functions at the nodes of its support
    std::vector<std::array<double, stiffnessRows>> KPhi;
    std::vector<std::array<double, massRows>> MPhi;
    void append() {
      KPhi.emplace_back().fill(0.0);
      MPhi.emplace_back().fill(0.0);
    }
  };

  Values values(int frame, int node, double w) const {
    std::array<double, 10> P{};
    basis_.polynomials(frame, mesh_.position_m(node), P.data());
    Values phi;
    for (std::size_t b = 0; b < NB; ++b)
      phi[b] = active_.number[static_cast<std::size_t>(frame) * NB + b] >= 0 ? w * P[b] : 0.0;
    return phi;
  }

  void applyElements(int frame, Scratch& s) const {
    const auto support = static_cast<int>(s.phi.size());
    const Box& box = boxes_[static_cast<std::size_t>(frame)];
    if (support == 0) return;
    const Vector3i low = (box.low - Vector3i::Ones()).cwiseMax(0);
    const Vector3i high = box.high.cwiseMin(mesh_.cells() - Vector3i::Ones());
    for (int k = low.z(); k <= high.z(); ++k)
      for (int j = low.y(); j <= high.y(); ++j)
        for (int i = low.x(); i <= high.x(); ++i) {
          const double E = body_.E_Pa[body_.cell(i, j, k)];
          if (E == 0.0) continue;
          std::array<int, 8> node{}, place{};
          bool touched = false;
          for (std::size_t a = 0; a < 8; ++a) {
            const int ia = static_cast<int>(a);
            node[a] = mesh_.nodeAt(i + (ia & 1), j + (ia >> 1 & 1), k + (ia >> 2 & 1));
            place[a] = s.local[static_cast<std::size_t>(node[a])];
            touched = touched || (place[a] >= 0 && place[a] < support);
          }
          if (!touched) continue;
          for (std::size_t a = 0; a < 8; ++a)
            if (place[a] < 0) {
              place[a] = s.local[static_cast<std::size_t>(node[a])] = static_cast<int>(s.KPhi.size());
              s.append();
            }
          addElement(E, node, place, support, s);
        }
  }

  void addElement(double E, const std::array<int, 8>& node, const std::array<int, 8>& place, int support,
                  Scratch& s) const {
    for (int d = 0; d < 3; ++d) {
      std::array<std::array<double, 24>, NB> force{};
      std::array<std::array<double, 8>, NB> momentum{};
      for (std::size_t b = 0; b < 8; ++b) {
        if (place[b] >= support) continue;
        const double clamped = clamp_.d(d, node[b]);
        const Values& phi = s.phi[static_cast<std::size_t>(place[b])];
        const auto& column = K0_[static_cast<std::size_t>(d)][b];
        for (std::size_t f = 0; f < NB; ++f) {
          const double value = clamped * phi[f];
          for (std::size_t r = 0; r < 24; ++r) force[f][r] += column[r] * value;
          if (d < masses_)
            for (std::size_t a = 0; a < 8; ++a)
              momentum[f][a] += mass_(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) * value;
        }
      }
      for (std::size_t a = 0; a < 8; ++a) {
        auto& K = s.KPhi[static_cast<std::size_t>(place[a])];
        for (int c = 0; c < 3; ++c) {
          const double scale = E * clamp_.d(c, node[a]);
          double* to = K.data() + static_cast<std::size_t>(3 * c + d) * NB;
          for (std::size_t f = 0; f < NB; ++f) to[f] += scale * force[f][3 * a + static_cast<std::size_t>(c)];
        }
        if (d >= masses_) continue;
        double* to = s.MPhi[static_cast<std::size_t>(place[a])].data() + static_cast<std::size_t>(d) * NB;
        const double clamped = clamp_.d(d, node[a]);
        for (std::size_t f = 0; f < NB; ++f) to[f] += clamped * momentum[f][a];
      }
    }
  }

  void applySpring(const Spring& spring, Scratch& s) const {
    const int place = s.local[static_cast<std::size_t>(spring.node)];
    if (place < 0 || place >= static_cast<int>(s.phi.size())) return;
    const Values& phi = s.phi[static_cast<std::size_t>(place)];
    auto& K = s.KPhi[static_cast<std::size_t>(place)];
    for (int c = 0; c < 3; ++c)
      for (int d = 0; d < 3; ++d) {
        const double k = clamp_.d(c, spring.node) * spring.k_N_m(c, d) * clamp_.d(d, spring.node);
        for (std::size_t f = 0; f < NB; ++f) K[static_cast<std::size_t>(3 * c + d) * NB + f] += k * phi[f];
      }
  }

  /// Φᵢᵀ (D K D Φ) of the frame in s.
  void contract(int i, const Scratch& s, std::vector<Block>& blocks) const {
    std::array<std::array<double, stiffnessRows>, NB> K{};
    std::array<std::array<double, massRows>, NB> M{};
    const std::size_t massUsed = static_cast<std::size_t>(masses_) * NB;
    bool any = false;
    for (Eigen::SparseMatrix<double>::InnerIterator it(basis_.weights(), i); it; ++it) {
      const int place = s.local[static_cast<std::size_t>(it.row())];
      if (place < 0) continue;
      any = true;
      const Values phi = values(i, static_cast<int>(it.row()), it.value());
      const auto& KPhi = s.KPhi[static_cast<std::size_t>(place)];
      const auto& MPhi = s.MPhi[static_cast<std::size_t>(place)];
      for (std::size_t b = 0; b < NB; ++b) {
        const double p = phi[b];
        for (std::size_t r = 0; r < stiffnessRows; ++r) K[b][r] += p * KPhi[r];
        for (std::size_t r = 0; r < massUsed; ++r) M[b][r] += p * MPhi[r];
      }
    }
    if (!any) return;
    Block block;
    block.row = i;
    block.K.resize(3 * NB, 3 * NB);
    block.M.resize(NB, masses_ * NB);
    for (int b = 0; b < NB; ++b) {
      const auto bb = static_cast<std::size_t>(b);
      for (int c = 0; c < 3; ++c)
        for (int d = 0; d < 3; ++d)
          for (int f = 0; f < NB; ++f)
            block.K(3 * b + c, 3 * f + d) = K[bb][static_cast<std::size_t>((3 * c + d) * NB + f)];
      for (int m = 0; m < masses_ * NB; ++m) block.M(b, m) = M[bb][static_cast<std::size_t>(m)];
    }
    blocks.push_back(std::move(block));
  }

  const VoxelBody& body_;
  const VoxelMesh& mesh_;
  const std::vector<Spring>& springs_;
  const FrameBasis& basis_;
  const ActiveFunctions& active_;
  const Clamp& clamp_;
  std::array<std::array<std::array<double, 24>, 8>, 3> K0_{};
  Eigen::Matrix<double, 8, 8> mass_;
  int masses_ = 1;
  std::vector<Box> boxes_;
};

/// Fills a symmetric sparse matrix from its upper block triangle. entry(block, b, c, f, d, transposed): its value.
class Filler {
 public:
  Filler(int NB, const ActiveFunctions& active, const std::vector<std::vector<Block>>& columns)
      : NB_(NB), active_(active), columns_(columns), below_(columns.size()) {
    for (std::size_t j = 0; j < columns.size(); ++j)
      for (const Block& block : columns[j])
        if (block.row != static_cast<int>(j))
          below_[static_cast<std::size_t>(block.row)].emplace_back(static_cast<int>(j), &block);
  }

  template <class Entry>
  Eigen::SparseMatrix<double> fill(bool axesCouple, Entry&& entry) const {
    const Eigen::Index n = 3 * active_.count;
    Eigen::SparseMatrix<double> A(n, n);
    Eigen::VectorXi perColumn = Eigen::VectorXi::Zero(n);
    each(axesCouple, [&](Eigen::Index, Eigen::Index column, const Block&, int, int, int, int) { ++perColumn[column]; });
    A.reserve(perColumn);
    each(axesCouple, [&](Eigen::Index row, Eigen::Index column, const Block& block, int b, int c, int f, int d) {
      A.insert(row, column) = entry(block, b, c, f, d);
    });
    A.makeCompressed();
    return A;
  }

 private:
  int number(int frame, int b) const { return active_.number[static_cast<std::size_t>(frame * NB_ + b)]; }

  template <class Visit>
  void each(bool axesCouple, Visit&& visit) const {
    for (int j = 0; j < static_cast<int>(columns_.size()); ++j)
      for (int f = 0; f < NB_; ++f) {
        if (number(j, f) < 0) continue;
        for (int d = 0; d < 3; ++d) {
          const Eigen::Index column = 3 * number(j, f) + d;
          const auto rows = [&](int i, auto&& each) {
            for (int b = 0; b < NB_; ++b) {
              if (number(i, b) < 0) continue;
              for (int c = 0; c < 3; ++c)
                if (axesCouple || c == d) each(3 * number(i, b) + c, b, c);
            }
          };
          for (const Block& block : columns_[static_cast<std::size_t>(j)])
            rows(block.row, [&](Eigen::Index row, int b, int c) { visit(row, column, block, b, c, f, d); });
          for (const std::pair<int, const Block*>& below : below_[static_cast<std::size_t>(j)])
            rows(below.first, [&](Eigen::Index row, int b, int c) { visit(row, column, *below.second, f, d, b, c); });
        }
      }
  }

  int NB_;
  const ActiveFunctions& active_;
  const std::vector<std::vector<Block>>& columns_;
  std::vector<std::vector<std::pair<int, const Block*>>> below_;
};

template <int NB>
ReducedMatrices project(const Projector<NB>& projector, const ActiveFunctions& active, int frames,
                        const Progress& progress) {
  std::vector<std::vector<Block>> columns(static_cast<std::size_t>(frames));
  parallelChunks(columns.size(), 1, [&](std::size_t j, std::size_t) {
    progress.check();
    columns[j] = projector.column(static_cast<int>(j));
    // Rounding differs across the diagonal of a frame's own block only; the mean is symmetric to the last bit.
    if (columns[j].empty() || columns[j].back().row != static_cast<int>(j)) return;
    Block& own = columns[j].back();
    own.K = (0.5 * (own.K + own.K.transpose())).eval();
    for (int m = 0; m < projector.masses(); ++m) {
      const Eigen::MatrixXd part = own.M.middleCols(m * NB, NB);
      own.M.middleCols(m * NB, NB) = 0.5 * (part + part.transpose());
    }
  });
  progress.report(0.9, "projecting onto mesh-free frames");
  const Filler filler(NB, active, columns);
  ReducedMatrices out;
  out.K_N_m =
      filler.fill(true, [](const Block& block, int b, int c, int f, int d) { return block.K(3 * b + c, 3 * f + d); });
  const bool one = projector.masses() == 1;
  out.M_kg = filler.fill(
      false, [one](const Block& block, int b, int c, int f, int) { return block.M(b, (one ? 0 : c * NB) + f); });
  return out;
}

}  // namespace

ActiveFunctions activeFunctions(const VoxelMesh& mesh, const FrameBasis& basis, const Clamp& clamp) {
  const int NB = basis.functions();
  ActiveFunctions active;
  active.number.assign(static_cast<std::size_t>(basis.frames() * NB), -1);
  for (int frame = 0; frame < basis.frames(); ++frame) {
    Eigen::MatrixXd G = Eigen::MatrixXd::Zero(NB, NB);
    Eigen::VectorXd P(NB);
    for (Eigen::SparseMatrix<double>::InnerIterator it(basis.weights(), frame); it; ++it) {
      const int node = static_cast<int>(it.row());
      if (clamp.d.col(node).minCoeff() <= 0.0) continue;
      basis.polynomials(frame, mesh.position_m(node), P.data());
      G += P * P.transpose();
    }
    const Eigen::VectorXd square = G.diagonal();
    for (int b = 0; b < NB; ++b) {
      if (!(G(b, b) > 1e-10 * square[b]) || square[b] == 0.0) continue;
      active.number[static_cast<std::size_t>(frame * NB + b)] = active.count++;
      const Eigen::VectorXd column = G.col(b) / G(b, b);
      G -= column * G.row(b).eval();
    }
  }
  return active;
}

ReducedMatrices projectMatrices(const VoxelBody& body, const VoxelMesh& mesh, const std::vector<Spring>& springs,
                                const FrameBasis& basis, const ActiveFunctions& active, const Clamp& clamp,
                                HexElement element, const Progress& progress) {
  if (basis.functions() == 1)
    return project<1>({body, mesh, springs, basis, active, clamp, element}, active, basis.frames(), progress);
  if (basis.functions() == 4)
    return project<4>({body, mesh, springs, basis, active, clamp, element}, active, basis.frames(), progress);
  return project<10>({body, mesh, springs, basis, active, clamp, element}, active, basis.frames(), progress);
}

}  // namespace glisson::mechanics
