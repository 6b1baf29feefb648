// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include "base/error.h"
#include "base/random.h"
#include "session/journal.h"
#include "support/support.h"
#include "tool_bench.h"

namespace glisson::session {
namespace {

roi::Polygon triangle(double x, double z) {
  roi::Polygon p;
  p.points_lps_mm.resize(3, 3);
  p.points_lps_mm << x, x + 10.0 / 3.0, x, 0.1, 0.2, 7.7, z, z, z;
  return p;
}

bool same(const roi::Polygon& a, const roi::Polygon& b) {
  return a.points_lps_mm.cols() == b.points_lps_mm.cols() && a.points_lps_mm == b.points_lps_mm && a.state == b.state;
}

TEST(Journal, HoldsEveryGestureToTheBitDraftsMarksAndTheOutlineInWork) {
  const test::TemporaryFolder folder;
  Journal journal(folder.path());
  journal.begin("patient", "case.json", "1.2.3");
  commands::Outlines outlines;
  outlines.name = "liver";
  for (int n = 0; n < 30; ++n) {
    outlines.polygons.push_back(triangle(n / 7.0, n));
    if (n % 3 == 0) outlines.polygons[static_cast<std::size_t>(n / 2)].points_lps_mm(0, 1) += 1.0 / 3.0;
    if (n % 5 == 4) outlines.polygons.erase(outlines.polygons.begin());
    outlines.polygons.back().state = n % 2 == 0 ? roi::PolygonState::Draft : roi::PolygonState::Accepted;
    outlines.marks[n] = n % 2 == 0 ? commands::SliceMark::NoLiver : commands::SliceMark::NoWave;
    roi::Polygon inWork;
    inWork.state = roi::PolygonState::Draft;
    if (n % 4 == 1) inWork.points_lps_mm = Eigen::Matrix3Xd::Constant(3, 1, n / 3.0);
    journal.write(outlines, inWork, {}, true);
    const auto read = Journal::read(journal.file());
    ASSERT_TRUE(read) << n;
    EXPECT_TRUE(test::same(read->outlines, outlines)) << n;
    EXPECT_EQ(read->outlines.marks, outlines.marks);
    EXPECT_TRUE(same(read->inWork, inWork) || (n % 4 != 1 && read->inWork.points_lps_mm.cols() == 0));
    EXPECT_EQ(read->source, "patient");
    EXPECT_EQ(read->caseFile, "case.json");
    EXPECT_EQ(read->seriesUid, "1.2.3");
  }
}

TEST(Journal, HoldsRolesAnswersParametersAndWhatWasLaidByHand) {
  const test::TemporaryFolder folder;
  Journal journal(folder.path());
  journal.begin("patient", "", "");
  Settings settings;
  journal.write({}, {}, settings, false);
  EXPECT_EQ(Journal::read(journal.file())->settings, settings);
  settings.choices.roles["1.2"] = dicom::SeriesRole::Anatomical;
  settings.choices.together = false;
  settings.choices.quantity = StiffnessQuantity::Youngs;
  settings.choices.unit = "Pa";
  settings.measure = {true, 5};
  for (int n = 0; n < 20; ++n) {
    settings.parameters.poisson = 0.3 + n / 200.0;
    settings.parameters.placement.barAt_lps = Eigen::Vector3d(n / 7.0, 1.0 / 3.0, -n);
    settings.parameters.placement.hoistDirection = Eigen::Vector3d(0.1 * n, -1.0, 0.3).normalized();
    settings.parameters.placement.holds.push_back({Eigen::Vector3d(n, 0.1, 0.2), 3.0 + n});
    journal.write({}, {}, settings, true);
    // What does not change with a record stays.
    if (n % 2 == 0) journal.write({}, triangle(1.0, n), settings, true);
    const auto read = Journal::read(journal.file());
    ASSERT_TRUE(read && read->settings) << n;
    EXPECT_EQ(*read->settings, settings) << n;
  }
}

TEST(Journal, ATornOrFlippedTailCostsNothingBeforeIt) {
  const test::TemporaryFolder folder;
  std::string text;
  std::vector<std::uintmax_t> ends;
  std::vector<commands::Outlines> states;
  {
    Journal journal(folder.path());
    journal.begin("patient", "", "");
    commands::Outlines outlines;
    for (int n = 0; n < 6; ++n) {
      outlines.polygons.push_back(triangle(n, n));
      journal.write(outlines, {}, {}, true);
      ends.push_back(std::filesystem::file_size(journal.file()));
      states.push_back(outlines);
    }
    std::ifstream in(journal.file(), std::ios::binary);
    text.assign(std::istreambuf_iterator<char>(in), {});
  }
  const auto file = folder / "journal-1-0";
  const auto readBack = [&](const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
    return Journal::read(file);
  };
  Random random(3);
  for (int n = 0; n < 200; ++n) {
    const std::size_t at = random.below(text.size());
    std::size_t whole = 0;
    while (whole < ends.size() && ends[whole] <= at) ++whole;
    const bool flip = n % 2 == 0;
    std::string damaged = flip ? text : text.substr(0, at);
    if (flip) damaged[at] = static_cast<char>(damaged[at] ^ (1 << random.below(8)));
    const auto read = readBack(damaged);
    // The last byte of a record is its line's end: losing that alone loses nothing.
    const std::size_t held = read ? read->gestures : 0;
    EXPECT_GE(held, whole) << (flip ? "flipped at " : "torn at ") << at;
    EXPECT_LE(held, whole + 1);
    if (held > 0) {
      EXPECT_TRUE(test::same(read->outlines, states[held - 1]));
    }
  }
}

TEST(Journal, AnOrderlyEndLeavesNothingToRecover) {
  const test::TemporaryFolder folder;
  {
    Journal journal(folder.path());
    journal.begin("patient", "", "");
    commands::Outlines outlines;
    outlines.polygons.push_back(triangle(0, 0));
    journal.write(outlines, {}, {}, true);
    EXPECT_TRUE(Journal::abandoned(folder.path()).empty()) << "its program is alive";
  }
  EXPECT_TRUE(Journal::abandoned(folder.path()).empty());
}

TEST(Journal, KilledAtRandomMomentsLosesAtMostTheGestureInProgress) {
  for (int round = 0; round < 12; ++round) {
    const test::TemporaryFolder folder;
    int told[2];
    ASSERT_EQ(::pipe(told), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      // A reader who draws as fast as the machine allows, and says aloud which gesture is done.
      Journal journal(folder.path());
      journal.begin("patient", "", "");
      commands::Outlines outlines;
      for (std::uint32_t n = 1;; ++n) {
        outlines.polygons.push_back(triangle(n, n));
        if (outlines.polygons.size() > 40) outlines.polygons.erase(outlines.polygons.begin());
        journal.write(outlines, {}, {}, true);
        if (::write(told[1], &n, sizeof n) != sizeof n) ::_exit(1);
      }
    }
    ::close(told[1]);
    std::uint32_t last = 0, n = 0;
    const auto enough = static_cast<std::uint32_t>(5 + 37 * round % 90);
    while (::read(told[0], &n, sizeof n) == sizeof n) {
      last = n;
      if (last == enough) ::kill(child, SIGKILL);
    }
    ::close(told[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    const auto found = Journal::abandoned(folder.path());
    ASSERT_EQ(found.size(), 1u);
    EXPECT_GE(found[0].gestures, last);
    EXPECT_LE(found[0].gestures, last + 1);
    EXPECT_EQ(found[0].outlines.polygons.back().points_lps_mm(0, 0), static_cast<double>(found[0].gestures));
  }
}

TEST(Journal, StaysSmallOverALongDay) {
  const test::TemporaryFolder folder;
  Journal journal(folder.path());
  journal.begin("patient", "", "");
  commands::Outlines outlines;
  roi::Polygon large;
  large.points_lps_mm = Eigen::Matrix3Xd::Random(3, 4000);
  outlines.polygons.assign(2, large);
  for (int n = 0; n < 120; ++n) {
    outlines.polygons[0].points_lps_mm(0, 0) = n;
    journal.write(outlines, {}, {}, true);
  }
  EXPECT_LT(std::filesystem::file_size(journal.file()), 20u << 20);
  const auto read = Journal::read(journal.file());
  ASSERT_TRUE(read);
  EXPECT_EQ(read->outlines.polygons[0].points_lps_mm(0, 0), 119.0);
  EXPECT_TRUE(Journal::abandoned(folder.path()).empty()) << "still locked after it was made small";
}

TEST(Journal, AFolderThatCannotBeWrittenIsSaidSo) {
  EXPECT_THROW(Journal("/proc/no-such-place"), BadInput);
}

}  // namespace
}  // namespace glisson::session
