// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>

#include "base/error.h"
#include "base/folder_claim.h"
#include "base/part_file.h"
#include "base/private_folder.h"
#include "support/support.h"

namespace glisson {
namespace {

namespace fs = std::filesystem;

std::string textOf(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::size_t entriesOf(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}));
}

/// The temporary folder of the system is another one while it lives.
class TemporaryElsewhere {
 public:
  explicit TemporaryElsewhere(const fs::path& folder) {
    if (const char* was = std::getenv("TMPDIR")) was_ = was;
    setenv("TMPDIR", folder.c_str(), 1);
  }
  ~TemporaryElsewhere() { was_ ? setenv("TMPDIR", was_->c_str(), 1) : unsetenv("TMPDIR"); }

 private:
  std::optional<std::string> was_;
};

/// A program that makes a private folder with a file in it and is killed; waits for its end.
void killedWithAPrivateFolder() {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    const PrivateFolder folder;
    std::ofstream(folder.path() / "image") << "of a patient";
    if (write(ready[1], "x", 1) == 1) pause();
    _exit(1);
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  close(ready[0]);
  close(ready[1]);
}

TEST(PrivateFolder, IsOfThisUserAloneAndGoesWithWhatItHolds) {
  const test::TemporaryFolder base;
  const TemporaryElsewhere elsewhere(base.path());
  {
    const PrivateFolder folder;
    std::ofstream(folder.path() / "image") << "of a patient";
    EXPECT_EQ(fs::status(folder.path()).permissions(), fs::perms::owner_all);
    EXPECT_EQ(folder.path().parent_path(), base.path());
  }
  EXPECT_EQ(entriesOf(base.path()), 0u);
}

TEST(PrivateFolder, OfAKilledProgramIsRemovedByTheNextOne) {
  const test::TemporaryFolder base;
  const TemporaryElsewhere elsewhere(base.path());
  const PrivateFolder inUse;
  killedWithAPrivateFolder();
  // Of a name like ours, but not locked by us: not ours to remove.
  fs::create_directory(base / "glisson-notes");
  EXPECT_EQ(entriesOf(base.path()), 5u) << "two folders, their locks, and the notes";
  // As if an hour had passed: younger ones may just be in the making.
  for (const fs::directory_entry& e : fs::directory_iterator(base.path()))
    fs::last_write_time(e.path(), fs::file_time_type::clock::now() - std::chrono::hours(1));
  { const PrivateFolder next; }
  EXPECT_EQ(entriesOf(base.path()), 3u);
  EXPECT_TRUE(fs::is_directory(inUse.path())) << "its program lives";
  EXPECT_TRUE(fs::is_directory(base / "glisson-notes"));
}

TEST(FolderClaim, IsGivenToOneAtATimeAndLeavesNothing) {
  const test::TemporaryFolder folder;
  {
    const FolderClaim claim(folder.path());
    EXPECT_THROW(FolderClaim{folder.path()}, BadInput);
    const pid_t child = fork();
    if (child == 0) {
      try {
        const FolderClaim another(folder.path());
      } catch (const BadInput&) {
        _exit(0);
      }
      _exit(1);
    }
    int status = -1;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0) << "nor to another program";
  }
  EXPECT_NO_THROW(FolderClaim{folder.path()});
  EXPECT_EQ(entriesOf(folder.path()), 0u);
}

TEST(PartFile, BecomesTheFileWholeOrLeavesItAsItWas) {
  const test::TemporaryFolder folder;
  const fs::path file = folder / "result";
  std::ofstream(file) << "former";
  {
    PartFile part(file);
    part.write("half", 4);
    EXPECT_EQ(textOf(file), "former");
  }
  EXPECT_EQ(textOf(file), "former");
  EXPECT_EQ(entriesOf(folder.path()), 1u);
  PartFile part(file);
  part.write("whole", 5);
  part.become();
  EXPECT_EQ(textOf(file), "whole");
  EXPECT_EQ(entriesOf(folder.path()), 1u);
}

TEST(PartFile, FollowsNoLinkAndHasANameThatNobodyForesees) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "elsewhere") << "untouched";
  const fs::path file = folder / "result";
  const PartFile one(file), two(file);
  EXPECT_NE(one.path(), two.path());
  EXPECT_EQ(one.path().parent_path(), folder.path());
  // A link in the place of the file is replaced, not written through.
  fs::create_symlink(folder / "elsewhere", file);
  PartFile part(file);
  part.write("new", 3);
  part.become();
  EXPECT_FALSE(fs::is_symlink(file));
  EXPECT_EQ(textOf(file), "new");
  EXPECT_EQ(textOf(folder / "elsewhere"), "untouched");
  // Nor is one that was put where the new file lay.
  PartFile swapped(folder / "other");
  fs::remove(swapped.path());
  fs::create_symlink(folder / "elsewhere", swapped.path());
  EXPECT_THROW(swapped.become(), BadInput);
  EXPECT_FALSE(fs::exists(folder / "other"));
}

TEST(PartFile, NamesTheFileThatCannotBeWritten) {
  const test::TemporaryFolder folder;
  try {
    const PartFile part(folder / "missing" / "result");
    FAIL() << "there is no such folder";
  } catch (const BadInput& e) {
    EXPECT_NE(std::string(e.what()).find("'result'"), std::string::npos) << e.what();
    EXPECT_EQ(std::string(e.what()).find(folder.path().string()), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace glisson
