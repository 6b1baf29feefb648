// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/detail/delaunay.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Random.h>
#include <CGAL/assertions_behaviour.h>
#include <CGAL/exude_mesh_3.h>
#include <CGAL/make_mesh_3.h>
#include <CGAL/perturb_mesh_3.h>

#include <unordered_map>
#include <utility>

#include "base/error.h"

namespace glisson::anatomy {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Labelled = CGAL::Labeled_mesh_domain_3<Kernel>;

constexpr unsigned int seed = 1;
constexpr double pointError = 1e-5;  // of a point on the surface, relative to the box

/// The body, with start points of our own: random rays would miss small parts.
class Domain : public Labelled {
 public:
  Domain(const Labelled& body, const std::vector<Point>& onSurface) : Labelled(body), onSurface_(onSurface) {}

  struct Construct_initial_points {
    const Domain& domain;
    template <class Output>
    Output operator()(Output out, int = 0) const {
      const auto index = domain.index_from_surface_patch_index(Surface_patch_index(0, 1));
      for (const Point& p : domain.onSurface_) *out++ = std::make_pair(p, index);
      return out;
    }
  };
  Construct_initial_points construct_initial_points_object() const { return {*this}; }

 private:
  std::vector<Point> onSurface_;
};

using Triangulation = CGAL::Mesh_triangulation_3<Domain, Kernel, CGAL::Sequential_tag>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

Eigen::Vector3d vector(const Point& p) {
  return {p.x(), p.y(), p.z()};
}

struct Size {
  using FT = Kernel::FT;
  const std::function<double(const Eigen::Vector3d&)>* size_mm;
  template <class Any>
  FT operator()(const Point& p, int, const Any&) const {
    return (*size_mm)(vector(p));
  }
};

Complex refine(const Domain& domain, const DelaunayCriteria& c) {
  namespace with = CGAL::parameters;
  const Size size{&c.size_mm};
  if (!c.cells) {
    const Criteria criteria(with::facet_angle = c.facetAngle_deg, with::facet_size = size,
                            with::facet_distance = c.distance_mm);
    return CGAL::make_mesh_3<Complex>(domain, criteria, with::manifold(), with::no_perturb(), with::no_exude());
  }
  const Criteria criteria(with::facet_angle = c.facetAngle_deg, with::facet_size = size,
                          with::facet_distance = c.distance_mm, with::cell_radius_edge_ratio = c.radiusEdge,
                          with::cell_size = size);
  Complex mesh = CGAL::make_mesh_3<Complex>(domain, criteria, with::manifold(), with::no_perturb(), with::no_exude());
  CGAL::perturb_mesh_3(mesh, domain, with::sliver_bound = c.sliverAngle_deg);
  CGAL::exude_mesh_3(mesh, with::sliver_bound = c.sliverAngle_deg);
  return mesh;
}

}  // namespace

DelaunayCells delaunayCells(const std::function<double(const Eigen::Vector3d&)>& depth, const Eigen::Vector3d& low,
                            const Eigen::Vector3d& high, const std::vector<Eigen::Vector3d>& onSurface,
                            const DelaunayCriteria& criteria, const Progress& progress) {
  std::vector<Point> start;
  start.reserve(onSurface.size());
  for (const Eigen::Vector3d& p : onSurface) start.emplace_back(p.x(), p.y(), p.z());
  // Asked hundreds of thousands of times: the one place where a running refinement can be left.
  long asked = 0;
  const std::function<int(const Point&)> label = [&](const Point& p) {
    if (++asked % 4096 == 0) progress.check();
    return depth(vector(p)) > 0.0 ? 1 : 0;
  };
  // What CGAL warns of is no cell at all, which the caller tells in its own words; nothing may go to the console.
  CGAL::set_warning_handler([](const char*, const char*, const char*, int, const char*) {});
  CGAL::get_default_random() = CGAL::Random(seed);
  try {
    const CGAL::Bbox_3 box(low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
    const Domain domain(Labelled(label, box, pointError), start);
    const Complex mesh = refine(domain, criteria);

    DelaunayCells result;
    std::unordered_map<const void*, int> number;
    std::vector<Eigen::Vector3d> points;
    std::vector<Eigen::Vector4i> cells;
    for (auto cell = mesh.cells_in_complex_begin(); cell != mesh.cells_in_complex_end(); ++cell) {
      Eigen::Vector4i corners;
      for (int v = 0; v < 4; ++v) {
        const auto vertex = cell->vertex(v);
        const auto [at, fresh] =
            number.try_emplace(static_cast<const void*>(&*vertex), static_cast<int>(points.size()));
        if (fresh) points.emplace_back(vertex->point().x(), vertex->point().y(), vertex->point().z());
        corners[v] = at->second;
      }
      cells.push_back(corners);
    }
    result.points.resize(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t p = 0; p < points.size(); ++p) result.points.col(static_cast<Eigen::Index>(p)) = points[p];
    result.cells.resize(4, static_cast<Eigen::Index>(cells.size()));
    for (std::size_t c = 0; c < cells.size(); ++c) result.cells.col(static_cast<Eigen::Index>(c)) = cells[c];
    return result;
  } catch (const CGAL::Failure_exception& e) {
    throw Error("the Delaunay refinement of the organ failed (" + std::string(e.expression()) +
                "); try another cell size");
  }
}

}  // namespace glisson::anatomy
