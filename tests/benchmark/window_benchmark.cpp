// SPDX-License-Identifier: GPL-3.0-or-later

// How soon the window answers, driven as a reader drives it: opening a study of many slices, another slice by the
// wheel, statistics after a vertex, and the memory that it takes.
//
//   benchmark_window [--slices N] [--run] [--judge]
//
// --run also runs the retraction before the memory is looked at (minutes). --judge: exit status 1 where a bound is
// missed; the bounds are those of an idle machine with two cores.
#include <QCommandLineParser>
#include <QElapsedTimer>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "../gui/window_bench.h"
#include "phantom/phantom.h"

namespace {

using glisson::session::Session;
using glisson::test::wait_ms;
using glisson::test::WindowBench;

/// Tells of each painting of a widget.
class Painted : public QObject {
 public:
  explicit Painted(QWidget* on) { on->installEventFilter(this); }
  int count = 0;

 protected:
  bool eventFilter(QObject*, QEvent* event) override {
    if (event->type() == QEvent::Paint) ++count;
    return false;
  }
};

/// Milliseconds from the act until the condition holds, the events running meanwhile; negative where it never does.
template <typename Act, typename Condition>
double timed_ms(Act&& act, Condition&& holds) {
  QElapsedTimer clock;
  clock.start();
  act();
  while (!holds()) {
    QCoreApplication::processEvents(QEventLoop::AllEvents, 1);
    if (clock.elapsed() > wait_ms) return -1.0;
  }
  return 1e-6 * static_cast<double>(clock.nsecsElapsed());
}

struct Times {
  std::vector<double> ms;
  double at(double share) {
    std::sort(ms.begin(), ms.end());
    return ms.empty() ? -1.0
                      : ms[std::min(ms.size() - 1, static_cast<std::size_t>(share * static_cast<double>(ms.size())))];
  }
};

double resident_MB() {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);)
    if (line.rfind("VmRSS:", 0) == 0) return std::stod(line.substr(6)) / 1024.0;
  return -1.0;
}

bool missed = false;

void tell(const char* what, double value, const char* unit, double bound) {
  const bool well = value >= 0.0 && value <= bound;
  missed = missed || !well;
  std::printf("%-46s %9.1f %-2s   bound %7.1f   %s\n", what, value, unit, bound, well ? "met" : "MISSED");
  std::fflush(stdout);
}

/// A synthetic patient whose MRI has that many slices, as DICOM.
std::filesystem::path patientOf(int slices, const std::filesystem::path& folder) {
  glisson::phantom::PhantomPatient patient = glisson::phantom::makePhantom(3);
  glisson::image::Grid grid = patient.mri.grid;
  grid.spacing_mm.z() *= static_cast<double>(grid.size.z() - 1) / (slices - 1);
  grid.size.z() = slices;
  glisson::phantom::Int16Volume fine(grid);
  for (int k = 0; k < slices; ++k) {
    const auto from =
        static_cast<int>(std::lround(patient.mri.grid.lpsToIndex(grid.indexToLps({0.0, 0.0, 1.0 * k})).z()));
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i)
        fine.at(i, j, k) = patient.mri.at(i, j, std::clamp(from, 0, patient.mri.grid.size.z() - 1));
  }
  patient.mri = std::move(fine);
  patient.contours.polygons.clear();
  glisson::phantom::writePhantom(patient, folder);
  return folder;
}

void slicesByTheWheel(WindowBench& bench, const char* name) {
  glisson::views::SliceView* view = bench.mri();
  Painted painted(view);
  Times times;
  const QPoint middle(view->width() / 2, view->height() / 2);
  view->setSlice(view->sliceCount() / 4);
  QTest::qWait(200);
  // Up and down again between a quarter and three quarters of the stack: at its end a notch would draw nothing.
  const int notches = std::max(1, view->sliceCount() / 2);
  for (int n = 0; n < 200; ++n) {
    const int before = painted.count;
    times.ms.push_back(timed_ms([&] { glisson::test::wheel(view, middle, n / notches % 2 == 0 ? 120 : -120); },
                                [&] { return painted.count > before; }));
  }
  tell(name, times.at(0.99), "ms", 16.0);
}

void statisticsAfterAVertex(WindowBench& bench) {
  const Eigen::Vector3d centre = glisson::test::trustedPlace(bench.session());
  bench.mri()->showPoint(centre);
  QTest::qWait(1500);
  Times times;
  QSignalSpy measured(&bench.session(), &Session::statisticsChanged);
  for (int v = 0; v < 60; ++v) {
    const double a = 2.0 * M_PI * v / 64.0;
    const Eigen::Vector3d p =
        centre + bench.mri()->plane().grid.direction * Eigen::Vector3d(40.0 * std::cos(a), 30.0 * std::sin(a), 0.0);
    measured.clear();
    const double ms = timed_ms([&] { QTest::mouseClick(bench.mri(), Qt::LeftButton, {}, bench.pixelOf(p)); },
                               [&] { return v < 3 || measured.count() > 0; });
    if (v >= 3) times.ms.push_back(ms);
    QTest::qWait(30);
  }
  tell("statistics after a vertex, median", times.at(0.5), "ms", 50.0);
  tell("statistics after a vertex, 95 %", times.at(0.95), "ms", 50.0);
  QTest::keyClick(bench.mri(), Qt::Key_Escape);
}

void outlines(WindowBench& bench) {
  const Eigen::Vector3d centre = glisson::test::trustedPlace(bench.session());
  const int middle = static_cast<int>(std::lround(bench.session().images().mri->grid.lpsToIndex(centre).z()));
  for (const int k : {middle - 24, middle - 8, middle + 8, middle + 24}) {
    bench.mri()->setSlice(k);
    Eigen::Vector3d on = bench.session().images().mri->grid.lpsToIndex(centre);
    on.z() = k;
    bench.ellipse(bench.session().images().mri->grid.indexToLps(on), 45.0, 35.0, 24);
    QTest::keyClick(bench.mri(), Qt::Key_Return);
    bench.session().tool().deselect();
  }
}

int work(int slices, bool run) {
  WindowBench bench;
  const std::filesystem::path study = patientOf(slices, bench.folder() / "study");
  bench.window().showStep(glisson::session::Step::Segment);
  QTest::qWait(300);
  Painted painted(bench.mri());
  bool loaded = false;
  QObject::connect(&bench.session(), &Session::loaded, &bench.session(), [&] { loaded = true, painted.count = 0; });
  const double opening_ms = timed_ms([&] { bench.session().openPath(QString::fromStdString(study.string())); },
                                     [&] { return loaded && bench.mri()->hasVolume() && painted.count > 0; });
  tell(("opening " + std::to_string(slices) + " slices to the first picture").c_str(), opening_ms, "ms", 1000.0);
  if (!bench.session().images().mri || !bench.session().images().stiffness) return 2;
  slicesByTheWheel(bench, "another slice, without outlines, 99 %");
  outlines(bench);
  slicesByTheWheel(bench, "another slice, with outlines, 99 %");
  statisticsAfterAVertex(bench);
  tell("resident memory with a patient", resident_MB(), "MB", 350.0);
  if (run) {
    QSignalSpy ended(&bench.session(), &Session::workEnded);
    bench.session().run();
    if (!ended.wait(2 * wait_ms) || !bench.session().result()) return 2;
    QTest::qWait(5000);
    tell("resident memory with a patient and results", resident_MB(), "MB", 350.0);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  QApplication app(argc, argv);
  QCoreApplication::setApplicationName(QStringLiteral("glisson"));
  QCommandLineParser options;
  options.addOptions({{"slices", "of the MRI", "N", "300"},
                      {"run", "run the retraction too"},
                      {"judge", "fail where a bound is missed"}});
  options.process(app);
  const int failed = work(options.value(QStringLiteral("slices")).toInt(), options.isSet(QStringLiteral("run")));
  return failed != 0 ? failed : missed && options.isSet(QStringLiteral("judge")) ? 1 : 0;
}
