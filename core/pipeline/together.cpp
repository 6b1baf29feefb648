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

/// Collects what is said about things taken together, or refuses.
struct Verdict {
  bool overridden;
  std::string choose;  ///< what to do instead
  std::vector<std::string> said{};

  void refuse(const std::string& what) {
    if (!overridden)
      throw BadInput(
          what + "; " + choose +
          ", or take them together nevertheless with --override (\"override\": true in the scene's geometry), "
          "which is written to the record");
    said.push_back(what + ": overridden by the user");
  }
  void otherFrame(const std::string& what, const std::string& check) {
    said.push_back(what + " have different frames of reference: " + check +
                   (overridden ? " (confirmed by the user)" : " (confirm it with --override)"));
  }
};

/// What an object says about where it belongs.
struct Belonging {
  std::string patientKey, studyUid, studyDate, frame;
};

Belonging of(const LoadedRoi& roi) {
  return {roi.origin.patientKey, roi.origin.studyUid, roi.origin.studyDate, roi.frameOfReferenceUid};
}

/// Another day, and nothing that puts both in one place all the same: a set drawn later is often filed under its own
/// day, but in the frame of reference or the study that it was drawn on.
bool otherDay(const Belonging& a, const Belonging& b) {
  return differ(a.studyDate, b.studyDate) && !same(a.studyUid, b.studyUid) && !same(a.frame, b.frame);
}

}  // namespace

std::vector<std::string> checkTogether(const AnatomicalImage& mri, const LoadedStiffness& mre, bool overridden) {
  Verdict verdict{overridden, "choose two series of one examination"};
  if (differ(mri.patientKey, mre.patientKey)) verdict.refuse("the MRI and the elastogram belong to different patients");
  if (differ(mri.studyDate, mre.studyDate)) verdict.refuse("the MRI and the elastogram were taken on different days");
  if (differ(mri.frameOfReferenceUid, mre.map.frameOfReferenceUid))
    verdict.otherFrame("the MRI and the elastogram", "check that the patient did not move");
  return verdict.said;
}

std::vector<std::string> checkRoi(const LoadedRoi& roi, const AnatomicalImage* mri, const LoadedStiffness* mre,
                                  bool overridden) {
  Verdict verdict{overridden, "give the region that was drawn on these images"};
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
      verdict.refuse("the region of interest and " + name + " belong to different patients");
    placed = placed || !otherDay(region, image);
  }
  if (!placed && !images.empty())
    verdict.refuse("the region of interest was drawn on images of another day than " + images.front().first);
  if (mri != nullptr && differ(region.frame, mri->frameOfReferenceUid))
    verdict.otherFrame("the region of interest and the MRI", "check that they belong together");
  return verdict.said;
}

std::vector<std::string> checkReaders(const std::vector<LoadedRoi>& rois, bool overridden) {
  Verdict verdict{overridden, "give outlines that were drawn on the same images"};
  for (std::size_t r = 1; r < rois.size(); ++r) {
    const Belonging first = of(rois.front()), other = of(rois[r]);
    const std::string who = "the outlines of reader 1 and reader " + std::to_string(r + 1);
    if (differ(first.patientKey, other.patientKey)) verdict.refuse(who + " belong to different patients");
    if (otherDay(first, other)) verdict.refuse(who + " were drawn on images of different days");
    if (differ(first.frame, other.frame)) verdict.otherFrame(who, "check that they belong together");
  }
  return verdict.said;
}

}  // namespace glisson::pipeline
