// SPDX-License-Identifier: GPL-3.0-or-later

// A cantilever of voxels under a body force, against beam theory.
//
//     z                                               E = 12 kPa, nu = 0.45
//     |   ////|=========================|             50 x 10 x 10 mm, 30 x 6 x 6 cells
//     +-- x   |  force per volume, down |             load: the Euler-Bernoulli tip moves by 1 mm
//
// usage: 01_beam      exit code 0 if the tip is within 2 % of the converged three-dimensional solution
#include <cmath>
#include <cstdio>

#include "mechanics/beam.h"
#include "mechanics/loads.h"
#include "mechanics/measures.h"
#include "mechanics/static_solve.h"

int main() {
  using namespace glisson::mechanics;
  const Cantilever beam;

  // 1. The body: equal boxes with one Young's modulus each, SI units.
  VoxelBody body;
  body.cells = {30, 6, 6};
  body.h_m = Eigen::Vector3d(beam.length_m, beam.width_m, beam.height_m).cwiseQuotient(body.cells.cast<double>());
  body.E_Pa.assign(static_cast<std::size_t>(body.cells.prod()), beam.E_Pa);
  body.poisson = beam.poisson;
  const VoxelMesh mesh(body);

  // 2. Supports: every node of the face at x = 0 is held in all directions.
  std::vector<Face> root;
  for (const Face& face : exteriorFaces(mesh))
    if (face.side == 0 && faceCentre_m(mesh, face).x() == 0.0) root.push_back(face);
  Supports supports;
  supports.fixations = fix(nodesOfFaces(mesh, root));

  // 3. The load, as nodal forces.
  const double f_N_m = loadForTip_N_m(beam, 1e-3);
  const NodalField f_N = bodyForce(mesh, {0, 0, -f_N_m / beam.area_m2()});

  // 4. Solve K u = f. A solve that did not converge says so in its report; nothing is thrown.
  const Solution answer = solveStatic({body, supports, f_N});
  std::printf("%s: %d iterations, residual %.1e\n", answer.report.kind.c_str(), answer.report.iterations,
              answer.report.residual);
  if (!answer.report.converged()) return 1;

  // 5. Read it: displacement at points, reaction of the supports.
  double tip_mm = 0.0;
  std::printf("   x mm   voxels  Timoshenko  Euler-Bernoulli (mm, down)\n");
  for (const double part : {0.25, 0.5, 0.75, 1.0}) {
    const double x = part * beam.length_m;
    const auto u = displacementAt(mesh, answer.u_m, {x, beam.width_m / 2, beam.height_m / 2});
    tip_mm = -1e3 * u.value().z();
    std::printf("%7.1f %8.4f %11.4f %16.4f\n", 1e3 * x, tip_mm, 1e3 * timoshenkoDeflection_m(beam, f_N_m, x),
                1e3 * eulerBernoulliDeflection_m(beam, f_N_m, x));
  }
  const double missing_N = answer.reaction_N.row(2).sum() + f_N.row(2).sum();
  std::printf("reaction and load differ by %.1e N\n", std::abs(missing_N));
  const double converged_mm = 1.0046;  // of the clamped body in three dimensions: `glisson-cli validate` computes it
  return std::abs(tip_mm / converged_mm - 1) < 0.02 && std::abs(missing_N) < 1e-6 * std::abs(f_N.row(2).sum()) ? 0 : 1;
}
