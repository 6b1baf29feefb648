#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "pipeline/scene.h"
#include "study/rows.h"

namespace glisson::study {

struct TradeoffOptions {
  bool quick = false;           ///< fewer variants
  int referenceCells = 400000;  ///< the reference splits every cell into eight up to this many cells
};

struct TradeoffStudy {
  std::vector<Row> rows;     ///< one per variant; dofs and times are its own
  std::string reference;     ///< what the errors are against, in words
  double reference_s = 0.0;  ///< time that it took
  int referenceDofs = 0;
  std::size_t points = 0;            ///< places compared: cell centres of the scene's own cells
  double largest_mm = 0.0;           ///< largest displacement among them
  std::vector<std::string> skipped;  ///< variants that could not be made, with the reason
  std::string summary() const;
};

/// Error against run time for any scene, against its own finest answer (incompatible modes, every cell of the scene
/// split into eight; the scene's own cells where that would be too many). Variants: three elements at the scene's cell
/// size and coarser ones (geometry.cell_mm × 1.5, 2, 3, 4; so the error holds what the coarser surface does to the
/// body), looser solver tolerances, and mesh-free frames, the published method among them, on the scene's own cells.
/// The retractor stays where the scene's own resolution puts it, with the same force. Only displacement is computed:
/// nothing is written or drawn. Throws BadInput where the scene itself cannot be run, Cancelled.
TradeoffStudy studyTradeoff(const pipeline::Scene& scene, const TradeoffOptions& options = {},
                            const Progress& progress = {});

}  // namespace glisson::study
