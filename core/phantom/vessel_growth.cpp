// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "base/error.h"
#include "phantom/detail/vessel_tree.h"

namespace glisson::phantom {
namespace {

constexpr double portalRoot_mm = 6.3;
constexpr double hepaticRoot_mm = 7.0;  // shared by the veins that open into the vena cava
constexpr double capsuleGap_mm = 1.2;   // between a vessel's wall and the liver's surface
constexpr double treeGap_mm = 1.0;      // between the walls of the two trees

constexpr int portalTerminals = 150;
constexpr int hepaticTerminals = 120;

using Distance = std::function<double(const Point&)>;

bool inside(const Distance& liver_mm, const Point& a, const Point& b, double radius_mm) {
  const int steps = std::max(1, static_cast<int>(std::ceil((b - a).norm() / 2.5)));
  for (int s = 0; s <= steps; ++s)
    if (liver_mm(a + (b - a) * s / steps) > -(radius_mm + capsuleGap_mm)) return false;
  return true;
}

bool clear(const VesselTree& tree, const Point& a, const Point& b, double radius_mm, double gap_mm, bool ownTree) {
  const auto& nodes = tree.nodes();
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const Point& c = nodes[static_cast<std::size_t>(nodes[i].parent)].p_lps_mm;
    const Point& d = nodes[i].p_lps_mm;
    const double reach = radius_mm + tree.radius_mm(static_cast<int>(i)) + gap_mm;
    const double between = segmentDistance_mm(a, b, c, d);
    if (between >= reach) continue;
    // Segments of one tree meet at their forks; only a crossing away from all four ends counts.
    if (ownTree) {
      const double ends = std::min({(a - c).norm(), (a - d).norm(), (b - c).norm(), (b - d).norm(),
                                    Capsule{c, d, 0}.distance_mm(a), Capsule{c, d, 0}.distance_mm(b)});
      if (ends < 1e-6 || between > 0.5 * reach) continue;
    }
    return false;
  }
  return true;
}

// Where the curves of the two trees come too close, or leave the liver, the smaller branch goes.
std::optional<std::pair<int, int>> conflict(const LiverVessels& v) {  // {tree, node}
  for (std::size_t i = 1; i < v.portal.nodes().size(); ++i)
    for (std::size_t j = 1; j < v.hepatic.nodes().size(); ++j) {
      const auto& p = v.portal.nodes()[i];
      const auto& h = v.hepatic.nodes()[j];
      const double rp = v.portal.radius_mm(static_cast<int>(i));
      const double rh = v.hepatic.radius_mm(static_cast<int>(j));
      const double reach = rp + rh + 0.5 * treeGap_mm;
      const double slack = reach + 0.35 * ((p.path_lps_mm.back() - p.path_lps_mm.front()).norm() +
                                           (h.path_lps_mm.back() - h.path_lps_mm.front()).norm());
      if (segmentDistance_mm(p.path_lps_mm.front(), p.path_lps_mm.back(), h.path_lps_mm.front(), h.path_lps_mm.back()) >
          slack)
        continue;
      for (std::size_t s = 0; s + 1 < p.path_lps_mm.size(); ++s)
        for (std::size_t t = 0; t + 1 < h.path_lps_mm.size(); ++t)
          if (segmentDistance_mm(p.path_lps_mm[s], p.path_lps_mm[s + 1], h.path_lps_mm[t], h.path_lps_mm[t + 1]) <
              reach)
            return p.leaves < h.leaves ? std::pair{0, static_cast<int>(i)} : std::pair{1, static_cast<int>(j)};
    }
  return std::nullopt;
}

int leaving(const VesselTree& tree, const Distance& liver_mm) {
  for (std::size_t i = 1; i < tree.nodes().size(); ++i)
    for (const Point& p : tree.nodes()[i].path_lps_mm)
      if (liver_mm(p) > -(tree.radius_mm(static_cast<int>(i)) + 0.3)) return static_cast<int>(i);
  return -1;
}

// Both trees of one attempt while they grow.
class Growth {
 public:
  Growth(const Distance& liver_mm, const Point& portalHilum, const Point& hepaticConfluence, std::uint64_t seed,
         int attempt)
      : liver_mm_(liver_mm),
        attempt_(attempt),
        random_(derived(seed, 31 + 1000 * static_cast<std::uint64_t>(attempt))),
        trees_{VesselTree(portalHilum, portalRoot_mm), VesselTree(hepaticConfluence, hepaticRoot_mm)} {}

  void mainBranches();
  void terminals(const Point& low, const Point& high);
  // Curves the vessels, and takes away what then leaves the liver or meets the other tree.
  void curve();
  const LiverVessels& trees() const { return trees_; }

 private:
  enum class Tree { Portal, Hepatic };
  VesselTree& own(Tree tree) { return tree == Tree::Portal ? trees_.portal : trees_.hepatic; }
  const VesselTree& other(Tree tree) { return tree == Tree::Portal ? trees_.hepatic : trees_.portal; }

  bool grow(Tree tree, const Point& terminal, bool toRoot);
  // A main branch from the root; where the liver's shape forbids it, it is pulled in.
  void lead(Tree tree, const Point& way, bool toRoot = false);

  const Distance& liver_mm_;
  int attempt_;
  Random random_;
  LiverVessels trees_;
};

bool Growth::grow(Tree tree, const Point& terminal, bool toRoot) {
  VesselTree& grown = own(tree);
  const VesselTree& beside = other(tree);
  return grown.add(
      terminal,
      [&](const Point& a, const Point& b, double early) {
        // A young tree's few branches stand for more flow than they will carry: rarely over 60 % of it.
        const double radius = std::min(early, 0.84 * grown.rootRadius_mm());
        return inside(liver_mm_, a, b, radius) && clear(beside, a, b, radius, treeGap_mm, false) &&
               clear(grown, a, b, radius, 0.0, true);
      },
      toRoot);
}

void Growth::lead(Tree tree, const Point& way, bool toRoot) {
  const Point from = own(tree).nodes().front().p_lps_mm;
  Point to = from + way;
  for (int i = 0; i < 3; ++i) to[i] += std::min(attempt_, 12) * random_.uniform(-2.0, 2.0);
  for (int i = 0; i < 12; ++i) {
    if (liver_mm_(to) < -8.0 && grow(tree, to, toRoot)) return;
    to = from + 0.92 * (to - from) + Point(random_.uniform(-3, 3), random_.uniform(-3, 3), random_.uniform(-3, 3));
  }
}

// The first terminals make the main branches of textbook anatomy.
void Growth::mainBranches() {
  lead(Tree::Portal, Point(-62, 14, -6));           // right trunk
  lead(Tree::Hepatic, Point(-84, 10, -34), true);   // right vein
  lead(Tree::Portal, Point(34, -44, 30), true);     // left trunk, umbilical portion
  lead(Tree::Hepatic, Point(-22, -58, -40), true);  // middle vein
  lead(Tree::Hepatic, Point(46, -50, -12));         // left vein
  lead(Tree::Portal, Point(-58, -34, 24));          // right anterior
  lead(Tree::Portal, Point(-56, 20, -58));          // right posterior, inferior
  lead(Tree::Portal, Point(-66, 24, 44));           // right posterior, superior
}

void Growth::terminals(const Point& low, const Point& high) {
  const Point extent = high - low;
  const auto leaves = [&](Tree tree) { return own(tree).leaves(); };
  double reach_mm = 26.0;  // a terminal far from the tree serves more tissue: take the far ones first
  int misses = 0;
  while ((leaves(Tree::Portal) < portalTerminals || leaves(Tree::Hepatic) < hepaticTerminals) && reach_mm > 5.0) {
    const Point p = low + extent.cwiseProduct(Point(random_.uniform(), random_.uniform(), random_.uniform()));
    if (liver_mm_(p) > -4.5) continue;
    const bool portal = leaves(Tree::Portal) * hepaticTerminals <= leaves(Tree::Hepatic) * portalTerminals;
    const Tree tree = portal ? Tree::Portal : Tree::Hepatic;
    if (own(tree).distance_mm(p) > reach_mm && grow(tree, p, false)) {
      misses = 0;
    } else if (++misses > 40) {
      reach_mm *= 0.95;
      misses = 0;
    }
  }
}

void Growth::curve() {
  for (;;) {
    trees_.portal.curve();
    trees_.hepatic.curve();
    if (const int i = leaving(trees_.portal, liver_mm_); i > 0) {
      trees_.portal.prune(i);
    } else if (const int j = leaving(trees_.hepatic, liver_mm_); j > 0) {
      trees_.hepatic.prune(j);
    } else if (const auto c = conflict(trees_)) {
      (c->first == 0 ? trees_.portal : trees_.hepatic).prune(c->second);
    } else {
      return;
    }
  }
}

}  // namespace

LiverVessels growVessels(const Distance& liver_mm, const Point& low, const Point& high, const Point& portalHilum,
                         const Point& hepaticConfluence, std::uint64_t seed) {
  // Where the main branches got into each other's way, or a trunk had to go, other main branches are tried.
  for (int attempt = 0; attempt < 40; ++attempt) {
    Growth growth(liver_mm, portalHilum, hepaticConfluence, seed, attempt);
    growth.mainBranches();
    growth.terminals(low, high);
    growth.curve();
    const LiverVessels& v = growth.trees();
    if (10 * v.portal.leaves() >= 8 * portalTerminals && 10 * v.hepatic.leaves() >= 8 * hepaticTerminals) return v;
  }
  throw BadArgument("phantom: no room for two vein trees in the liver of seed " + std::to_string(seed));
}

}  // namespace glisson::phantom
