// SPDX-License-Identifier: GPL-3.0-or-later

// What the panel says of the numbers and of the outlines.
#include <QCheckBox>
#include <QTreeWidget>
#include <cmath>
#include <map>

#include "elastography/reading.h"
#include "panels/outline_panel.h"
#include "session/session.h"

namespace glisson::panels {

namespace {

QString kPa(double value) {
  return std::isfinite(value) ? QString::number(value, 'f', 2) : QStringLiteral("–");
}

/// The MRI slice that the elastogram asks nearest to this one (elastography/roi_mapping.h); empty where it is this one,
/// or where that holds no outline: then the nearest that does may count.
std::optional<int> countsInstead(const session::Session& session, int slice) {
  const session::OpenImages& images = session.images();
  if (slice < 0 || !images.mri || !images.stiffness) return std::nullopt;
  const image::Grid& mri = images.mri->grid;
  const image::Grid& mre = images.stiffness->values_kPa.grid;
  const Eigen::Vector3d here = mri.indexToLps({0.5 * mri.size.x(), 0.5 * mri.size.y(), 1.0 * slice});
  Eigen::Vector3d there = mre.lpsToIndex(here);
  there.z() = std::round(there.z());
  if (there.z() < 0.0 || there.z() >= mre.size.z()) return std::nullopt;
  const auto counting = static_cast<int>(std::lround(mri.lpsToIndex(mre.indexToLps(there)).z()));
  if (counting == slice) return std::nullopt;
  const session::OutlineCoverage c = session.coverage();
  if (!c.drawn.contains(counting) && !c.interpolated.contains(counting) && !c.empty.contains(counting))
    return std::nullopt;
  return counting;
}

/// How the elastogram was acquired, as far as its files say; empty where they do not.
QString acquired(const session::Session& session) {
  const int index = session.images().stiffnessSeries;
  if (index < 0 || index >= static_cast<int>(session.scan().series.size())) return {};
  const dicom::Series& series = session.scan().series[static_cast<std::size_t>(index)];
  QStringList facts;
  for (const std::string& fact : {series.acquired.manufacturer, series.acquired.sequenceName})
    if (!fact.empty()) facts << QString::fromStdString(fact);
  if (series.vibration_Hz) facts << QStringLiteral("%1 Hz").arg(*series.vibration_Hz, 0, 'g', 3);
  return facts.isEmpty() ? QString() : OutlinePanel::tr("Acquired by %1.").arg(facts.join(QStringLiteral(", ")));
}

QString madeWord(commands::MadeBy by) {
  switch (by) {
    case commands::MadeBy::Interpolation: return OutlinePanel::tr("interpolated");
    case commands::MadeBy::Proposal: return OutlinePanel::tr("proposed");
    case commands::MadeBy::Copy: return OutlinePanel::tr("copied");
  }
  return {};
}

}  // namespace

QString OutlinePanel::stateOf(const commands::Outlines& outlines, const roi::Polygon& polygon) {
  if (polygon.state == roi::PolygonState::Draft) return tr("draft");
  const std::optional<commands::MadeBy> by = outlines.madeBy(polygon);
  if (polygon.state == roi::PolygonState::Interpolated) return by ? madeWord(*by) : tr("interpolated");
  return by ? tr("%1, accepted").arg(madeWord(*by)) : tr("drawn");
}

QString OutlinePanel::numbersInFull(const session::LiveStatistics& live) {
  if (!live.pooled) return {};
  const auto line = [](const elastography::Statistics& s) {
    return tr("median %1, smallest %2, largest %3 kPa (µ)").arg(kPa(s.median_kPa), kPa(s.min_kPa), kPa(s.max_kPa));
  };
  QString text = tr("All slices: ") + line(live.pooled->pooled) +
                 tr("; mean weighted by area %1 kPa (µ)").arg(kPa(live.pooled->areaWeightedMean_kPa));
  if (live.slice) text += QLatin1Char('\n') + tr("This slice: ") + line(*live.slice);
  return text;
}

void OutlinePanel::showStatistics() {
  const session::LiveStatistics& live = session_.statistics();
  full_->setText(numbersInFull(live));
  volume_->setText(live.region ? tr("Volume %1 mL").arg(live.volume_mL, 0, 'f', live.volume_mL < 100.0 ? 1 : 0)
                               : QString());
  pooled_->setToolTip(full_->text());
  if (!live.pooled) {
    readout_->setText(QStringLiteral("–"));
    pooled_->setText(live.reason);
    reading_->clear();
    return;
  }
  reading_->setText(readingInWords());
  const auto line = [](const elastography::Statistics& s) {
    return tr("%1 px → %2 after mask, %3 cm², %4 ± %5 kPa (µ)")
        .arg(static_cast<qulonglong>(s.n_before_mask))
        .arg(static_cast<qulonglong>(s.n))
        .arg(s.area_mm2 / 100.0, 0, 'f', 1)
        .arg(kPa(s.mean_kPa), kPa(s.sd_kPa));
  };
  const elastography::Statistics& all = live.pooled->pooled;
  readout_->setText(tr("%1 ± %2 kPa").arg(kPa(all.mean_kPa), kPa(all.sd_kPa)));
  QString text = tr("All slices: ") + line(all);
  if (live.slice) text += QStringLiteral("\n") + tr("This slice: ") + line(*live.slice);
  if (const std::optional<int> other = countsInstead(session_, slice_))
    text +=
        QLatin1Char('\n') + tr("This slice lies between elastography slices; slice %1 counts there.").arg(*other + 1);
  pooled_->setText(text);
}

/// What belongs beside a mean: which change would be real, how much of the liver it is of, what was left out and what
/// that changed, and what is wrong with the slice shown.
QString OutlinePanel::readingInWords() const {
  const session::LiveStatistics& live = session_.statistics();
  const elastography::Reading r = elastography::readingOf(*live.pooled);
  QStringList words;
  words << tr("A change is real from %1 kPa (19 %).").arg(kPa(r.changeToBeReal_kPa));
  words << tr("%1 % of the outline measured.").arg(100.0 * r.shareMeasured, 0, 'f', 0);
  if (live.rimKept) words << tr("Too small for an inner region: the edge counts.");
  if (live.pooled->rim + live.pooled->excluded > 0)
    words << tr("Left out: edge %1 px, vessels %2 px; that changes the mean by %3 % (%4 kPa with them).")
                 .arg(live.pooled->rim)
                 .arg(live.pooled->excluded)
                 .arg(QString::asprintf("%+.1f", 100.0 * r.meanChange), kPa(live.pooled->meanOfAll_kPa));
  if (r.small)
    words << tr("The region is small (%1 of at least %2 mm²): a few waves decide.")
                 .arg(live.pooled->pooled.area_mm2, 0, 'f', 0)
                 .arg(elastography::smallestRegion_mm2, 0, 'f', 0);
  if (r.failed > 0) words << tr("Technical failure on %1 slices: no reliable wave.").arg(r.failed);
  switch (live.slice ? elastography::faultOf(*live.slice) : elastography::SliceFault::None) {
    case elastography::SliceFault::NoReliableWave:
      words << tr("This slice is a technical failure: no reliable wave.");
      break;
    case elastography::SliceFault::MostlyWithout:
      words << tr("Of this slice less than a tenth has a reliable wave.");
      break;
    case elastography::SliceFault::Small:
      words << tr("Of this slice less than %1 mm² count.").arg(elastography::smallestOnSlice_mm2, 0, 'f', 0);
      break;
    case elastography::SliceFault::None: break;
  }
  if (const QString how = acquired(session_); !how.isEmpty()) words << how;
  return words.join(QLatin1Char(' '));
}

/// Slices by what made them: what nobody drew is named, and what does not count.
QString OutlinePanel::whatCounts() const {
  const session::OutlineCoverage covered = session_.coverage();
  QStringList sentences;
  if (!covered.drawn.empty() || !covered.interpolated.empty()) {
    std::map<commands::MadeBy, std::size_t> made;
    std::size_t accepted = 0, all = 0;
    for (const auto& [k, by] : session::madeSlices(session_.contours(), session_.images().mri->grid)) {
      ++made[by];
      ++all;
      accepted += covered.drawn.contains(k);
    }
    QStringList parts{tr("%1 drawn").arg(covered.drawn.size() + covered.interpolated.size() - all)};
    if (made.contains(commands::MadeBy::Interpolation))
      parts << tr("%1 interpolated").arg(made[commands::MadeBy::Interpolation]);
    if (made.contains(commands::MadeBy::Proposal)) parts << tr("%1 proposed").arg(made[commands::MadeBy::Proposal]);
    if (made.contains(commands::MadeBy::Copy)) parts << tr("%1 copied").arg(made[commands::MadeBy::Copy]);
    parts << tr("%1 empty between them").arg(covered.empty.size());
    sentences << parts.join(QStringLiteral(", ")) + QLatin1Char('.');
    if (all > 0) sentences << tr("Of those that nobody drew %1 were accepted; all count.").arg(accepted);
    if (!covered.empty.empty()) sentences << tr("A run fills these by shape.");
  }
  if (!covered.drafts.empty()) {
    QStringList slices;
    for (const int k : covered.drafts) slices << QString::number(k + 1);
    sentences << tr("Drafts do not count (slices %1).").arg(slices.join(QStringLiteral(", ")));
  }
  return sentences.join(QLatin1Char(' '));
}

}  // namespace glisson::panels
