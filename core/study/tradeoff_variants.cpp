// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/detail/tradeoff_variants.h"

#include <algorithm>
#include <sstream>

#include "mechanics/sites.h"

namespace glisson::study {
namespace {

using mechanics::HexElement;
using mechanics::Kernel;

void addCells(bool quick, std::vector<Variant>& all) {
  const std::vector<double> factors = quick ? std::vector<double>{3, 2, 1} : std::vector<double>{4, 3, 2, 1.5, 1};
  const auto hexahedra = [&](const char* name, HexElement element) {
    for (const double f : factors) {
      Variant v{.method = name, .factor = f};
      v.solver.element = element;
      all.push_back(v);
    }
  };
  hexahedra("H8-incompatible", HexElement::Incompatible);
  hexahedra("H8-Bbar", HexElement::BBar);
  hexahedra("H8", HexElement::H8);
  for (const bool quadratic : {false, true})
    for (const double f : factors)
      all.push_back({.kind = Variant::Kind::Tetrahedra,
                     .method = quadratic ? "T10" : "T4",
                     .factor = f,
                     .quadraticTets = quadratic,
                     .mostCells = quadratic ? std::size_t{4000} : std::size_t{20000}});
}

struct Frames {
  const char* method;
  Kernel kernel;
  int order;
  bool published;
};

void addFrames(const Frames& f, const std::vector<int>& dofs, std::size_t cells, int nodes, std::uint64_t seed,
               std::vector<Variant>& all, std::vector<std::string>& leftOut) {
  const int each = 3 * mechanics::functionsOf(f.kernel, f.order), least = mechanics::leastNodesOf(f.kernel, f.order);
  const int most = mechanics::mostSites(nodes, static_cast<double>(cells), least);
  int before = 0;
  for (const int n : dofs) {
    const int asked = std::max(1, n / each), frames = std::min(asked, most);
    if (frames == before) {
      std::ostringstream t;
      t << f.method << ", " << asked << " frames: the voxels have room for " << most << " (at least " << least << " of "
        << nodes << " voxel nodes each), which stand above";
      leftOut.push_back(t.str());
      continue;
    }
    before = frames;
    Variant v{.kind = Variant::Kind::Frames, .method = f.method};
    v.meshfree.kernel = f.kernel;
    v.meshfree.order = f.order;
    v.meshfree.frames = frames;
    v.meshfree.seed = seed;
    if (f.published) {
      v.solver.kind = mechanics::SolverKind::Cg;
      v.solver.preconditioner = mechanics::Preconditioner::None;
      v.solver.iterations = 200;
    }
    all.push_back(v);
  }
}

}  // namespace

std::vector<Variant> tradeoffVariants(bool quick, std::size_t cells, int nodes, std::uint64_t seed,
                                      std::vector<std::string>& leftOut) {
  std::vector<Variant> all;
  addCells(quick, all);
  // The multigrid meets any tolerance at once: it is conjugate gradients where looser, or stopped, means something.
  Variant iterative;
  iterative.solver.kind = mechanics::SolverKind::Cg;
  for (const double tolerance : {1e-2, 1e-3, 1e-6}) {
    std::ostringstream also;
    also << ", tolerance " << tolerance;
    Variant v = iterative;
    v.method = "H8-incompatible, CG";
    v.solver.preconditioner = mechanics::Preconditioner::Jacobi;
    v.solver.tolerance = tolerance;
    v.also = also.str();
    all.push_back(v);
  }
  for (const int iterations : {25, 50, 100, 200}) {
    Variant v = iterative;
    v.method = "H8-incompatible, CG stopped";
    v.solver.preconditioner = mechanics::Preconditioner::None;
    v.solver.iterations = iterations;
    v.also = ", " + std::to_string(iterations) + " iterations at most";
    all.push_back(v);
  }
  all.push_back({.kind = Variant::Kind::Condensed, .method = "Condensed", .also = ", every node"});
  all.push_back({.kind = Variant::Kind::Corotational, .method = "Corotational", .mostCells = 20000});
  // Many frames on many cells cost minutes; the trend is seen with fewer.
  std::vector<int> dofs = {360, 720};
  if (!quick && cells <= 60000) dofs.insert(dofs.end(), {1800, 3600});
  for (const Frames& f :
       {Frames{"Voronoi, CG 200 (published)", Kernel::Voronoi, 1, true},
        Frames{"Wendland affine", Kernel::Wendland, 1, false}, Frames{"Wendland quadratic", Kernel::Wendland, 2, false},
        Frames{"MLS linear", Kernel::Mls, 1, false}, Frames{"MLS quadratic", Kernel::Mls, 2, false}})
    addFrames(f, dofs, cells, nodes, seed, all, leftOut);
  return all;
}

}  // namespace glisson::study
