// SPDX-License-Identifier: GPL-3.0-or-later
#include <archive.h>
#include <archive_entry.h>
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <sys/stat.h>

#include <fstream>
#include <set>
#include <sstream>
#include <utility>

#include "dicom/detail/archive.h"
#include "said.h"

namespace glisson::dicom {
namespace {

using test::DicomBytes;
using test::TemporaryFolder;
using testing::HasSubstr;
namespace fs = std::filesystem;

/// Writes a ZIP archive; links are made of entries whose content begins with "link:".
fs::path writeZip(const fs::path& file, const std::vector<std::pair<std::string, std::string>>& entries,
                  const char* options = nullptr) {
  struct archive* out = archive_write_new();
  archive_write_set_format_zip(out);
  if (options != nullptr) {
    EXPECT_EQ(archive_write_set_options(out, options), ARCHIVE_OK);
    archive_write_set_passphrase(out, "secret");
  }
  EXPECT_EQ(archive_write_open_filename(out, file.c_str()), ARCHIVE_OK);
  for (const auto& [name, content] : entries) {
    archive_entry* e = archive_entry_new();
    archive_entry_set_pathname(e, name.c_str());
    archive_entry_set_perm(e, 0777);
    const bool link = content.starts_with("link:");
    archive_entry_set_filetype(e, link ? AE_IFLNK : AE_IFREG);
    if (link) archive_entry_set_symlink(e, content.substr(5).c_str());
    archive_entry_set_size(e, link ? 0 : static_cast<la_int64_t>(content.size()));
    EXPECT_EQ(archive_write_header(out, e), ARCHIVE_OK);
    if (!link) {
      EXPECT_EQ(archive_write_data(out, content.data(), content.size()), static_cast<la_ssize_t>(content.size()));
    }
    archive_entry_free(e);
  }
  archive_write_close(out);
  archive_write_free(out);
  return file;
}

std::string slice(int k) {
  DicomBytes d;
  d.sopUid += "." + std::to_string(k);
  d.position = "0\\0\\" + std::to_string(5 * k);
  return d.bytes();
}

std::string reasons(const ScanResult& found) {
  std::string all;
  for (const SkippedFile& s : found.skipped) all += s.file.string() + ": " + s.reason + "\n";
  return all;
}

TEST(Archives, seriesOfAZipAreReadAndNothingStays) {
  const TemporaryFolder folder;
  const fs::path zip =
      writeZip(folder / "study.zip", {{"a/IM0", slice(0)}, {"a/IM1", slice(1)}, {"b/IM2", slice(2)}, {"note", "text"}});
  fs::path inside;
  {
    const ScanResult found = scan(zip);
    ASSERT_EQ(found.series.size(), 1U) << reasons(found);
    const Series& s = found.series.front();
    EXPECT_EQ(readSeries(s).grid.size, Eigen::Vector3i(4, 3, 3));
    EXPECT_THAT(reasons(found), HasSubstr("study.zip/note: is too short to be a DICOM file"));
    inside = s.files.front().parent_path().parent_path();
    struct stat status {};
    ASSERT_EQ(stat(inside.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, 0700U);
    EXPECT_TRUE(fs::exists(inside / "a" / "IM0"));
  }
  EXPECT_FALSE(fs::exists(inside));
}

TEST(Archives, entriesNeverLeaveTheirFolder) {
  const TemporaryFolder folder;
  const fs::path zip = writeZip(folder / "evil.zip", {{"../escaped", slice(0)},
                                                      {"a/../../escaped2", slice(0)},
                                                      {"/escaped3", slice(0)},
                                                      {"link", "link:/etc/passwd"},
                                                      {"inner.zip", "PK"},
                                                      {"good", slice(0)},
                                                      {"good", slice(1)},
                                                      {"good/below", slice(2)}});
  const ScanResult found = scan(zip);
  const std::string said = reasons(found);
  ASSERT_EQ(found.series.size(), 1U) << said;
  EXPECT_EQ(found.series.front().files.size(), 1U);
  EXPECT_THAT(said, HasSubstr("no plain path inside the archive"));
  EXPECT_THAT(said, HasSubstr("link: is a link or special file"));
  EXPECT_THAT(said, HasSubstr("inner.zip: is an archive inside the archive"));
  EXPECT_THAT(said, HasSubstr("occurs twice in the archive"));
  EXPECT_FALSE(fs::exists(folder / "escaped"));
  EXPECT_FALSE(fs::exists(folder.path().parent_path() / "escaped"));
  EXPECT_FALSE(fs::exists(folder.path().parent_path() / "escaped2"));
  EXPECT_FALSE(fs::exists("/escaped3"));
}

TEST(Archives, bombsEncryptedAndDamagedOnesAreRefused) {
  const TemporaryFolder folder;
  std::vector<std::pair<std::string, std::string>> bomb;
  const std::string zeros(64U << 20, '\0');
  for (int n = 0; n < 6; ++n) bomb.emplace_back("z" + std::to_string(n), zeros);
  const auto unpacked = [] {
    std::set<fs::path> all;
    for (const auto& e : fs::directory_iterator(fs::temp_directory_path())) {
      const std::string name = e.path().filename().string();
      if (name.starts_with("glisson-") && name.size() == 14) all.insert(e.path());
    }
    return all;
  };
  const std::set<fs::path> before = unpacked();
  EXPECT_THAT(reasons(scan(writeZip(folder / "bomb.zip", bomb))), HasSubstr("unpacks to more than 256 MiB"));
  for (const fs::path& e : unpacked()) {
    if (!before.contains(e)) {
      EXPECT_LT(fs::exists(e / "z0") ? fs::file_size(e / "z0") : 0, zeros.size()) << "a bomb was left behind";
    }
  }
  EXPECT_THAT(reasons(scan(writeZip(folder / "secret.zip", {{"im", slice(0)}}, "zip:encryption=aes256"))),
              HasSubstr("is encrypted in the archive"));
  std::ifstream in(writeZip(folder / "whole.zip", {{"a", slice(0)}, {"b", slice(1)}}), std::ios::binary);
  std::ostringstream all;
  all << in.rdbuf();
  const std::string whole = all.str();
  for (std::size_t keep = 4; keep < whole.size(); keep += 37) {
    const ScanResult found = scan(DicomBytes::write(folder / "cut.zip", whole.substr(0, keep)));
    EXPECT_FALSE(found.skipped.empty() && found.series.empty()) << keep;
  }
  EXPECT_THAT(reasons(scan(DicomBytes::write(folder / "fake.zip", "PK\3\4 and no more than that"))),
              HasSubstr("ZIP archive"));
  // In a folder an archive is listed, and opened only when it is asked for by itself.
  EXPECT_THAT(reasons(scan(folder.path())), HasSubstr("whole.zip: is a ZIP archive; open it by itself"));
}

/// A DICOMDIR that lists these files.
std::string directoryOf(const std::vector<std::string>& ids) {
  std::string records;
  for (const std::string& id : ids) {
    const std::string record =
        DicomBytes::element(0x00041430, "CS", "IMAGE") + DicomBytes::element(0x00041500, "CS", id);
    records += DicomBytes::tag(0xFFFEE000) + DicomBytes::little(record.size(), 4) + record;
  }
  return DicomBytes::meta(DicomBytes::explicitLittle) + DicomBytes::element(0x00041220, "SQ", records);
}

TEST(Directories, onlyWhatIsListedIsReadAndWhatIsMissingIsNamed) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "DICOM");
  for (int k = 0; k < 3; ++k) DicomBytes::write(folder.path() / "DICOM" / ("im" + std::to_string(k)), slice(k));
  DicomBytes other;
  other.seriesUid = "1.2.3.5";
  other.write(folder.path() / "DICOM" / "unlisted");
  fs::create_symlink("/dev/zero", folder.path() / "DICOM" / "zero");
  DicomBytes::write(folder / "DICOMDIR",
                    directoryOf({"DICOM\\IM0", "DICOM\\IM1", "DICOM\\IM2", "DICOM\\IM3", "..\\IM0", "DICOM\\ZERO"}));
  const ScanResult found = scan(folder / "DICOMDIR");
  ASSERT_EQ(found.series.size(), 1U) << reasons(found);
  EXPECT_EQ(readSeries(found.series.front()).grid.size.z(), 3);
  ASSERT_EQ(found.skipped.size(), 3U) << reasons(found);
  EXPECT_THAT(reasons(found), HasSubstr("IM3: is listed in the DICOMDIR and missing"));
  EXPECT_THAT(reasons(found), HasSubstr("no plain path"));
  EXPECT_THAT(reasons(found), HasSubstr("ZERO: is listed in the DICOMDIR and is a link"));
  EXPECT_EQ(scan(folder.path()).series.size(), 2U);  // the folder itself: everything in it
  DicomBytes::write(folder / "DICOMDIR", DicomBytes().bytes());
  EXPECT_THAT(reasons(scan(folder / "DICOMDIR")), HasSubstr("is no DICOMDIR"));
}

}  // namespace
}  // namespace glisson::dicom
