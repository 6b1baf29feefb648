// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "pipeline/scene.h"
#include "study/rows.h"

namespace glisson::study {

/// Extent of the study of error against run time.
struct TradeoffOptions {
  bool quick = false;           ///< fewer variants
  int referenceCells = 400000;  ///< the reference splits every cell into eight up to this many cells
  double budget_s = 40.0;       ///< no further variant is begun after this; those left out are named
};

/// Error against run time of one scene.
struct TradeoffStudy {
  std::vector<Row> rows;     ///< one per variant; dofs and times are its own
  std::string reference;     ///< what the errors are against, in words
  double reference_s = 0.0;  ///< time that it took
  int referenceDofs = 0;
  std::size_t points = 0;            ///< places compared: cell centres of the scene's own cells
  double largest_mm = 0.0;           ///< largest displacement among them
  std::vector<std::string> skipped;  ///< variants that were not made, with the reason
  /// Rows that are held against references of their own, in the order in which they stand: the scene's own rigid bar
  /// ("bar", before the other rows, which have it as a patch), the time schemes of a motion ("time", behind them).
  struct Family {
    std::string name, reference;
  };
  std::vector<Family> families;
  std::string summary() const;
};

/// Row::reference of the corotational row: its distance from linear theory on the same cells.
inline constexpr const char* linearTheory = "linear theory on the same cells: a difference of models, not an error";

/// Error against run time for any scene, against its own finest answer (incompatible modes, every cell of the scene
/// split into eight; the scene's own cells where that would be too many). Variants: three hexahedra, T4 and T10 at the
/// scene's cell size and coarser ones (geometry.cell_mm × 1.5, 2, 3, 4; so the error holds what the coarser surface
/// does to the body); conjugate gradients stopped at 1e-1 ... 1e-6; mesh-free models of equal degrees of freedom
/// (Voronoi as published, Wendland affine and quadratic, moving least squares) on the scene's own cells; the condensed
/// response; and corotational beside linear. Variants that come to the same grid, the same number of frames, or the
/// same answer are not repeated. Build, solve and step times are measured apart where the scene is static and linear;
/// for tetrahedra and other scenes solve is the solver's own time, and build the rest. The retractor stays where the
/// scene's own resolution puts it, with the same force. Nothing is written or drawn. Throws BadInput where the scene
/// itself cannot be run, Cancelled.
TradeoffStudy studyTradeoff(const pipeline::Scene& scene, const TradeoffOptions& options = {},
                            const Progress& progress = {});

}  // namespace glisson::study
