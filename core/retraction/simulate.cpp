#include "retraction/simulate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "mechanics/dynamics.h"
#include "mechanics/measures.h"
#include "mechanics/meshfree.h"
#include "mechanics/static_solve.h"
#include "retraction/body.h"

namespace glisson::retraction {
namespace {

constexpr double mToMm = 1e3;

/// What the solvers give back, whatever the model.
struct Answer {
  mechanics::Solution solution;
  int dofs = 0;
  int steps = 0;
};

Answer solve(const mechanics::Problem& problem, const Setup& setup, const Progress& progress);

image::DisplacementField atCellCentres(const Body& body, const image::Grid& grid, const mechanics::NodalField& u_m) {
  image::DisplacementField field(grid, Eigen::Vector3f::Zero());
  for (int cell = 0; cell < body.mesh().cellCount(); ++cell) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int node : body.mesh().nodesOf(cell)) sum += u_m.col(node);
    field.at(body.mesh().cellOf(cell)) = body.vectorToLps(mToMm * sum / 8.0).cast<float>();
  }
  return field;
}

}  // namespace

}  // namespace glisson::retraction
