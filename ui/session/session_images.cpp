// SPDX-License-Identifier: GPL-3.0-or-later

// The images: which series are shown and measured, and what only the reader can answer about them.
#include <algorithm>

#include "base/error.h"
#include "base/map_unit.h"
#include "dicom/acquisitions.h"
#include "pipeline/sources.h"
#include "session/said.h"
#include "session/session.h"
#include "session/volume_files.h"

namespace glisson::session {

namespace {

bool below(const std::filesystem::path& file, const std::filesystem::path& folder) {
  return file.string().rfind((folder / "").string(), 0) == 0;
}

int indexOf(const dicom::ScanResult& scan, dicom::SeriesRole role) {
  try {
    const dicom::Series& found = dicom::findRole(scan, role);
    return static_cast<int>(&found - scan.series.data());
  } catch (const BadInput&) {
    return -1;
  }
}

std::filesystem::path commonFolder(const dicom::Series& series) {
  std::filesystem::path common = series.files.front().parent_path();
  for (const std::filesystem::path& file : series.files)
    while (!below(file, common) && common.has_relative_path()) common = common.parent_path();
  return common;
}

/// What a reader of this folder alone would find.
dicom::ScanResult below(const dicom::ScanResult& guessed, const std::filesystem::path& folder) {
  dicom::ScanResult there;
  for (const dicom::Series& s : guessed.series)
    if (!s.files.empty() && below(s.files.front(), folder)) there.series.push_back(s);
  return there;
}

/// Whether a reader of this folder alone would take the series by its role.
bool findsIt(const dicom::ScanResult& guessed, const std::filesystem::path& folder, dicom::SeriesRole role,
             const std::string& uid) {
  const dicom::ScanResult there = below(guessed, folder);
  const int found = indexOf(there, role);
  return found >= 0 && there.series[static_cast<std::size_t>(found)].uid == uid;
}

/// Whether a reader of this folder alone would take the confidence (empty: none) with the stiffness that it takes.
bool findsConfidence(const dicom::ScanResult& guessed, const std::filesystem::path& folder, const std::string& uid) {
  const dicom::ScanResult there = below(guessed, folder);
  const int stiffness = indexOf(there, dicom::SeriesRole::Stiffness);
  if (stiffness < 0) return false;
  const int found = dicom::partnersOf(there, stiffness).confidence;
  return (found < 0 ? std::string() : there.series[static_cast<std::size_t>(found)].uid) == uid;
}

/// Time steps of the wave: the volumes that follow each other in one series.
std::vector<std::shared_ptr<const image::ScalarVolume>> readWave(const dicom::ScanResult& scan, int first,
                                                                 const Progress& progress) {
  if (first < 0) return {};
  const auto stem = [](const std::string& uid) { return uid.substr(0, uid.find('#')); };
  const std::string uid = stem(scan.series[static_cast<std::size_t>(first)].uid);
  std::vector<const dicom::Series*> steps;
  for (const dicom::Series& s : scan.series)
    if (s.role == dicom::SeriesRole::Wave && !s.error && stem(s.uid) == uid) steps.push_back(&s);
  std::stable_sort(steps.begin(), steps.end(),
                   [](const auto* a, const auto* b) { return a->temporalIndex < b->temporalIndex; });
  std::vector<std::shared_ptr<const image::ScalarVolume>> wave;
  for (std::size_t t = 0; t < steps.size(); ++t) {
    const double n = static_cast<double>(steps.size());
    auto volume = std::make_shared<image::ScalarVolume>(
        readImage(*steps[t], progress.part(static_cast<double>(t) / n, static_cast<double>(t + 1) / n)));
    if (wave.empty() || wave.front()->grid.sameGeometry(volume->grid)) wave.push_back(std::move(volume));
  }
  return wave;
}

/// Why the elastogram cannot be taken as it is: it differs from the MRI, has no unit, or is a picture in colour. The
/// command line refuses the same (pipeline::checkTogether, loadStiffness).
std::optional<Question> questionAbout(const dicom::Series& mri, const dicom::Series& mre, const Choices& choices) {
  if (mre.colour)
    return Question{
        Question::Kind::None,
        Session::tr("The elastogram is left out: series %1 is in colour, a picture of stiffness and not its "
                    "values. Give the role to the grey-scale stiffness series.")
            .arg(mre.number)};
  if (!choices.together.value_or(false)) {
    pipeline::AnatomicalImage image;
    image.patientKey = mri.patientKey;
    image.studyDate = mri.studyDate;
    image.frameOfReferenceUid = mri.frameOfReferenceUid;
    pipeline::LoadedStiffness map;
    map.patientKey = mre.patientKey;
    map.studyDate = mre.studyDate;
    map.map.frameOfReferenceUid = mre.frameOfReferenceUid;
    QStringList words;
    using In = pipeline::Difference::In;
    for (const pipeline::Difference& d : pipeline::differences(image, map))
      words << (d.in == In::Patient ? Session::tr("The MRI and the elastogram belong to different patients.")
                : d.in == In::Day   ? Session::tr("The MRI and the elastogram were taken on different days.")
                                    : Session::tr("The MRI and the elastogram have different frames of reference: the "
                                                    "patient may have moved between them."));
    if (!words.isEmpty()) return Question{Question::Kind::Together, words.join(QLatin1Char(' '))};
  }
  if (!choices.unit && !(mre.unit && mapUnit(*mre.unit)))
    return Question{Question::Kind::Meaning,
                    Session::tr("Series %1 does not say what it holds, nor in which unit.").arg(mre.number)};
  return std::nullopt;
}

}  // namespace

OpenImages readImages(const dicom::ScanResult& scan, const dicom::ScanResult& guessed,
                      const std::filesystem::path& root, const Choices& choices, const Progress& progress) {
  OpenImages images;
  images.choices = choices;
  const dicom::RoleOverrides roles = dicomRoles(choices.roles);
  images.mriSeries = indexOf(scan, dicom::SeriesRole::Anatomical);
  if (images.mriSeries < 0) images.mriSeries = indexOf(scan, dicom::SeriesRole::Magnitude);
  images.stiffnessSeries = indexOf(scan, dicom::SeriesRole::Stiffness);
  const auto series = [&scan](int i) -> const dicom::Series& { return scan.series[static_cast<std::size_t>(i)]; };
  const bool bareMap = images.stiffnessSeries >= 0 && isVolume(series(images.stiffnessSeries));
  // A map by itself is drawn on as it is.
  if (images.mriSeries < 0 && bareMap) images.mriSeries = images.stiffnessSeries;
  // What belongs to the stiffness that is shown, never the first of its kind. A volume file belongs to no acquisition.
  dicom::Acquisition acquisition;
  if (images.stiffnessSeries >= 0 && !bareMap) acquisition = dicom::partnersOf(scan, images.stiffnessSeries);
  if (acquisition.confidence >= 0 && isVolume(series(acquisition.confidence))) acquisition.confidence = -1;
  images.confidenceSeries = acquisition.confidence;
  if (images.mriSeries < 0)
    throw BadInput(Session::tr("no anatomical or magnitude MR series was found; give a series that role in the table")
                       .toStdString());
  progress.report(0.0, "reading MRI");
  images.mri = std::make_shared<image::ScalarVolume>(readImage(series(images.mriSeries), progress.part(0.0, 0.5)));
  // From the folder of the series up to the one that was opened: the first that means these series and no others.
  const auto outwards = [&root](std::filesystem::path folder, const auto& right) -> std::filesystem::path {
    for (;; folder = folder.parent_path()) {
      if (right(folder)) return folder;
      if (!below(folder, root)) return {};
    }
  };
  // What is shown beside the maps that count: where it cannot be read, the rest still can.
  try {
    const bool alone = images.stiffnessSeries < 0;
    const int magnitude = alone ? indexOf(scan, dicom::SeriesRole::Magnitude) : acquisition.magnitude;
    if (magnitude >= 0 && magnitude != images.mriSeries)
      images.magnitude = std::make_shared<image::ScalarVolume>(readImage(series(magnitude), progress.part(0.5, 0.55)));
    const int wave = alone                      ? indexOf(scan, dicom::SeriesRole::Wave)
                     : acquisition.wave.empty() ? -1
                                                : acquisition.wave.front();
    images.wave = readWave(scan, wave, progress.part(0.55, 0.6));
  } catch (const BadInput& e) {
    images.note = QString::fromUtf8(e.what());
  }
  if (isVolume(series(images.mriSeries)))
    images.mriSource = series(images.mriSeries).files.front();
  else if (!roles.empty())
    images.mriSource = root;
  if (images.mriSource.empty())
    images.mriSource = outwards(commonFolder(series(images.mriSeries)), [&](const std::filesystem::path& folder) {
      return findsIt(guessed, folder, dicom::SeriesRole::Anatomical, series(images.mriSeries).uid);
    });
  if (images.stiffnessSeries < 0) {
    images.note += Session::tr("No stiffness series was found: outlines can be drawn, stiffness cannot be measured.");
    return images;
  }
  const dicom::Series& stiffness = series(images.stiffnessSeries);
  images.question = questionAbout(series(images.mriSeries), stiffness, choices);
  if (images.question) return images;
  progress.report(0.6, "reading elastogram");
  Diagnostics said = acquisition.diagnostics;
  pipeline::MapMeaning meaning;
  meaning.quantity = choices.quantity;
  meaning.unit = choices.unit;
  elastography::StiffnessMap map =
      bareMap ? pipeline::loadStiffness(stiffness.files.front(), meaning, progress.part(0.6, 0.85)).map
              : pipeline::readStiffness(stiffness, meaning, said, progress.part(0.6, 0.85));
  if (map.quantity == StiffnessQuantity::Youngs) {
    // Everything in the window is a shear modulus; a run takes the map as it is, with the Poisson's ratio of its model.
    map = elastography::toQuantity(map, StiffnessQuantity::Shear, defaults::poisson);
    images.note +=
        Session::tr("The elastogram holds Young's modulus; it is shown as shear modulus (Poisson's ratio %1).")
            .arg(defaults::poisson) +
        QLatin1Char(' ');
  }
  if (images.confidenceSeries >= 0)
    pipeline::readConfidence(series(images.confidenceSeries), {}, map, said, progress.part(0.85, 1.0));
  else
    images.note += Session::tr("No confidence map was found: every voxel with a stiffness counts.");
  for (const Diagnostic& d : said)
    if (d.severity() >= Severity::Warning) images.note += QLatin1Char(' ') + session::said(d) + QLatin1Char('.');
  if (bareMap)
    images.mreSource = stiffness.files.front();
  else if (!roles.empty())
    images.mreSource = root;
  if (images.mreSource.empty())
    images.mreSource = outwards(commonFolder(stiffness), [&](const std::filesystem::path& folder) {
      return findsIt(guessed, folder, dicom::SeriesRole::Stiffness, stiffness.uid) &&
             findsConfidence(guessed, folder,
                             images.confidenceSeries < 0 ? std::string() : series(images.confidenceSeries).uid);
    });
  images.stiffness = std::make_shared<elastography::StiffnessMap>(std::move(map));
  return images;
}

}  // namespace glisson::session
