// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.h"
#include "pipeline/sources.h"

namespace glisson::pipeline {
namespace {

/// Of two that both say something.
bool differ(const std::string& a, const std::string& b) {
  return !a.empty() && !b.empty() && a != b;
}

bool same(const std::string& a, const std::string& b) {
  return !a.empty() && a == b;
}

/// What an object says about where it belongs.
struct Belonging {
  std::string patientKey, studyUid, studyDate, frame;
};

Belonging of(const LoadedRoi& roi) {
  return {roi.origin.patientKey, roi.origin.studyUid, roi.origin.studyDate, roi.frameOfReferenceUid};
}

std::vector<std::string> judge(const std::vector<Difference>& differences, bool overridden, const std::string& choose) {
  std::vector<std::string> said;
  for (const Difference& d : differences) {
    if (d.in == Difference::In::Frame) {
      said.push_back(d.what + (overridden ? " (confirmed by the user)" : " (confirm it with --override)"));
      continue;
    }
    if (!overridden)
      throw BadInput(
          d.what + "; " + choose +
          ", or take them together nevertheless with --override (\"override\": true in the scene's geometry), "
          "which is written to the record");
    said.push_back(d.what + ": overridden by the user");
  }
  return said;
}

Difference otherFrame(const std::string& what, const std::string& check) {
  return {Difference::In::Frame, what + " have different frames of reference: " + check};
}

/// Another day, and nothing that puts both in one place all the same: a set drawn later is often filed under its own
/// day, but in the frame of reference or the study that it was drawn on.
bool otherDay(const Belonging& a, const Belonging& b) {
  return differ(a.studyDate, b.studyDate) && !same(a.studyUid, b.studyUid) && !same(a.frame, b.frame);
}

}  // namespace

std::vector<Difference> differences(const AnatomicalImage& mri, const LoadedStiffness& mre) {
  std::vector<Difference> found;
  if (differ(mri.patientKey, mre.patientKey))
    found.push_back({Difference::In::Patient, "the MRI and the elastogram belong to different patients"});
  if (differ(mri.studyDate, mre.studyDate))
    found.push_back({Difference::In::Day, "the MRI and the elastogram were taken on different days"});
  if (differ(mri.frameOfReferenceUid, mre.map.frameOfReferenceUid))
    found.push_back(otherFrame("the MRI and the elastogram", "check that the patient did not move"));
  return found;
}

std::vector<Difference> differences(const LoadedRoi& roi, const AnatomicalImage* mri, const LoadedStiffness* mre) {
  std::vector<Difference> found;
  const Belonging region = of(roi);
  std::vector<std::pair<std::string, Belonging>> images;
  if (mri != nullptr)
    images.push_back({"the MRI", {mri->patientKey, mri->studyUid, mri->studyDate, mri->frameOfReferenceUid}});
  if (mre != nullptr)
    images.push_back(
        {"the elastogram", {mre->patientKey, mre->studyUid, mre->studyDate, mre->map.frameOfReferenceUid}});
  bool placed = false;
  for (const auto& [name, image] : images) {
    if (differ(region.patientKey, image.patientKey))
      found.push_back(
          {Difference::In::Patient, "the region of interest and " + name + " belong to different patients"});
    placed = placed || !otherDay(region, image);
  }
  if (!placed && !images.empty())
    found.push_back({Difference::In::Day,
                     "the region of interest was drawn on images of another day than " + images.front().first});
  if (mri != nullptr && differ(region.frame, mri->frameOfReferenceUid))
    found.push_back(otherFrame("the region of interest and the MRI", "check that they belong together"));
  return found;
}

std::vector<std::string> checkTogether(const AnatomicalImage& mri, const LoadedStiffness& mre, bool overridden) {
  return judge(differences(mri, mre), overridden, "choose two series of one examination");
}

std::vector<std::string> checkRoi(const LoadedRoi& roi, const AnatomicalImage* mri, const LoadedStiffness* mre,
                                  bool overridden) {
  return judge(differences(roi, mri, mre), overridden, "give the region that was drawn on these images");
}

std::vector<std::string> checkReaders(const std::vector<LoadedRoi>& rois, bool overridden) {
  std::vector<Difference> found;
  for (std::size_t r = 1; r < rois.size(); ++r) {
    const Belonging first = of(rois.front()), other = of(rois[r]);
    const std::string who = "the outlines of reader 1 and reader " + std::to_string(r + 1);
    if (differ(first.patientKey, other.patientKey))
      found.push_back({Difference::In::Patient, who + " belong to different patients"});
    if (otherDay(first, other)) found.push_back({Difference::In::Day, who + " were drawn on images of different days"});
    if (differ(first.frame, other.frame)) found.push_back(otherFrame(who, "check that they belong together"));
  }
  return judge(found, overridden, "give outlines that were drawn on the same images");
}

}  // namespace glisson::pipeline
