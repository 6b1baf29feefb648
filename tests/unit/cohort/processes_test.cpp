// SPDX-License-Identifier: GPL-3.0-or-later
#include "cohort/processes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <thread>

#include "base/error.h"

namespace glisson::cohort {
namespace {

Job shell(const std::string& script) {
  return {"job", {"-c", script}};
}

std::map<std::size_t, JobOutcome> runAll(const std::vector<Job>& jobs, int parallel, const Progress& progress = {}) {
  std::map<std::size_t, JobOutcome> out;
  runJobs(
      "/bin/sh", jobs, parallel, [&](std::size_t i, const JobOutcome& o) { out[i] = o; }, progress);
  return out;
}

TEST(Processes, GiveOutputMessageAndCode) {
  const auto out =
      runAll({shell("echo one; echo first >&2; echo last >&2; exit 3"), shell("printf two"), shell("kill -9 $$")}, 2);
  ASSERT_EQ(out.size(), 3u);
  EXPECT_EQ(out.at(0).exitCode, 3);
  EXPECT_EQ(out.at(0).standardOutput, "one\n");
  EXPECT_EQ(out.at(0).message, "last");
  EXPECT_EQ(out.at(1).exitCode, 0);
  EXPECT_EQ(out.at(1).standardOutput, "two");
  EXPECT_EQ(out.at(2).signal, 9);
  EXPECT_GT(out.at(1).peak_MB, 0.0);
}

TEST(Processes, TakeMoreOutputThanAPipeHolds) {
  const auto out =
      runAll({shell("head -c 3000000 /dev/zero; head -c 300000 /dev/zero >&2; echo >&2; echo end >&2")}, 1);
  EXPECT_EQ(out.at(0).standardOutput.size(), 3000000u);
  EXPECT_EQ(out.at(0).message, "end");
}

TEST(Processes, RunAtMostSoManyAtATime) {
  // Each job notes that it runs, looks who else does, and leaves.
  const std::string folder = testing::TempDir() + "/glisson-processes";
  ASSERT_EQ(std::system(("rm -rf " + folder + " && mkdir " + folder).c_str()), 0);
  const std::string script = "touch " + folder + "/$$; ls " + folder + " | wc -l; sleep 0.05; rm " + folder + "/$$";
  const auto out = runAll(std::vector<Job>(12, shell(script)), 3);
  int most = 0;
  for (const auto& [i, o] : out) most = std::max(most, std::stoi(o.standardOutput));
  EXPECT_LE(most, 3);
  EXPECT_GE(most, 2);
}

TEST(Processes, EndWhenAStopIsRequested) {
  std::stop_source stop;
  std::jthread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    stop.request_stop();
  });
  const auto start = std::chrono::steady_clock::now();
  // The second one does not listen to polite requests.
  EXPECT_THROW(runAll({shell("exec sleep 60"), shell("trap '' TERM; while :; do sleep 0.1; done")}, 2,
                      Progress({}, stop.get_token())),
               Cancelled);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST(Processes, RefuseAProgramThatIsNotThere) {
  EXPECT_THROW(runJobs("/nowhere/program", {shell("")}, 1, [](std::size_t, const JobOutcome&) {}), BadInput);
}

TEST(Processes, FitIntoMemory) {
  EXPECT_GE(jobsThatFit(1.0), 1);
  EXPECT_EQ(jobsThatFit(1e9), 1);
  EXPECT_GE(threadsEach(1), threadsEach(2));
  EXPECT_EQ(threadsEach(100000), 1);
}

}  // namespace
}  // namespace glisson::cohort
