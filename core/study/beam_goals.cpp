// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/beam_goals.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "mechanics/meshfree.h"
#include "mechanics/static_solve.h"
#include "study/beam.h"

namespace glisson::study {
namespace {

using mechanics::HexElement;
using mechanics::Kernel;

constexpr double allowed_mm = 0.0164, stretch_mm = 0.008, timesCloser = 20.0;

double furthest(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = std::abs(a[i] - b[i]);
    if (!(d <= worst)) worst = d;
  }
  return worst;
}

std::vector<double> voxelAxis_mm(const BeamOptions& o, const Eigen::Vector3i& cells, HexElement element,
                                 const Progress& progress) {
  const mechanics::Problem p = beamProblem(o, cells, Root::Clamped);
  mechanics::SolverOptions solver;
  solver.element = element;
  return axisDeflection_mm(mechanics::VoxelMesh(p.body), mechanics::solveStatic(p, solver, progress).u_m);
}

std::string millimetres(const char* what, double mm) {
  std::ostringstream t;
  t.precision(3);
  t << what << " " << mm << " mm";
  return t.str();
}

}  // namespace

std::string BeamGoal::line() const {
  std::ostringstream t;
  t.precision(3);
  t << (met() ? "met     " : "missed  ") << what << ", Poisson's ratio " << poisson << ": " << value << " " << quantity
    << (quantity == "mm" ? ", at most " : ", at least ") << limit;
  if (!met()) t << ", missed by " << std::abs(value - limit);
  if (!beside.empty()) t << " (" << beside << ")";
  return t.str();
}

std::vector<BeamGoal> beamGoals(const std::vector<double>& poissons, const Progress& progress) {
  std::vector<BeamGoal> goals;
  for (std::size_t i = 0; i < poissons.size(); ++i) {
    const double n = static_cast<double>(poissons.size());
    const Progress part = progress.part(static_cast<double>(i) / n, static_cast<double>(i + 1) / n);
    part.report(0.0, "goals of the beam");
    BeamOptions o;
    o.poisson = poissons[i];
    const std::vector<double> truth = convergedBeam(o, Root::Clamped, 24, part.part(0.0, 0.2)).axis_mm;
    const std::string gap =
        "Euler-Bernoulli lies " + millimetres("", std::abs(truth.back() - o.tip_mm)).substr(1) + " from 3-D at the tip";
    const auto add = [&](std::string what, const char* quantity, double value, double limit, std::string beside) {
      goals.push_back({std::move(what), o.poisson, quantity, value, limit, std::move(beside)});
    };
    for (const auto& [element, name] :
         {std::pair{HexElement::Incompatible, "incompatible modes"}, std::pair{HexElement::BBar, "B-bar"}})
      add(std::string("voxel FEM at 1.67 mm, ") + name, "mm",
          furthest(voxelAxis_mm(o, {30, 6, 6}, element, part.part(0.2, 0.25)), truth), allowed_mm, gap);

    const Eigen::Vector3i cells(60, 12, 12);
    const std::vector<double> under = voxelAxis_mm(o, cells, HexElement::Incompatible, part.part(0.25, 0.3));
    const mechanics::Problem problem = beamProblem(o, cells, Root::Clamped);
    const mechanics::VoxelMesh mesh(problem.body);
    struct Errors {
      double truth_mm, voxels_mm;
    };
    const auto frames = [&](Kernel kernel, int order, int dofs) {
      mechanics::MeshfreeOptions mo;
      mo.kernel = kernel;
      mo.order = order;
      mo.frames = dofs / (3 * mechanics::functionsOf(kernel, order));
      part.check();
      const auto axis = axisDeflection_mm(mesh, mechanics::MeshfreeModel(problem, mo).solveStatic().u_m);
      return Errors{furthest(axis, truth), furthest(axis, under)};
    };
    for (const int dofs : {720, 1800}) {
      part.report(dofs == 720 ? 0.3 : 0.6, "goals of the beam");
      const Errors faithful = frames(Kernel::Voronoi, 1, dofs);
      const std::string size = ", " + std::to_string(dofs) + " degrees of freedom";
      for (const auto& [kernel, name] :
           {std::pair{Kernel::Wendland, "Wendland quadratic"}, std::pair{Kernel::Mls, "MLS quadratic"}}) {
        const Errors ours = frames(kernel, 2, dofs);
        add(name + size, "mm", ours.truth_mm, dofs == 720 ? stretch_mm : allowed_mm,
            (dofs == 720 ? "stretch goal; " : "") + millimetres("published Voronoi frames", faithful.truth_mm) + "; " +
                gap);
        std::ostringstream alone;
        alone.precision(3);
        alone << faithful.voxels_mm / ours.voxels_mm << " times against the voxels under the frames";
        add(name + size + ", closer than the published Voronoi frames", "times", faithful.truth_mm / ours.truth_mm,
            timesCloser, alone.str());
      }
    }
  }
  progress.report(1.0, "goals of the beam");
  return goals;
}

}  // namespace glisson::study
