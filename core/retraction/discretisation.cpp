// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/discretisation.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <sstream>

#include "base/error.h"
#include "base/order_statistics.h"
#include "retraction/body.h"

namespace glisson::retraction {
namespace {

using Eigen::Vector3d;

/// Centres of the body's cells, mm (LPS).
std::vector<Vector3d> centres(const retraction::Model& model) {
  const image::Grid& g = model.youngs_kPa.grid;
  std::vector<Vector3d> points;
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

/// Cells in a line below which shape and bending are not resolved: two grids of one and two cells agree for the wrong
/// reason.
constexpr int fewCells = 3;

/// Share of the body's cells that lie, along some axis, in a run of at most fewCells from surface to surface.
double thinShare(const retraction::Model& model) {
  const image::Grid& g = model.youngs_kPa.grid;
  std::vector<char> thin(model.youngs_kPa.values.size(), 0);
  for (int axis = 0; axis < 3; ++axis) {
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    Eigen::Vector3i p;
    for (p[c] = 0; p[c] < g.size[c]; ++p[c])
      for (p[b] = 0; p[b] < g.size[b]; ++p[b])
        for (int begin = 0, end = 0; begin < g.size[axis]; begin = end + 1) {
          const auto filled = [&](int i) {
            p[axis] = i;
            return i < g.size[axis] && model.youngs_kPa.at(p) > 0;
          };
          for (end = begin; filled(end);) ++end;
          if (end - begin > fewCells) continue;
          for (int i = begin; i < end; ++i) {
            p[axis] = i;
            thin[g.linear(p)] = 1;
          }
        }
  }
  double count = 0.0;
  for (const char t : thin) count += t;
  return model.cells > 0 ? count / static_cast<double>(model.cells) : 0.0;
}

/// The scene's elements grow stiffer with ν on any cells, so that two grids agree on what both miss.
bool locks(const Setup& setup, double poisson) {
  if (poisson <= 0.49 || setup.kinematics == Kinematics::Hyperelastic) return false;
  return (setup.model.kind == ModelKind::FemHex && setup.model.element == mechanics::HexElement::H8) ||
         (setup.model.kind == ModelKind::FemTet && !setup.model.quadraticTets);
}

/// Nine incompatible modes lock so late that their distance from B-bar hexahedra is an honest share of the error.
bool locksSlightly(const Setup& setup, double poisson) {
  return poisson > 0.499 && setup.kinematics != Kinematics::Hyperelastic && setup.model.kind == ModelKind::FemHex &&
         setup.model.element == mechanics::HexElement::Incompatible;
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
  retraction::Model made = retraction::makeModel(std::move(E), model.poisson, model.density, false);
  made.smooth = model.smooth;
  return made;
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
  retraction::Model made = retraction::makeModel(std::move(E), model.poisson, model.density, false);
  made.smooth = model.smooth;
  return made;
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

namespace {

/// The contact's nodes at rest, or the samples of the surface that touch the bar, mm (LPS).
std::vector<Vector3d> contactPoints(const Model& model, const Result& result) {
  std::vector<Vector3d> points;
  if (result.contact) {
    for (std::size_t i = 0; i < result.contact->sample_mm.size(); ++i)
      if (result.contact->pressure_kPa[i] > 0) points.push_back(result.contact->sample_mm[i]);
    return points;
  }
  if (result.contactNodes.empty()) return points;
  const Body body(model);
  for (const int node : result.contactNodes) points.push_back(body.nodePosition_mm(node));
  return points;
}

/// What an answer misses at points, mm: NaN where one of the grids does not reach. An error e of first order differs by
/// e (ratio − 1) from that of larger cells, and by e / 2 from that of half cells.
struct Missed {
  std::vector<Vector3d> byModel;  ///< from the voxel FEM on the same cells, where the model is mesh-free; from B-bar
                                  ///< hexahedra, where the elements lock a little
  std::vector<Vector3d> byCells;
  double travel_mm = 0.0;  ///< of a rigid bar that a force drives
  double cell_mm = 0.0, coarse_mm = 0.0;
};

/// The answer of B-bar hexahedra on the same cells, which do not lock.
Result byBBar(const Model& model, Setup setup, const Result& result, const Progress& progress) {
  setup = held(setup, model, result);
  setup.model.kind = ModelKind::FemHex;
  setup.model.element = mechanics::HexElement::BBar;
  setup.solver = {};
  setup.condensed = false;
  Result r = simulate(model, setup, {}, progress);
  requireConverged(r);
  return r;
}

/// Why the error of elements that lock is not known, with what B-bar hexahedra say instead.
std::string lockingNote(const Model& model, const Setup& setup, const Result& result,
                        const std::vector<Vector3d>& points, const Progress& progress) {
  std::ostringstream t;
  t.precision(3);
  t << "discretisation error unknown: "
    << (setup.model.kind == ModelKind::FemHex ? "plain hexahedra" : "linear tetrahedra")
    << " are too stiff at a Poisson's ratio of " << model.poisson
    << " on cells of any size, so that two grids agree on "
    << "what both miss";
  if (!setup.model.delaunay) {
    const std::vector<Vector3d> other = displacementAt(model, byBBar(model, setup, result, progress), points);
    const std::vector<Vector3d> own = displacementAt(model, result, points);
    double mean = 0.0, most = 0.0;
    for (std::size_t i = 0; i < model.cells; ++i) {
      const double d = (own[i] - other[i]).norm();
      mean += d / static_cast<double>(model.cells);
      most = std::max(most, d);
    }
    t << "; B-bar hexahedra on the same cells are " << mean << " mm away on average, " << most << " mm at most";
  }
  t << ". Use \"H8-Bbar\", or quadratic tetrahedra";
  return t.str();
}

Missed missed(const Model& model, const Setup& setup, const Result& result, const std::vector<Vector3d>& points,
              const Progress& progress) {
  Missed m;
  Setup voxels = held(setup, model, result);
  const bool frames = setup.model.kind == ModelKind::Meshfree;
  if (frames) {
    voxels.model.kind = ModelKind::FemHex;
    voxels.solver = {};
  }
  const std::vector<Vector3d> own = displacementAt(model, result, points);
  std::vector<Vector3d> fine = own;
  if (frames) {
    const Result full = simulate(model, voxels, {}, progress.part(0.0, 0.8));
    requireConverged(full);
    fine = displacementAt(model, full, points);
  }
  if (locksSlightly(setup, model.poisson))
    fine = displacementAt(model, byBBar(model, setup, result, progress.part(0.0, 0.5)), points);
  const std::vector<Vector3d>& cellwise = frames ? fine : own;
  // Tetrahedra of their own size: the same body, in cells twice as large.
  const bool delaunay = setup.model.kind == ModelKind::FemTet && setup.model.delaunay;
  m.cell_mm = delaunay ? setup.model.cell_mm : model.youngs_kPa.grid.spacing_mm.maxCoeff();
  const bool thin = !delaunay && !result.contact && thinShare(model) > 0.5;
  const bool split = voxels.model.kind == ModelKind::FemHex && setup.kinematics == Kinematics::Linear &&
                     !result.contact && model.cells <= splitLimit && (thin || (!frames && !mergesExactly(model)));
  if (thin && !split)
    throw BadInput("most of the body is at most " + std::to_string(fewCells) +
                   " cells thick, so that cells of twice the edge say nothing of its error; use smaller cells");
  const Model other = delaunay ? model : split ? refined(model) : coarsened(model);
  const Progress rest = progress.part(frames ? 0.8 : 0.0, 1.0);
  double ratio = 2.0;
  const Result rough = delaunay ? inLargerTetrahedra(other, voxels, ratio, rest) : simulate(other, voxels, {}, rest);
  m.coarse_mm = (split ? 0.5 : ratio) * m.cell_mm;
  requireConverged(rough);
  const std::vector<Vector3d> coarse = displacementAt(other, rough, points);
  const double share = split ? 2.0 : 1.0 / (ratio - 1.0);
  if (result.contact && rough.contact && result.contact->asked_N > 0.0)
    m.travel_mm = share * (result.contact->travel_mm - rough.contact->travel_mm);
  for (std::size_t i = 0; i < points.size(); ++i) {
    m.byModel.push_back(own[i] - fine[i]);
    m.byCells.push_back(share * (cellwise[i] - coarse[i]));
  }
  return m;
}

std::vector<double> lengths(const Missed& m) {
  std::vector<double> l;
  for (std::size_t i = 0; i < m.byCells.size(); ++i) l.push_back(m.byModel[i].norm() + m.byCells[i].norm());
  return l;
}

std::vector<double> finite(const std::vector<double>& all, std::size_t begin, std::size_t end) {
  std::vector<double> some;
  for (std::size_t i = begin; i < end; ++i)
    if (std::isfinite(all[i])) some.push_back(all[i]);
  return some;
}

double meanOf(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v / static_cast<double>(values.size());
  return sum;
}

/// The places looked at: cells, then the contact, then landmarks.
struct Places {
  std::vector<Vector3d> all;
  std::size_t cells = 0, contact = 0;

  Places(const Model& model, const Result& result, const std::vector<Vector3d>& landmarks_mm) : all(centres(model)) {
    cells = all.size();
    const std::vector<Vector3d> touching = contactPoints(model, result);
    contact = touching.size();
    all.insert(all.end(), touching.begin(), touching.end());
    all.insert(all.end(), landmarks_mm.begin(), landmarks_mm.end());
  }
  std::vector<double> ofCells(const std::vector<double>& l) const { return finite(l, 0, cells); }
  /// Means (and the largest of the landmarks) where there is something to take them of. The tissue under a bar goes
  /// where the bar goes, so its travel counts at the retractor where that differs by more.
  template <class Told>
  void tell(const std::vector<double>& l, double travel_mm, Told& told) const {
    if (const auto there = finite(l, cells, cells + contact); !there.empty())
      told.at_retractor_mm = std::max(meanOf(there), std::abs(travel_mm));
    if (const auto vessels = finite(l, cells + contact, l.size()); !vessels.empty()) {
      told.vessels_mm = meanOf(vessels);
      told.vesselsMax_mm = *std::max_element(vessels.begin(), vessels.end());
    }
  }
};

/// What `own` and the second answer miss apart from each other; adds a sentence to the note. awaited: of the second
/// answer; none where both are one.
std::optional<DiscretisationError::OfDifference> ofDifference(Missed own, std::future<Missed>& awaited,
                                                              const Places& places, std::string& note) {
  const std::string what = "; of the difference of the two stiffnesses ";
  Missed other;
  try {
    other = awaited.valid() ? awaited.get() : own;
  } catch (const Error& why) {
    if (dynamic_cast<const Cancelled*>(&why)) throw;
    note += what + "unknown: " + why.what();
    return {};
  }
  for (std::size_t i = 0; i < places.all.size(); ++i) {
    own.byModel[i] -= other.byModel[i];
    own.byCells[i] -= other.byCells[i];
  }
  own.travel_mm -= other.travel_mm;
  const std::vector<double> all = lengths(own);
  DiscretisationError::OfDifference d;
  d.mean_mm = meanOf(places.ofCells(all));
  places.tell(all, own.travel_mm, d);
  std::ostringstream t;
  t.precision(3);
  t << what << "about " << d.mean_mm << " mm on average";
  if (d.at_retractor_mm) t << ", " << *d.at_retractor_mm << " mm at the retractor";
  if (d.vessels_mm) t << ", " << *d.vessels_mm << " mm at the vessels";
  note += t.str();
  return d;
}

}  // namespace

DiscretisationError discretisationError(const retraction::Model& model, const retraction::Setup& setup,
                                        const retraction::Result& result, const Progress& progress,
                                        const SecondAnswer* second, const std::vector<Vector3d>& landmarks_mm) {
  DiscretisationError e;
  e.cell_mm = model.youngs_kPa.grid.spacing_mm.maxCoeff();
  e.coarse_mm = 2.0 * e.cell_mm;
  try {
    const Places places(model, result, landmarks_mm);
    if (locks(setup, model.poisson)) {
      e.note = lockingNote(model, setup, result, places.all, progress);
      return e;
    }
    // At once only in contact: factors are made by BLAS, whose threads are one setting for the whole process.
    const std::launch when = result.contact ? std::launch::async : std::launch::deferred;
    std::future<Missed> other;
    if (second && second->model.youngs_kPa.values != model.youngs_kPa.values)
      other = std::async(when, [&] { return missed(second->model, setup, second->result, places.all, progress); });
    const Missed own = missed(model, setup, result, places.all, progress);
    e.cell_mm = own.cell_mm;
    e.coarse_mm = own.coarse_mm;
    const std::vector<double> all = lengths(own);
    std::vector<double> error = places.ofCells(all);
    if (error.empty()) throw BadInput("no cell of one grid lies inside the other");
    e.mean_mm = meanOf(error);
    e.max_mm = *std::max_element(error.begin(), error.end());
    e.p95_mm = percentile(error, 0.95);
    places.tell(all, own.travel_mm, e);
    e.known = true;
    std::ostringstream t;
    t.precision(3);
    t << "discretisation error about " << e.mean_mm << " mm on average, " << e.p95_mm << " mm for 95 % of the body, "
      << e.max_mm << " mm at most";
    if (e.at_retractor_mm) t << ", " << *e.at_retractor_mm << " mm at the retractor";
    if (e.vessels_mm) t << ", " << *e.vessels_mm << " mm at the vessels";
    t << " (cells of " << e.cell_mm << " mm against " << e.coarse_mm << " mm)";
    e.note = t.str();
    if (second) e.difference = ofDifference(own, other, places, e.note);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& why) {
    e.note = std::string("discretisation error unknown: ") + why.what();
  }
  return e;
}

}  // namespace glisson::retraction
