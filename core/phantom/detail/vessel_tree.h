// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "phantom/detail/shape.h"

namespace glisson::phantom {

/// A tree of veins, grown terminal by terminal: each new terminal joins where the blood volume grows least
/// (constrained constructive optimisation [schreiner1993computer]). Radii obey Murray's law exactly:
///   r_parent³ = Σ r_child³, since r = rootRadius (leaves below / all leaves)^(1/3).
class VesselTree {
 public:
  /// A branching point or an end.
  struct Node {
    Point p_lps_mm = Point::Zero();
    int parent = -1;  ///< -1: the root
    std::vector<int> children;
    int leaves = 0;                  ///< terminals at or below this node
    std::vector<Point> path_lps_mm;  ///< gently curved way from the parent to this node, both ends included
  };

  /// rootRadius_mm: of a (virtual) vessel that holds the whole flow.
  VesselTree(const Point& root_lps_mm, double rootRadius_mm);

  const std::vector<Node>& nodes() const { return nodes_; }
  double rootRadius_mm() const { return rootRadius_mm_; }
  int leaves() const { return nodes_.front().leaves; }

  /// Radius of the segment that ends in this node, mm.
  double radius_mm(int node) const;

  using Allowed = std::function<bool(const Point& a, const Point& b, double radius_mm)>;
  /// Joins a terminal to the tree, or to the root directly. Returns whether a permitted place was found.
  bool add(const Point& terminal, const Allowed& allowed, bool toRoot = false);

  /// Distance from p to the nearest centre line, mm.
  double distance_mm(const Point& p) const;

  /// Fills path_lps_mm with curves through the nodes.
  void curve();

  /// Takes a node and all below it away; its parent, left with one child, stays as a bend.
  void prune(int node);

 private:
  /// Where a new terminal would leave a segment, and the radii once it is there.
  struct Fork {
    int segment = 0;  ///< the node that it ends in
    Point p_lps_mm = Point::Zero();
    double parentRadius_mm = 0.0, childRadius_mm = 0.0, terminalRadius_mm = 0.0;
  };

  Node& at(int node) { return nodes_[static_cast<std::size_t>(node)]; }
  const Node& at(int node) const { return nodes_[static_cast<std::size_t>(node)]; }
  /// Of a segment with so many terminals below it, in a tree of one terminal more.
  double radiusOnceAdded_mm(int leavesBelow) const;
  /// One leaf more for a new terminal and every node above it.
  void countLeaf(int terminal);
  bool joinRoot(const Point& terminal, const Allowed& allowed);
  /// Nodes in which the segments nearest to p end, nearest first.
  std::vector<int> nearestSegments(const Point& p, std::size_t most) const;
  Fork forkOf(int segment, const Point& terminal) const;
  /// Whether the fork keeps away from the three places that it joins.
  bool hasRoom(const Fork& fork, const Point& terminal) const;
  /// Blood volume that the tree gains, over π.
  double costOf(const Fork& fork, const Point& terminal) const;
  void split(const Fork& fork, const Point& terminal);
  void recount();
  std::vector<Node> nodes_;
  double rootRadius_mm_;
};

/// The two trees of a synthetic liver.
struct LiverVessels {
  VesselTree portal;
  VesselTree hepatic;
};

/// Grows the portal and the hepatic tree in turns inside the liver, so that both reach everywhere and never touch.
/// liver_mm: signed distance, negative inside. low, high: a box that holds the liver, LPS mm.
LiverVessels growVessels(const std::function<double(const Point&)>& liver_mm, const Point& low, const Point& high,
                         const Point& portalHilum, const Point& hepaticConfluence, std::uint64_t seed);

}  // namespace glisson::phantom
