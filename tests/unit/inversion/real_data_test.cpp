// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "elastography/statistics.h"
#include "image/io.h"
#include "inversion/invert.h"
#include "support/support.h"

namespace glisson::inversion {
namespace {

// A brain at 20 Hz, through-plane motion, 8 offsets, 2 × 2 × 4 mm. Waves are so long here (some 50 mm) and so oblique
// that slices of one component give no exact stiffness; what is asked for is the order of magnitude of brain at such a
// frequency (below 1 kPa at 20 Hz, rising to 2–4 kPa at 60 Hz) and that the chain takes real phase.
TEST(RealData, BrainAtTwentyHertz) {
  GLISSON_NEEDS_DATA("siemens_mre_phase");
  const auto folder = test::sharedData() / "siemens_mre_phase" / "nifti_spm";
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().filename().string().starts_with("f1911")) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_EQ(files.size(), 8u);
  PhaseOffsets p;
  for (const auto& file : files) p.offsets_rad.push_back(image::readVolume(file));
  const PhaseScale scale = phaseScale(p.offsets_rad);
  EXPECT_NEAR(scale.slope_rad, std::numbers::pi / 4096.0, 1e-12);
  for (auto& v : p.offsets_rad) toRadians(v, scale);
  const Waves waves = firstHarmonic({p});
  std::size_t inMask = 0;
  for (const auto v : waves.mask.values) inMask += v;
  EXPECT_GT(inMask, waves.mask.values.size() / 10);
  EXPECT_LT(inMask, waves.mask.values.size() * 6 / 10);  // a head, not the whole field of view
  InversionOptions o;
  o.frequency_Hz = 20.0;
  for (const BulkFilter filter : {BulkFilter::None, BulkFilter::HighPass}) {
    o.filter = filter;
    const Inversion r = invert(waves, o);
    std::vector<double> all, confident;
    for (std::size_t v = 0; v < r.magnitude_kPa.values.size(); ++v) {
      if (!std::isfinite(r.magnitude_kPa.values[v])) continue;
      all.push_back(static_cast<double>(r.magnitude_kPa.values[v]));
      if (r.confidence.values[v] >= 0.95F) confident.push_back(all.back());
    }
    ASSERT_FALSE(all.empty());
    const auto a = elastography::statisticsOf(all, 4.0), c = elastography::statisticsOf(confident, 4.0);
    std::printf(
        "brain, 20 Hz, filter %d: noise %.3f rad, %zu voxels in the mask, |G*| median %.3f kPa over %zu; "
        "confident: %zu voxels, median %.3f, mean %.3f, SD %.3f kPa\n",
        static_cast<int>(filter), waves.directions.front().noise_rad, inMask, a.median_kPa, a.n, c.n, c.median_kPa,
        c.mean_kPa, c.sd_kPa);
    EXPECT_GT(a.median_kPa, 0.1);
    EXPECT_LT(a.median_kPa, 4.0);
  }
}

}  // namespace
}  // namespace glisson::inversion
