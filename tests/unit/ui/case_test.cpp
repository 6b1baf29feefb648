// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/random.h"
#include "pipeline/case_folder.h"
#include "session/case_file.h"
#include "session/case_lock.h"
#include "session/measured_contours.h"
#include "session/parameters_json.h"
#include "session/setup_of.h"
#include "session/work_folder.h"
#include "support/support.h"
#include "tool_bench.h"

namespace glisson::session {
namespace {

CaseRecord record(double x) {
  CaseRecord r;
  r.source = "/some/where/patient";
  r.seriesUid = "1.2.840";
  r.choices.roles["1.2.3"] = dicom::SeriesRole::Stiffness;
  r.choices.together = true;
  r.choices.quantity = StiffnessQuantity::Youngs;
  r.choices.unit = "0.01kPa";
  roi::Polygon p;
  p.points_lps_mm.resize(3, 3);
  p.points_lps_mm << x, x + 1.0 / 3.0, x, 0.1, 0.2, 7.7, 5.0, 5.0, 5.0;
  r.outlines.polygons = {p, p};
  r.outlines.polygons[1].state = roi::PolygonState::Draft;
  r.outlines.marks = {{3, commands::SliceMark::NoLiver}, {9, commands::SliceMark::NoWave}};
  r.outlines.made = {{commands::digestOf(p), commands::MadeBy::Proposal}};
  r.parameters.poisson = 0.4;
  r.parameters.method = Method::MovingLeastSquares;
  r.parameters.kinematics = retraction::Kinematics::Corotational;
  r.parameters.solver = Solver::Condensed;
  r.parameters.tetEdge_mm = 7.25;
  r.parameters.registerRigidly = true;
  r.parameters.retractorDiameter_mm = 12.5;
  r.parameters.contact = retraction::ContactKind::Patch;
  r.parameters.shape = retraction::BarShape::Hook;
  r.parameters.drive = Drive::Travel;
  r.parameters.travel_mm = 33.5;
  r.parameters.capsule = false;
  r.parameters.capsule_N_per_mm = 0.31;
  r.measure = {true, 4};
  r.sceneJson = "{}\n";
  return r;
}

TEST(CaseFile, ComesBackToTheBit) {
  const test::TemporaryFolder folder;
  const CaseRecord wrote = record(1.0 / 7.0);
  EXPECT_EQ(writeCaseRecord(wrote, folder.path()), 1);
  EXPECT_TRUE(pipeline::isCase(folder.path()) && pipeline::isCase(folder / "case.json"));
  const CaseRecord read = readCaseRecord(folder / "case.json");
  EXPECT_TRUE(test::same(read.outlines, wrote.outlines));
  EXPECT_EQ(read.outlines.marks, wrote.outlines.marks);
  EXPECT_EQ(read.outlines.made, wrote.outlines.made);
  EXPECT_EQ(read.parameters, wrote.parameters);
  EXPECT_EQ(read.measure, wrote.measure);
  EXPECT_EQ(read.choices, wrote.choices);
  EXPECT_EQ(read.seriesUid, wrote.seriesUid);
  EXPECT_EQ(read.sceneJson, wrote.sceneJson);
}

TEST(CaseFile, ACaseOfBeforeContactHasTheLinearPatchOfItsTime) {
  nlohmann::json j = toJson(Parameters{});
  for (const char* key : {"contact", "shape", "drive", "travel_mm", "capsule", "capsule_N_per_mm", "kinematics"})
    j.erase(key);
  j["force_is_weight"] = false;
  j["force_N"] = 4.5;
  const Parameters p = parametersFromJson(j);
  EXPECT_EQ(p.contact, retraction::ContactKind::Patch);
  EXPECT_EQ(p.kinematics, retraction::Kinematics::Linear);
  EXPECT_EQ(p.drive, Drive::Force);
  EXPECT_EQ(p.force_N, 4.5);
  EXPECT_FALSE(p.capsule);
}

TEST(Setup, IsARigidBarWithCapsuleByDefaultAndAPatchWhereNoneIsOffered) {
  const auto barOf = [](const retraction::Setup& s) { return std::get<retraction::Retractor>(s.loads.at(0)); };
  Parameters p;
  p.drive = Drive::Travel;
  p.shape = retraction::BarShape::Hook;
  EXPECT_FALSE(rigidRefusal(p));
  retraction::Setup s = setupOf(p);
  ASSERT_TRUE(retraction::rigidBarOf(s));
  EXPECT_EQ(barOf(s).travel_mm, p.travel_mm);
  EXPECT_EQ(barOf(s).shape, retraction::BarShape::Hook);
  EXPECT_EQ(s.kinematics, retraction::Kinematics::Auto);
  ASSERT_TRUE(s.capsule);
  EXPECT_EQ(s.capsule->tension_N_per_mm, retraction::Capsule{}.tension_N_per_mm);

  const auto refuses = [&](retraction::RigidRefusal why, auto&& change) {
    Parameters q = p;
    change(q);
    EXPECT_EQ(rigidRefusal(q), why);
    const retraction::Setup patch = setupOf(q);
    EXPECT_FALSE(retraction::rigidBarOf(patch));
    EXPECT_FALSE(barOf(patch).travel_mm || barOf(patch).force_N || patch.capsule);
    EXPECT_EQ(barOf(patch).shape, retraction::BarShape::Straight);
  };
  refuses(retraction::RigidRefusal::Model, [](Parameters& q) { q.method = Method::WendlandAffine; });
  refuses(retraction::RigidRefusal::TimeSteps, [](Parameters& q) { q.dynamic = true; });
  refuses(retraction::RigidRefusal::Condensed, [](Parameters& q) { q.solver = Solver::Condensed; });
  refuses(retraction::RigidRefusal::Corotational,
          [](Parameters& q) { q.kinematics = retraction::Kinematics::Corotational; });
}

TEST(CaseFile, EveryFlippedBitIsFoundAndAWholeVersionNamed) {
  const test::TemporaryFolder folder;
  writeCaseRecord(record(1.0), folder.path());
  writeCaseRecord(record(2.0), folder.path());
  Random random(11);
  for (const char* name : {"case.json", "contours.json", "scene.json"}) {
    const std::string whole = readWhole(folder / name);
    for (int n = 0; n < 25; ++n) {
      std::string damaged = whole;
      const std::size_t at = random.below(damaged.size());
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << random.below(8)));
      std::ofstream(folder / name, std::ios::binary) << damaged;
      // White space between the values of case.json is no content; everything else is.
      const bool blank = std::string(name) == "case.json" &&
                         (std::isspace(static_cast<unsigned char>(whole[at])) != 0) &&
                         (std::isspace(static_cast<unsigned char>(damaged[at])) != 0);
      if (blank) continue;
      try {
        readCaseRecord(folder.path());
        ADD_FAILURE() << name << ": a flipped bit at " << at << " went unseen";
      } catch (const BadInput& e) {
        EXPECT_NE(std::string(e.what()).find("versions/000001"), std::string::npos) << e.what();
      }
    }
    std::ofstream(folder / name, std::ios::binary) << whole;
  }
  EXPECT_NO_THROW(readCaseRecord(folder.path()));
}

TEST(CaseFile, KeepsTheNewestVersions) {
  const test::TemporaryFolder folder;
  for (int n = 1; n <= pipeline::keptVersions + 5; ++n) EXPECT_EQ(writeCaseRecord(record(n), folder.path()), n);
  const auto versions = pipeline::versionsOf(folder.path());
  ASSERT_EQ(versions.size(), static_cast<std::size_t>(pipeline::keptVersions));
  // The newest kept one is the one before the case itself.
  EXPECT_EQ(readCaseRecord(versions.back()).outlines.polygons[0].points_lps_mm(0, 0), pipeline::keptVersions + 4.0);
  EXPECT_EQ(readCaseRecord(versions.front()).outlines.polygons[0].points_lps_mm(0, 0), 5.0);
}

TEST(CaseFile, KilledWhileSavingLeavesTheOldCaseOrTheNew) {
  const test::TemporaryFolder folder;
  // The first coordinate of the outlines says which saving they are from.
  int last = writeCaseRecord(record(1.0), folder.path());
  for (int round = 0; round < 40; ++round) {
    const pid_t child = ::fork();
    if (child == 0)
      for (int n = last + 1;; ++n) writeCaseRecord(record(n), folder.path());
    ::usleep(static_cast<useconds_t>(4000 + 1370 * round));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    // Either what was there or what was being written, never neither.
    const CaseRecord now = readCaseRecord(folder.path());
    EXPECT_GE(now.version, last);
    EXPECT_EQ(now.outlines.polygons[0].points_lps_mm(0, 0), 1.0 * now.version) << "round " << round;
    last = now.version;
  }
}

TEST(CaseFile, AFolderThatCannotBeWrittenKeepsWhatIsThere) {
  EXPECT_THROW(writeCaseRecord(record(1.0), "/proc/no-such-place"), BadInput);
  EXPECT_THROW(writeAtomically("/dev/full/case.json", "text"), BadInput);
}

TEST(WorkFolder, TwoWindowsHaveTwoAndADeadOnesIsCleared) {
  const test::TemporaryFolder folder;
  {
    const WorkFolder one(folder.path()), other(folder.path());
    EXPECT_NE(one.path(), other.path());
    std::ofstream(one.path() / "file") << "1";
    EXPECT_EQ(WorkFolder::removeAbandoned(folder.path()), 0) << "both are in use";
    EXPECT_TRUE(std::filesystem::exists(one.path() / "file"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "an orderly end leaves nothing";
  const pid_t child = ::fork();
  if (child == 0) {
    auto* dead = new WorkFolder(folder.path());
    std::ofstream(dead->path() / "file") << "1";
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_FALSE(std::filesystem::is_empty(folder.path()));
  std::filesystem::create_directory(folder / "synthetic-patient-1");
  EXPECT_EQ(WorkFolder::removeAbandoned(folder.path()), 1);
  EXPECT_TRUE(std::filesystem::exists(folder / "synthetic-patient-1")) << "nobody's work";
  std::filesystem::remove(folder / "synthetic-patient-1");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_THROW(WorkFolder("/proc/no-such-place"), BadInput);
}

TEST(CaseLock, ASecondWindowIsRefusedAndADeadOneTakenOver) {
  const test::TemporaryFolder folder;
  {
    const CaseLock first(folder.path());
    EXPECT_TRUE(first.writable());
    EXPECT_FALSE(first.tookOverStale());
    EXPECT_THROW(CaseLock second(folder.path()), BadInput);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "case.lock"));
  const pid_t child = ::fork();
  if (child == 0) {
    new CaseLock(folder.path());
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(std::filesystem::exists(folder / "case.lock"));
  const CaseLock after(folder.path());
  EXPECT_TRUE(after.tookOverStale());
  EXPECT_TRUE(after.writable());
}

TEST(CaseLock, AnotherMachineCountsWhileItTouchesTheLock) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "case.lock") << "another-machine\n123\n";
  EXPECT_THROW(CaseLock here(folder.path()), BadInput);
  std::filesystem::last_write_time(folder / "case.lock", std::filesystem::file_time_type::clock::now() -
                                                             std::chrono::seconds(CaseLock::staleAfter_s + 5));
  const CaseLock here(folder.path());
  EXPECT_TRUE(here.tookOverStale());
}

TEST(MeasuredContours, ASliceWithoutWaveCountsNoVoxelOnAnySliceOfTheSameElastogramSlice) {
  image::Grid mri, mre;
  mri.size = {40, 40, 12};
  mri.spacing_mm = {2.0, 2.0, 3.0};
  mre.size = {40, 40, 3};
  mre.spacing_mm = {2.0, 2.0, 12.0};
  mre.origin_lps_mm = {0.0, 0.0, 4.5};
  commands::Outlines outlines;
  for (int k = 0; k < 12; ++k) {
    roi::Polygon square;
    square.points_lps_mm.resize(3, 4);
    square.points_lps_mm << 19, 61, 61, 19, 19, 19, 61, 61, 3.0 * k, 3.0 * k, 3.0 * k, 3.0 * k;
    outlines.polygons.push_back(square);
  }
  outlines.marks[5] = commands::SliceMark::NoWave;
  outlines.marks[0] = commands::SliceMark::NoLiver;
  const image::Mask mask = roi::rasterise(measuredContours(outlines, mri, mre), mri);
  for (int k = 0; k < 12; ++k) EXPECT_EQ(mask.at(20, 20, k), k / 4 == 1 ? 0 : 1) << k;
}

}  // namespace
}  // namespace glisson::session
