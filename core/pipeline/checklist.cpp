// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/detail/checklist.h"

#include <string>
#include <utility>
#include <vector>

#include "elastography/reading.h"
#include "report/text.h"

namespace glisson::pipeline::detail {
namespace {

using report::number;

std::string voxels(std::size_t n, std::size_t of) {
  return std::to_string(n) + " of " + std::to_string(of) + " voxels";
}

/// Slices with one fault, counted from 1 as a reader does.
std::string slicesWith(elastography::SliceFault fault, const elastography::Reading& reading) {
  std::string list;
  for (const auto& s : reading.slices)
    if (s.fault == fault) list += (list.empty() ? "" : ", ") + std::to_string(s.slice + 1);
  return list.empty() ? "none" : list;
}

}  // namespace

void readersChecklist(const elastography::Measurement& m, report::Page& page) {
  const elastography::Reading reading = elastography::readingOf(m);
  page.heading("Reader's checklist");
  page.table(
      {{"Mean over " + std::to_string(m.slices.size()) + " slices",
        number(m.pooled.mean_kPa) + " ± " + number(m.pooled.sd_kPa) + " kPa" +
            (m.quantity == StiffnessQuantity::Shear ? " (shear modulus)" : " (Young's modulus)")},
       {"A change is real from", number(reading.changeToBeReal_kPa, 2) + " kPa, " +
                                     number(100 * elastography::repeatabilityCoefficient, 2) +
                                     " % of the mean (repeatability coefficient of the QIBA profile)"},
       {"Measured", voxels(m.pooled.n, m.drawn) + " that were outlined, " + number(100 * reading.shareMeasured, 2) +
                        " %; " + number(m.pooled.area_mm2, 3) + " mm² over all slices"},
       {"Left out: rim", voxels(m.rim, m.drawn)},
       {"Left out: vessels and other exclusions", voxels(m.excluded, m.drawn)},
       {"Left out: below the confidence", voxels(m.lowConfidence + m.noConfidence, m.drawn)},
       {"Left out: without a value", voxels(m.notFinite + m.notPositive, m.drawn)},
       {"Rim and exclusions change the mean by", m.rim + m.excluded > 0 ? number(100 * reading.meanChange, 2) + " %"
                                                                        : std::string("nothing: none were left out")},
       {"Technical failure: slices without a reliable wave",
        slicesWith(elastography::SliceFault::NoReliableWave, reading)},
       {"Slices of which less than a tenth counts", slicesWith(elastography::SliceFault::MostlyWithout, reading)},
       {"Slices with less than " + number(elastography::smallestOnSlice_mm2, 3) + " mm²",
        slicesWith(elastography::SliceFault::Small, reading)}});
  if (reading.small)
    page.warning("The measured region is smaller than " + number(elastography::smallestRegion_mm2, 3) +
                 " mm²: its mean hangs on a few waves.");
  page.paragraph("Only the reader can see whether:");
  page.list({"the wave images show waves through the liver on every slice that counts;",
             "the outline stays off the edge of the liver, gallbladder, fissures and large vessels;",
             "no artefact of motion, iron or metal lies in it;",
             "the patient had fasted, and the driver ran at the frequency of the acquisition."});
}

}  // namespace glisson::pipeline::detail
