// SPDX-License-Identifier: GPL-3.0-or-later
#include "phantom/detail/vessel_tree.h"

#include <array>
#include <numeric>
#include <optional>

namespace glisson::phantom {
namespace {

// Weighted Fermat point of a parent, a child and a new terminal: least volume for given radii (Weiszfeld's iteration).
Point bifurcation(const std::array<Point, 3>& ends, const std::array<double, 3>& radius) {
  Point b = Point::Zero();
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    b += radius[i] * radius[i] * ends[i];
    sum += radius[i] * radius[i];
  }
  b /= sum;
  for (int iteration = 0; iteration < 14; ++iteration) {
    Point next = Point::Zero();
    sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double w = radius[i] * radius[i] / std::max((b - ends[i]).norm(), 1e-3);
      next += w * ends[i];
      sum += w;
    }
    b = next / sum;
  }
  return b;
}

double pointToSegment_mm(const Point& p, const Point& a, const Point& b) {
  return Capsule{a, b, 0.0}.distance_mm(p);
}

}  // namespace

VesselTree::VesselTree(const Point& root_lps_mm, double rootRadius_mm) : rootRadius_mm_(rootRadius_mm) {
  Node root;
  root.p_lps_mm = root_lps_mm;
  nodes_.push_back(root);
}

double VesselTree::radius_mm(int node) const {
  const auto n = static_cast<std::size_t>(node);
  return rootRadius_mm_ * std::cbrt(static_cast<double>(nodes_[n].leaves) / static_cast<double>(std::max(leaves(), 1)));
}

double VesselTree::distance_mm(const Point& p) const {
  double d = (p - nodes_.front().p_lps_mm).norm();
  for (std::size_t i = 1; i < nodes_.size(); ++i)
    d = std::min(d,
                 pointToSegment_mm(p, nodes_[static_cast<std::size_t>(nodes_[i].parent)].p_lps_mm, nodes_[i].p_lps_mm));
  return d;
}

double VesselTree::radiusOnceAdded_mm(int leavesBelow) const {
  return rootRadius_mm_ * std::cbrt(static_cast<double>(leavesBelow) / static_cast<double>(leaves() + 1));
}

void VesselTree::countLeaf(int terminal) {
  for (int i = terminal; i >= 0; i = at(i).parent) ++at(i).leaves;
}

bool VesselTree::joinRoot(const Point& terminal, const Allowed& allowed) {
  if (!allowed(nodes_.front().p_lps_mm, terminal, radiusOnceAdded_mm(1))) return false;
  Node leaf;
  leaf.p_lps_mm = terminal;
  leaf.parent = 0;
  nodes_.push_back(leaf);
  nodes_.front().children.push_back(static_cast<int>(nodes_.size()) - 1);
  countLeaf(static_cast<int>(nodes_.size()) - 1);
  return true;
}

std::vector<int> VesselTree::nearestSegments(const Point& p, std::size_t most) const {
  std::vector<int> near(nodes_.size() - 1);
  std::iota(near.begin(), near.end(), 1);
  std::vector<double> distance(nodes_.size());
  for (const int i : near)
    distance[static_cast<std::size_t>(i)] = pointToSegment_mm(p, at(at(i).parent).p_lps_mm, at(i).p_lps_mm);
  std::stable_sort(near.begin(), near.end(), [&](int a, int b) {
    return distance[static_cast<std::size_t>(a)] < distance[static_cast<std::size_t>(b)];
  });
  near.resize(std::min(near.size(), most));
  return near;
}

VesselTree::Fork VesselTree::forkOf(int segment, const Point& terminal) const {
  const Point& parent = at(at(segment).parent).p_lps_mm;
  const Point& child = at(segment).p_lps_mm;
  Fork f;
  f.segment = segment;
  f.parentRadius_mm = radiusOnceAdded_mm(at(segment).leaves + 1);
  f.childRadius_mm = radiusOnceAdded_mm(at(segment).leaves);
  f.terminalRadius_mm = radiusOnceAdded_mm(1);
  f.p_lps_mm = bifurcation({parent, child, terminal}, {f.parentRadius_mm, f.childRadius_mm, f.terminalRadius_mm});
  return f;
}

bool VesselTree::hasRoom(const Fork& f, const Point& terminal) const {
  const Point& parent = at(at(f.segment).parent).p_lps_mm;
  const Point& child = at(f.segment).p_lps_mm;
  return !((f.p_lps_mm - parent).norm() < std::max(3.0, 1.2 * f.parentRadius_mm) ||
           (f.p_lps_mm - child).norm() < std::max(3.0, 1.2 * f.childRadius_mm) || (f.p_lps_mm - terminal).norm() < 4.0);
}

double VesselTree::costOf(const Fork& f, const Point& terminal) const {
  const Point& parent = at(at(f.segment).parent).p_lps_mm;
  const Point& child = at(f.segment).p_lps_mm;
  const double rParent = f.parentRadius_mm, rChild = f.childRadius_mm, rNew = f.terminalRadius_mm;
  double cost = rParent * rParent * (f.p_lps_mm - parent).norm() + rChild * rChild * (f.p_lps_mm - child).norm() +
                rNew * rNew * (f.p_lps_mm - terminal).norm() - rChild * rChild * (child - parent).norm();
  for (int k = at(f.segment).parent; k > 0; k = at(k).parent) {  // the way to the root widens by one terminal's flow
    const double now = radiusOnceAdded_mm(at(k).leaves);
    const double then = radiusOnceAdded_mm(at(k).leaves + 1);
    cost += (then * then - now * now) * (at(k).p_lps_mm - at(at(k).parent).p_lps_mm).norm();
  }
  return cost;
}

void VesselTree::split(const Fork& chosen, const Point& terminal) {
  const int fork = static_cast<int>(nodes_.size());
  const int leaf = fork + 1;
  const int parent = at(chosen.segment).parent;
  Node f;
  f.p_lps_mm = chosen.p_lps_mm;
  f.parent = parent;
  f.children = {chosen.segment, leaf};
  f.leaves = at(chosen.segment).leaves;
  Node l;
  l.p_lps_mm = terminal;
  l.parent = fork;
  nodes_.push_back(f);
  nodes_.push_back(l);
  std::replace(at(parent).children.begin(), at(parent).children.end(), chosen.segment, fork);
  at(chosen.segment).parent = fork;
  countLeaf(leaf);
}

bool VesselTree::add(const Point& terminal, const Allowed& allowed, bool toRoot) {
  if (toRoot || nodes_.size() == 1) return joinRoot(terminal, allowed);
  std::optional<Fork> best;
  double bestCost = 0.0;
  for (const int segment : nearestSegments(terminal, 14)) {
    const Fork f = forkOf(segment, terminal);
    if (!hasRoom(f, terminal)) continue;
    const double cost = costOf(f, terminal);
    if (best && cost >= bestCost) continue;
    if (!allowed(at(at(segment).parent).p_lps_mm, f.p_lps_mm, f.parentRadius_mm) ||
        !allowed(f.p_lps_mm, at(segment).p_lps_mm, f.childRadius_mm) ||
        !allowed(f.p_lps_mm, terminal, f.terminalRadius_mm))
      continue;
    best = f;
    bestCost = cost;
  }
  if (!best) return false;
  split(*best, terminal);
  return true;
}

void VesselTree::curve() {
  // A cubic Hermite curve per segment; the widest child leaves in the direction in which its parent arrives.
  auto direction = [&](int i) -> Point {
    const Node& n = nodes_[static_cast<std::size_t>(i)];
    return (n.p_lps_mm - nodes_[static_cast<std::size_t>(n.parent)].p_lps_mm).normalized();
  };
  auto widestChild = [&](int i) {
    int widest = -1;
    for (const int c : nodes_[static_cast<std::size_t>(i)].children)
      if (widest < 0 || nodes_[static_cast<std::size_t>(c)].leaves > nodes_[static_cast<std::size_t>(widest)].leaves)
        widest = c;
    return widest;
  };
  auto tangentAt = [&](int i) -> Point {
    const int w = widestChild(i);
    if (i == 0) return w < 0 ? Point::UnitZ().eval() : direction(w);
    return w < 0 ? direction(i) : Point(direction(i) + direction(w)).normalized();
  };
  for (std::size_t i = 1; i < nodes_.size(); ++i) {
    const int self = static_cast<int>(i);
    const int parent = nodes_[i].parent;
    const Point& a = nodes_[static_cast<std::size_t>(parent)].p_lps_mm;
    const Point& b = nodes_[i].p_lps_mm;
    const double length = (b - a).norm();
    const bool main = widestChild(parent) == self;
    const Point start =
        main ? tangentAt(parent) : Point(0.65 * direction(self) + 0.35 * tangentAt(parent)).normalized();
    const Point end = tangentAt(self);
    const int pieces = std::max(2, static_cast<int>(std::ceil(length / 3.0)));
    std::vector<Point> path;
    for (int s = 0; s <= pieces; ++s) {
      const double t = static_cast<double>(s) / pieces;
      const double t2 = t * t;
      const double t3 = t2 * t;
      path.push_back((2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * length * start + (-2 * t3 + 3 * t2) * b +
                     (t3 - t2) * length * end);
    }
    path.front() = a;
    path.back() = b;
    nodes_[i].path_lps_mm = std::move(path);
  }
}

void VesselTree::prune(int node) {
  std::vector<bool> gone(nodes_.size(), false);
  std::vector<int> stack{node};
  while (!stack.empty()) {
    const int i = stack.back();
    stack.pop_back();
    gone[static_cast<std::size_t>(i)] = true;
    for (const int c : nodes_[static_cast<std::size_t>(i)].children) stack.push_back(c);
  }
  // A fork that has lost all its children would become a terminal of no flow: it goes as well.
  for (int i = nodes_[static_cast<std::size_t>(node)].parent; i > 0; i = nodes_[static_cast<std::size_t>(i)].parent) {
    const auto& children = nodes_[static_cast<std::size_t>(i)].children;
    if (!std::all_of(children.begin(), children.end(), [&](int c) { return gone[static_cast<std::size_t>(c)]; })) break;
    gone[static_cast<std::size_t>(i)] = true;
  }
  std::vector<int> renamed(nodes_.size(), -1);
  std::vector<Node> kept;
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    if (!gone[i]) {
      renamed[i] = static_cast<int>(kept.size());
      kept.push_back(nodes_[i]);
    }
  for (Node& n : kept) {
    if (n.parent >= 0) n.parent = renamed[static_cast<std::size_t>(n.parent)];
    std::vector<int> children;
    for (const int c : n.children)
      if (renamed[static_cast<std::size_t>(c)] >= 0) children.push_back(renamed[static_cast<std::size_t>(c)]);
    n.children = std::move(children);
  }
  nodes_ = std::move(kept);
  recount();
}

void VesselTree::recount() {
  for (Node& n : nodes_) n.leaves = 0;
  for (std::size_t i = 1; i < nodes_.size(); ++i)
    if (nodes_[i].children.empty())
      for (int k = static_cast<int>(i); k >= 0; k = nodes_[static_cast<std::size_t>(k)].parent)
        ++nodes_[static_cast<std::size_t>(k)].leaves;
}

}  // namespace glisson::phantom
