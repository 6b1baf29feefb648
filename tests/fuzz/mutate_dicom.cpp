// SPDX-License-Identifier: GPL-3.0-or-later

// Scans and reads mutated DICOM files: no crash, none over 2 s, memory within 256 MiB + 3 × the file. Usage:
//   mutate_dicom <count> <seed> <folder> [<folder> ...]
// Files of the folders are the originals (1 MiB at most each; larger ones are left out). Exit code 0: all is well; 1: a
// file took too long or too much memory (its number is printed: the same seed makes it again); a crash ends the
// program.
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "dicom/series.h"
#include "mutate.h"

namespace {

namespace fs = std::filesystem;
constexpr std::uintmax_t largest = 1U << 20;

/// The originals, by the folder that they lie in: each folder is as likely as the others, however full.
std::map<fs::path, std::vector<fs::path>> originals(int folders, char** names) {
  std::map<fs::path, std::vector<fs::path>> files;
  for (int n = 0; n < folders; ++n) {
    std::error_code failed;
    for (const auto& e : fs::recursive_directory_iterator(names[n], failed)) {
      const std::string kind = e.path().extension().string();
      const bool image = kind == ".dcm" || kind == ".ima" || kind == ".zip" || kind.empty() ||
                         std::isdigit(static_cast<unsigned char>(kind.back())) != 0;
      if (e.is_regular_file() && e.file_size() <= largest && image) files[e.path().parent_path()].push_back(e.path());
    }
  }
  for (auto& [folder, list] : files) std::sort(list.begin(), list.end());
  return files;
}

std::string contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}

/// "read", or the first words of the reason.
std::string outcomeOf(const fs::path& file) {
  const glisson::dicom::ScanResult found = glisson::dicom::scan(file);
  std::string what = found.skipped.empty() ? "nothing" : found.skipped.front().reason;
  for (const glisson::dicom::Series& s : found.series) {
    try {
      what = glisson::dicom::readSeries(s).values.size() == s.grid.voxelCount() ? "read" : "WRONG SIZE";
    } catch (const glisson::BadInput& e) {
      what = e.what();
    }
  }
  return what;
}

double peak_MiB() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return static_cast<double>(used.ru_maxrss) / 1024.0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::cerr << "usage: mutate_dicom <count> <seed> <folder> [<folder> ...]\n";
    return 2;
  }
  const long count = std::atol(argv[1]);
  const auto seed = static_cast<std::uint64_t>(std::atoll(argv[2]));
  const auto files = originals(argc - 3, argv + 3);
  if (files.empty()) {
    std::cout << "skipped: there are no files to mutate beside this checkout\n";
    return 77;
  }
#ifdef GLISSON_READER
  glisson::dicom::setReaderProgram(GLISSON_READER);
#endif
  const fs::path work = fs::temp_directory_path() / ("glisson-mutate-" + std::to_string(getpid()));
  std::map<std::string, long> outcomes;
  double slowest_s = 0.0;
  long bad = 0;
  for (long n = 0; n < count; ++n) {
    glisson::Random random(seed * 1'000'003 + static_cast<std::uint64_t>(n));
    const auto& list = std::next(files.begin(), static_cast<std::ptrdiff_t>(random.below(files.size())))->second;
    const fs::path& original = list[random.below(list.size())];
    std::ofstream(work, std::ios::binary) << glisson::test::mutated(contentOf(original), random);
    const auto begin = std::chrono::steady_clock::now();
    const std::string what = outcomeOf(work);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    slowest_s = std::max(slowest_s, taken.count());
    if (taken.count() > 2.0 || what == "WRONG SIZE") {
      std::cout << "file " << n << " (from " << original.filename().string() << "): " << taken.count() << " s, "
                << what.substr(0, 120) << "\n";
      ++bad;
    }
    std::string kind = what.substr(0, 34);
    for (const char* crash : {"makes the decoder crash", "takes longer", "gave no answer", "asks for more memory"})
      if (what.find(crash) != std::string::npos) kind = std::string("CHILD: ") + crash;
    ++outcomes[what == "read" ? what : kind.substr(0, kind.find_first_of("0123456789"))];
  }
  fs::remove(work);
  std::vector<std::pair<long, std::string>> common;
  for (const auto& [what, times] : outcomes) common.emplace_back(times, what);
  std::sort(common.rbegin(), common.rend());
  for (const auto& [times, what] : common)
    if (what.starts_with("CHILD") || times * 200 > count) std::cout << times << "  " << what << "\n";
  std::cout << count << " mutated files of " << files.size() << " folders: slowest " << slowest_s << " s, peak memory "
            << peak_MiB() << " MiB\n";
#ifndef __SANITIZE_ADDRESS__
  if (peak_MiB() > 256.0 + 3.0 * static_cast<double>(largest) / 1048576.0) {
    std::cout << "more memory than 256 MiB and three times the largest file\n";
    ++bad;
  }
#endif
  return bad > 0 ? 1 : 0;
}
