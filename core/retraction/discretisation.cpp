#include "retraction/discretisation.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"

namespace glisson::retraction {
namespace {

/// Centres of the body's cells, mm (LPS).
std::vector<Eigen::Vector3d> centres(const retraction::Model& model) {
  const image::Grid& g = model.youngs_kPa.grid;
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i)
        if (model.youngs_kPa.at(i, j, k) > 0) points.push_back(g.indexToLps(Eigen::Vector3d(i, j, k)));
  return points;
}

/// Bodies up to this size are split rather than merged where merging would change their shape: a second or two.
constexpr std::size_t splitLimit = 20000;

/// Every merged cell would be made of eight filled ones: the coarse body is the same body.
bool mergesExactly(const retraction::Model& model) {
  const image::Grid& g = model.youngs_kPa.grid;
  if (g.size.x() % 2 != 0 || g.size.y() % 2 != 0 || g.size.z() % 2 != 0) return false;
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i)
        if ((model.youngs_kPa.at(i, j, k) > 0) != (model.youngs_kPa.at(i - i % 2, j - j % 2, k - k % 2) > 0))
          return false;
  return true;
}

void requireConverged(const retraction::Result& r) {
  if (!r.solver.converged())
    throw SolverFailed("the solve on the other grid did not converge", r.solver.iterations, r.solver.residual,
                       r.solver.tolerance);
}

/// The answer in larger tetrahedra: twice the edge, or as near to it as the mesher's gates allow; in `ratio` how many
/// times. Throws what the mesher says where not even one and a half times the edge pass.
retraction::Result inLargerTetrahedra(const retraction::Model& model, retraction::Setup setup, double& ratio,
                                      const Progress& progress) {
  const double cell_mm = setup.model.cell_mm, tool_mm = setup.model.toolCell_mm;
  for (ratio = 2.0;; ratio -= 0.25) {
    setup.model.cell_mm = ratio * cell_mm;
    setup.model.toolCell_mm = ratio * tool_mm;
    try {
      return retraction::simulate(model, setup, {}, progress);
    } catch (const BadInput&) {
      if (ratio < 1.6) throw;
    }
  }
}

}  // namespace

retraction::Model coarsened(const retraction::Model& model) {
  const image::Grid& g = model.youngs_kPa.grid;
  image::Grid coarse = g;
  coarse.size = (g.size + Eigen::Vector3i::Ones()) / 2;
  coarse.spacing_mm = 2.0 * g.spacing_mm;
  coarse.origin_lps_mm = g.indexToLps(Eigen::Vector3d::Constant(0.5));
  image::ScalarVolume E(coarse, 0.0f);
  for (int k = 0; k < coarse.size.z(); ++k)
    for (int j = 0; j < coarse.size.y(); ++j)
      for (int i = 0; i < coarse.size.x(); ++i) {
        double sum = 0.0;
        int filled = 0;
        for (int a = 0; a < 8; ++a) {
          const Eigen::Vector3i fine(2 * i + (a & 1), 2 * j + (a >> 1 & 1), 2 * k + (a >> 2 & 1));
          if (!g.contains(fine) || !(model.youngs_kPa.at(fine) > 0)) continue;
          sum += static_cast<double>(model.youngs_kPa.at(fine));
          ++filled;
        }
        if (filled >= 4) E.at(i, j, k) = static_cast<float>(sum / filled);
      }
  return retraction::makeModel(std::move(E), model.poisson, model.density, false);
}

retraction::Model refined(const retraction::Model& model) {
  const image::Grid& g = model.youngs_kPa.grid;
  image::Grid fine = g;
  fine.size = 2 * g.size;
  fine.spacing_mm = 0.5 * g.spacing_mm;
  fine.origin_lps_mm = g.indexToLps(Eigen::Vector3d::Constant(-0.25));
  image::ScalarVolume E(fine);
  for (int k = 0; k < fine.size.z(); ++k)
    for (int j = 0; j < fine.size.y(); ++j)
      for (int i = 0; i < fine.size.x(); ++i) E.at(i, j, k) = model.youngs_kPa.at(i / 2, j / 2, k / 2);
  return retraction::makeModel(std::move(E), model.poisson, model.density, false);
}

retraction::Setup held(const retraction::Setup& setup, const retraction::Model& model,
                       const retraction::Result& result) {
  retraction::Setup s = setup;
  for (retraction::LoadSpec& load : s.loads)
    if (auto* bar = std::get_if<retraction::Retractor>(&load)) {
      if (!bar->at_mm && result.retractorPoint_mm) bar->at_mm = result.retractorPoint_mm;
      if (!bar->force_N) bar->force_N = model.mass_kg * defaults::gravity_m_s2;
    }
  return s;
}

DiscretisationError discretisationError(const retraction::Model& model, const retraction::Setup& setup,
                                        const retraction::Result& result, const Progress& progress) {
  DiscretisationError e;
  e.cell_mm = model.youngs_kPa.grid.spacing_mm.maxCoeff();
  e.coarse_mm = 2.0 * e.cell_mm;
  try {
    retraction::Setup voxels = held(setup, model, result);
    const bool frames = setup.model.kind == retraction::ModelKind::Meshfree;
    if (frames) {
      voxels.model.kind = retraction::ModelKind::FemHex;
      voxels.solver = {};
    }
    const std::vector<Eigen::Vector3d> points = centres(model);
    const std::vector<Eigen::Vector3d> own = retraction::displacementAt(model, result, points);
    std::vector<Eigen::Vector3d> fine = own;
    if (frames) {
      const retraction::Result full = retraction::simulate(model, voxels, {}, progress.part(0.0, 0.8));
      requireConverged(full);
      fine = retraction::displacementAt(model, full, points);
    }
    // Tetrahedra of their own size: the same body, in cells twice as large.
    const bool delaunay = setup.model.kind == retraction::ModelKind::FemTet && setup.model.delaunay;
    if (delaunay) e.cell_mm = setup.model.cell_mm;
    const bool split = setup.model.kind == retraction::ModelKind::FemHex &&
                       setup.kinematics == retraction::Kinematics::Linear && model.cells <= splitLimit &&
                       !mergesExactly(model);
    const retraction::Model half = delaunay ? model : split ? refined(model) : coarsened(model);
    const Progress rest = progress.part(frames ? 0.8 : 0.0, 1.0);
    double ratio = 2.0;
    const retraction::Result rough =
        delaunay ? inLargerTetrahedra(half, voxels, ratio, rest) : retraction::simulate(half, voxels, {}, rest);
    e.coarse_mm = (split ? 0.5 : ratio) * e.cell_mm;
    requireConverged(rough);
    const std::vector<Eigen::Vector3d> coarse = retraction::displacementAt(half, rough, points);
    std::vector<double> error;
    for (std::size_t i = 0; i < points.size(); ++i) {
      // An error e of first order differs by e (ratio − 1) from that of larger cells, and by e / 2 from that of half
      // cells.
      const double d = (own[i] - fine[i]).norm() + (split ? 2.0 : 1.0 / (ratio - 1.0)) * (fine[i] - coarse[i]).norm();
      if (std::isfinite(d)) error.push_back(d);
    }
    if (error.empty()) throw BadInput("no cell of one grid lies inside the other");
    for (const double d : error) e.mean_mm += d / static_cast<double>(error.size());
    std::sort(error.begin(), error.end());
    e.max_mm = error.back();
    e.p95_mm = error[static_cast<std::size_t>(0.95 * static_cast<double>(error.size() - 1))];
    e.known = true;
    std::ostringstream t;
    t.precision(3);
    t << "discretisation error about " << e.mean_mm << " mm on average, " << e.p95_mm << " mm for 95 % of the body, "
      << e.max_mm << " mm at most (cells of " << e.cell_mm << " mm against " << e.coarse_mm << " mm)";
    e.note = t.str();
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& why) {
    e.note = std::string("discretisation error unknown: ") + why.what();
  }
  return e;
}

}  // namespace glisson::retraction
