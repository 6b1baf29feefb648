// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/announced.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "dicom/detail/attributes.h"
#include "dicom/detail/image_header.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

namespace glisson::dicom {
namespace {

int countOf(DcmItem& item, const DcmTagKey& tag) {
  constexpr double most = 1e6;
  try {
    const auto value = number(item, tag);
    if (value && *value >= 1.0 && *value <= most && *value == std::floor(*value)) return static_cast<int>(*value);
  } catch (const BadInput&) {  // no number: as good as none
  }
  return 0;
}

/// A private count in the block that its maker reserved, one of the first ones.
int privateCount(DcmItem& item, Uint16 group, Uint16 element, const std::string& creator) {
  for (Uint16 block = 0x10; block <= 0x1F; ++block)
    if (text(item, DcmTagKey(group, block)) == creator)
      return countOf(item, DcmTagKey(group, static_cast<Uint16>(block << 8U | element)));
  return 0;
}

}  // namespace

Announced announcedBy(DcmDataset& data) {
  Announced a;
  a.images = countOf(data, DCM_ImagesInAcquisition);
  a.slices = countOf(data, DCM_NumberOfSlices);
  const std::string maker = text(data, DCM_Manufacturer);
  if (a.slices == 0 && maker.starts_with("Philips"))
    a.slices = privateCount(data, 0x2001, 0x18, "Philips Imaging DD 001");
  if (a.slices == 0 && maker.starts_with("GE")) a.slices = privateCount(data, 0x0021, 0x4F, "GEMS_RELA_01");
  a.concatenationUid = shownText(data, DCM_ConcatenationUID);
  a.part = countOf(data, DCM_InConcatenationNumber);
  a.parts = countOf(data, DCM_InConcatenationTotalNumber);
  return a;
}

void checkCounts(const std::vector<ImageHeader>& headers, std::vector<Series>& volumes) {
  std::size_t there = 0;
  int images = 0, slices = 0;
  for (const ImageHeader& h : headers) {
    there += h.isMosaic() ? 1 : h.frames.size();
    images = std::max(images, h.announced.images);
    slices = std::max(slices, h.announced.slices);
  }
  const bool single = std::all_of(headers.begin(), headers.end(), [](const auto& h) { return h.frames.size() == 1; });
  for (Series& s : volumes) {
    const auto has = static_cast<std::int64_t>(s.grid.size.z());
    if (single && images > 0 && static_cast<std::int64_t>(there) < images)
      tell(s, DiagnosticCode::ImagesMissing,
           {{"there", static_cast<std::int64_t>(there)}, {"announced", std::int64_t{images}}});
    else if (single && slices > 0 && has < slices)
      tell(s, DiagnosticCode::SlicesMissing, {{"there", has}, {"announced", std::int64_t{slices}}});
  }
}

std::string missingParts(const std::vector<const ImageHeader*>& headers) {
  std::set<int> parts;
  int all = 0;
  for (const ImageHeader* h : headers) {
    if (h->announced.concatenationUid.empty()) continue;
    parts.insert(h->announced.part);
    all = std::max({all, h->announced.parts, h->announced.part});
  }
  if (parts.empty() || static_cast<int>(parts.size()) >= all) return {};
  std::string missing;
  for (int p = 1; p <= all && missing.size() < 60; ++p)
    if (!parts.contains(p)) missing += (missing.empty() ? "" : ", ") + std::to_string(p);
  return "it was cut into " + std::to_string(all) + " files (a concatenation), of which " +
         std::to_string(parts.size()) + (parts.size() == 1 ? " is" : " are") + " here: part " + missing +
         " is missing; add its file";
}

}  // namespace glisson::dicom
