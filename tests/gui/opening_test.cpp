// SPDX-License-Identifier: GPL-3.0-or-later

// Volumes, masks and maps by themselves and together; patients, studies and series; what a folder offers; what is
// refused.
#include <QDialog>
#include <QLabel>
#include <QPushButton>
#include <QRegularExpression>
#include <QTreeWidget>
#include <fstream>

#include "image/io.h"
#include "panels/region_list.h"
#include "panels/series_tree.h"
#include "phantom/phantom.h"
#include "pipeline/scene.h"
#include "pipeline/sources.h"
#include "roi/contour_stack.h"
#include "window_bench.h"

using glisson::dicom::SeriesRole;
using glisson::panels::SeriesTree;
using glisson::session::Question;
using glisson::session::Session;
using glisson::session::Step;
using glisson::session::StepState;
using glisson::test::wait_ms;

class Opening : public QObject, private glisson::test::WindowBench {
  Q_OBJECT

 private:
  std::filesystem::path patient_, other_, volumes_;
  glisson::image::Mask liver_;

  QString volume(const char* name) const { return QString::fromStdString((volumes_ / name).string()); }
  /// The map's quantity and unit, as a reader answers; the dialog that asks goes.
  bool answered() {
    if (!session().images().question || session().images().question->kind != Question::Kind::Meaning) return false;
    if (auto* dialog = window().findChild<QDialog*>("meaningDialog")) dialog->close();
    return afterLoading([this] { session().setMeaning(glisson::StiffnessQuantity::Shear, QStringLiteral("kPa")); }) &&
           session().images().stiffness;
  }
  /// What counts now, mL.
  double shownVolume_mL() {
    if (!QTest::qWaitFor([&] { return session().statistics().region != nullptr; }, wait_ms)) return -1.0;
    return session().statistics().volume_mL;
  }
  double maskVolume_mL() const {
    const auto inside = std::count(liver_.values.begin(), liver_.values.end(), 1);
    return 1e-3 * static_cast<double>(inside) * liver_.grid.voxelVolume_mm3();
  }

 private slots:
  void initTestCase() {
    qputenv("XDG_CACHE_HOME", path("cache").toUtf8());
    glisson::phantom::PhantomOptions options;
    for (int number : {1, 2}) {
      options.number = number;
      const auto target = folder() / ("patient-" + std::to_string(number));
      glisson::phantom::writePhantom(glisson::phantom::makePhantom(static_cast<std::uint64_t>(number), options),
                                     target);
      (number == 1 ? patient_ : other_) = target;
    }
    // The same patient as volume files.
    volumes_ = folder() / "volumes";
    std::filesystem::create_directories(volumes_);
    const auto mri = glisson::pipeline::loadImage(patient_ / "mri").volume;
    const auto map = glisson::pipeline::loadStiffness(patient_ / "mre", {}).map;
    const auto roi = glisson::pipeline::loadRoi(patient_ / "rtstruct.dcm", {}, 0);
    liver_ = glisson::roi::rasterise(*roi.contours, mri.grid);
    glisson::image::writeVolume(volumes_ / "mri.nii.gz", mri);
    glisson::image::writeVolume(volumes_ / "stiffness.nrrd", map.values_kPa);
    glisson::image::writeVolume(volumes_ / "liver.mha", liver_);
  }
  void init() {
    std::filesystem::remove_all(folder() / "journals");
    std::filesystem::create_directories(folder() / "journals");
    open(path("journals"));
  }

  void volumeMaskAndMapTogether() {
    QVERIFY(opened({volume("mri.nii.gz"), volume("liver.mha"), volume("stiffness.nrrd")}));
    QVERIFY2(session().images().mri, qPrintable(session().status(Step::Load).detail));
    QVERIFY2(session().acceptedCount() > 0, "the mask that was named is the outline");
    QVERIFY(answered());
    QVERIFY(session().images().mri->grid.sameGeometry(liver_.grid));
    QTRY_VERIFY_WITH_TIMEOUT(session().statistics().pooled.has_value(), wait_ms);
    // Outlines of a mask are the mask, to the voxel.
    QVERIFY2(std::abs(shownVolume_mL() - maskVolume_mL()) < 1e-6 * maskVolume_mL(),
             qPrintable(QString("%1 mL instead of %2").arg(shownVolume_mL()).arg(maskVolume_mL())));
    QVERIFY(find<QLabel>("liverVolume")->text().contains(QString::number(maskVolume_mL(), 'f', 0)));

    // The case names the files; opened again it asks nothing and holds the same.
    session().saveCase(path("volume-case"));
    const auto scene = glisson::pipeline::readScene(folder() / "volume-case" / "case.json");
    QCOMPARE(scene.geometry.mri.string(), (volumes_ / "mri.nii.gz").string());
    QCOMPARE(scene.geometry.mre.string(), (volumes_ / "stiffness.nrrd").string());
    QVERIFY(scene.geometry.roles.empty());
    const auto drawn = polygons();
    open(path("journals"));
    QVERIFY(opened(folder() / "volume-case"));
    QVERIFY(session().images().mri && session().images().stiffness && !session().images().question);
    QCOMPARE(polygons().size(), drawn.size());
    QVERIFY(polygons().front().points_lps_mm == drawn.front().points_lps_mm);
  }

  void aFolderOfVolumesOffersItsMask() {
    QVERIFY(opened(volumes_));
    QVERIFY(session().images().mri);
    QVERIFY2(polygons().empty(), "what only lies there is offered, not taken");
    window().showStep(Step::Load);
    auto* regions = find<glisson::panels::RegionList>("regionList");
    QVERIFY(regions->isVisible());
    QCOMPARE(regions->topLevelItemCount(), 1);
    QCOMPARE(regions->topLevelItem(0)->text(2), QStringLiteral("liver.mha"));
    if (auto* dialog = window().findChild<QDialog*>("meaningDialog")) dialog->close();
    click("takeRegionButton");
    QVERIFY(session().acceptedCount() > 0);
    QCOMPARE(window().step(), Step::Segment);
    QVERIFY(std::abs(shownVolume_mL() - maskVolume_mL()) < 1e-6 * maskVolume_mL());
  }

  void aMaskByItself() {
    QVERIFY(opened(volumes_ / "liver.mha"));
    QVERIFY(session().images().mri && !session().images().stiffness);
    QVERIFY(session().acceptedCount() > 0);
    QVERIFY2(std::abs(shownVolume_mL() - maskVolume_mL()) < 1e-6 * maskVolume_mL(), "without an elastogram, too");
  }

  void aMapByItselfIsDrawnOnAsItIs() {
    QVERIFY(opened(volumes_ / "stiffness.nrrd"));
    QVERIFY(session().images().mri);
    QVERIFY(answered());
    QVERIFY(session().images().mri->grid.sameGeometry(session().images().stiffness->values_kPa.grid));
    QCOMPARE(session().images().mriSeries, session().images().stiffnessSeries);
  }

  void whatIsRefusedSaysWhatAndWhyAndLeavesThePatientOpen() {
    QVERIFY(opened(volumes_ / "mri.nii.gz"));
    const auto before = session().images().mri;
    const auto broken = folder() / "broken.nii.gz";
    std::ofstream(broken) << "no volume at all";
    QSignalSpy ended(&session(), &Session::workEnded);
    window().openPath(QString::fromStdString(broken.string()));
    QVERIFY(ended.count() > 0 || ended.wait(wait_ms));
    auto* notice = find<QLabel>("loadNoticeText");
    QTRY_VERIFY(notice->isVisible());
    QVERIFY2(notice->text().contains("broken.nii.gz"), qPrintable(notice->text()));
    QVERIFY2(notice->text().contains("still open"), qPrintable(notice->text()));
    QVERIFY(session().refusal() && session().refusal()->reason.size() > 20);
    QVERIFY(session().images().mri == before);
    QCOMPARE(session().status(Step::Load).state, StepState::Done);
    QVERIFY(find<SeriesTree>("seriesTree")->topLevelItemCount() == 1);
    // What is opened next takes the notice away.
    QVERIFY(opened(volumes_ / "liver.mha"));
    QVERIFY(!session().refusal());
    window().showStep(Step::Load);
    QVERIFY(!notice->isVisible());
  }

  void patientsStudiesAndSeriesAreATreeAndATickTakesASeries() {
    const auto both = folder() / "both";
    for (const auto& [name, from] : {std::pair{"one", patient_}, std::pair{"two", other_}}) {
      std::filesystem::create_directories(both / name);
      std::filesystem::copy(from / "mri", both / name / "mri", std::filesystem::copy_options::recursive);
    }
    QVERIFY(opened(both));
    window().showStep(Step::Load);
    auto* tree = find<SeriesTree>("seriesTree");
    QCOMPARE(tree->topLevelItemCount(), 2);
    for (int p = 0; p < 2; ++p) {
      QCOMPARE(tree->topLevelItem(p)->text(0), QString("Patient %1").arg(p + 1));
      QCOMPARE(tree->topLevelItem(p)->childCount(), 1);
      const QString study = tree->topLevelItem(p)->child(0)->text(0);
      QVERIFY2(study.startsWith("MR") && study.contains(QRegularExpression("\\d{4}-\\d{2}-\\d{2}")), qPrintable(study));
    }
    const auto ticked = [&](int series) { return tree->itemOf(series)->checkState(SeriesTree::Use) == Qt::Checked; };
    const int first = session().images().mriSeries;
    int second = -1;
    for (int s = 0; s < static_cast<int>(session().scan().series.size()); ++s)
      if (s != first && session().scan().series[static_cast<std::size_t>(s)].role == SeriesRole::Anatomical) second = s;
    QVERIFY(second >= 0 && ticked(first) && !ticked(second));
    QTRY_VERIFY_WITH_TIMEOUT(!tree->itemOf(second)->icon(SeriesTree::Name).isNull(), wait_ms);
    QSignalSpy loaded(&session(), &Session::loaded);
    tree->itemOf(second)->setCheckState(SeriesTree::Use, Qt::Checked);
    QVERIFY(loaded.wait(wait_ms));
    QCOMPARE(session().images().mriSeries, second);
    QVERIFY(!ticked(first) && ticked(second));
    QCOMPARE(window().step(), Step::Load);
    // The tick of what is in use cannot be taken away: something is.
    tree->itemOf(second)->setCheckState(SeriesTree::Use, Qt::Unchecked);
    QTRY_VERIFY(ticked(second));
    QCOMPARE(session().images().mriSeries, second);
  }

  void theStructureSetOfADicomFolderIsOffered() {
    QVERIFY(opened(patient_));
    window().showStep(Step::Load);
    auto* regions = find<glisson::panels::RegionList>("regionList");
    QVERIFY(regions->isVisible() && regions->topLevelItemCount() >= 1);
    QCOMPARE(regions->topLevelItem(0)->text(2), QStringLiteral("rtstruct.dcm"));
    click("takeRegionButton");
    QVERIFY(session().acceptedCount() > 0);
    QVERIFY(std::abs(shownVolume_mL() - maskVolume_mL()) < 0.02 * maskVolume_mL());
  }

  void cleanupTestCase() { close(); }
};

QTEST_MAIN(Opening)
#include "opening_test.moc"
