// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstring>
#include <map>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "dicom/detail/archive.h"
#include "dicom/detail/directory.h"
#include "dicom/detail/image_header.h"
#include "dicom/detail/pixels.h"
#include "dicom/detail/reader_process.h"
#include "dicom/detail/volumes.h"
#include "dicom/roles.h"
#include "dicom/series.h"

namespace glisson::dicom {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t maxFiles = 200'000;
constexpr int maxFolderDepth = 64;

/// Collects the regular files below a folder, in order of their names, and says why the rest is left out.
class FolderWalk {
 public:
  FolderWalk(std::vector<SkippedFile>& skipped, const Progress& progress) : skipped_(skipped), progress_(progress) {}

  void walk(const fs::path& root) {
    std::error_code failed;
    root_ = fs::canonical(root, failed);
    folder(root, 0);
  }

  std::vector<fs::path> files;

 private:
  void folder(const fs::path& where, int depth) {
    progress_.check();
    if (depth > maxFolderDepth) return skip(where, "folders are nested more than 64 deep");
    std::error_code failed;
    std::vector<fs::path> entries;
    for (fs::directory_iterator it(where, failed), end; !failed && it != end; it.increment(failed))
      entries.push_back(it->path());
    if (failed) skip(where, "the folder cannot be read");
    std::sort(entries.begin(), entries.end());
    for (const fs::path& entry : entries) take(entry, depth);
  }

  void take(const fs::path& entry, int depth) {
    std::error_code failed;
    const fs::file_status status = fs::symlink_status(entry, failed);
    switch (status.type()) {
      case fs::file_type::regular:
        if (files.size() >= maxFiles) return skip(entry, "more than 200000 files in one folder; scan a smaller one");
        files.push_back(entry);
        return;
      case fs::file_type::directory: return folder(entry, depth + 1);
      case fs::file_type::symlink: return skip(entry, linkReason(entry));
      default: return skip(entry, "is no regular file (pipe, device or socket)");
    }
  }

  /// Links are never followed: what they point to inside the folder is read where it lies.
  std::string linkReason(const fs::path& entry) const {
    std::error_code failed;
    const fs::path target = fs::canonical(entry, failed);
    if (failed) return "is a link that leads nowhere or in a circle";
    const auto [end, ignored] = std::mismatch(root_.begin(), root_.end(), target.begin(), target.end());
    if (end != root_.end()) return "is a link that leaves the folder";
    return "is a link to something in this folder, which is read where it lies";
  }

  void skip(const fs::path& file, const std::string& reason) { skipped_.push_back({file, reason}); }

  std::vector<SkippedFile>& skipped_;
  const Progress& progress_;
  fs::path root_;
};

/// Whether two files hold the same pixels, value by value; false where either cannot be read.
bool samePixels(const ImageHeader& a, const ImageHeader& b) {
  if (a.rows != b.rows || a.columns != b.columns || a.frames.size() != b.frames.size() || a.samples != b.samples)
    return false;
  if (a.samples != 1) return true;  // pictures, never measured
  try {
    PixelReader one(a.file), other(b.file);
    const std::size_t count = static_cast<std::size_t>(a.sliceRows()) * static_cast<std::size_t>(a.sliceColumns());
    std::vector<float> x(count), y(count);
    for (std::size_t f = 0; f < a.frames.size(); ++f) {
      one.read(a.frames[f], x.data());
      other.read(b.frames[f], y.data());
      if (std::memcmp(x.data(), y.data(), count * sizeof(float)) != 0) return false;
    }
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

/// Drops copies of an image (same SOP instance at the same place with the same pixels). Where the pixels differ, which
/// of the two was measured is not known: the series that holds them is refused.
void dropCopies(std::vector<ImageHeader>& headers, std::vector<SkippedFile>& skipped) {
  std::map<std::string, ImageHeader*> seen;
  std::vector<ImageHeader> kept;
  kept.reserve(headers.size());  // so that the pointers in seen stay valid
  for (ImageHeader& h : headers) {
    const auto known = seen.find(h.sopInstanceUid);
    if (h.sopInstanceUid.empty() || known == seen.end()) {
      kept.push_back(std::move(h));
      if (!kept.back().sopInstanceUid.empty()) seen[kept.back().sopInstanceUid] = &kept.back();
      continue;
    }
    const Frame& a = known->second->frames.front();
    if ((a.position_lps_mm - h.frames.front().position_lps_mm).norm() < 1e-3) {
      if (!samePixels(*known->second, h)) {
        skipped.push_back({h.file, "holds other pixels than '" + known->second->file.filename().string() +
                                       "', though it has the same SOP instance and position"});
        known->second->contradicted = h.file;
        continue;
      }
      skipped.push_back(
          {h.file, "is a copy of '" + known->second->file.filename().string() + "' (same SOP instance and position)"});
    } else {
      h.warnings.push_back("has the SOP Instance UID of another image");
      kept.push_back(std::move(h));
    }
  }
  headers = std::move(kept);
}

}  // namespace

namespace {

/// What a file gave: its header, or why there is none; neither where a reader process has to parse it.
struct Read {
  std::optional<ImageHeader> header;
  std::optional<RefusedFile> refused;
};

/// Calls take(file, read) for each file in order; plain files are parsed by several threads at a time.
template <typename Take>
void readHeaders(const std::vector<fs::path>& files, const Progress& progress, const Take& take) {
  constexpr std::size_t atOnce = 512, chunk = 16;
  for (std::size_t first = 0; first < files.size(); first += atOnce) {
    progress.report(static_cast<double>(first) / static_cast<double>(files.size()), "reading image headers");
    std::vector<Read> reads(std::min(atOnce, files.size() - first));
    const auto attempt = [&](std::size_t n, const auto& how) {
      try {
        how(reads[n], files[first + n]);
      } catch (const RefusedFile& e) {
        reads[n].refused = e;
      } catch (const BadInput& e) {
        reads[n].refused.emplace().reason = e.what();
      }
    };
    parallelChunks(reads.size(), chunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n)
        attempt(n, [](Read& read, const fs::path& file) {
          if (lowerCase(file.filename().string()) == "dicomdir")
            throw BadInput("is a DICOMDIR index; the files are read directly");
          read.header = readPlainHeader(file);
        });
    });
    for (std::size_t n = 0; n < reads.size(); ++n) {
      if (!reads[n].header && !reads[n].refused) {
        progress.check();
        attempt(n, [](Read& read, const fs::path& file) { read.header = readHeaderSafely(file); });
      }
      take(files[first + n], reads[n]);
    }
  }
}

ScanResult scanFiles(const std::vector<fs::path>& files, ScanResult result, const Progress& progress) {
  std::map<std::string, std::vector<ImageHeader>> bySeries;
  std::map<std::string, std::vector<fs::path>> refused;
  readHeaders(files, progress, [&](const fs::path& file, Read& read) {
    if (read.header) {
      const std::string uid = read.header->seriesUid;
      bySeries[uid].push_back(*std::move(read.header));
      return;
    }
    const RefusedFile& e = *read.refused;
    result.skipped.push_back({file, e.reason == "is not a DICOM file" && looksLikeZip(file)
                                        ? "is a ZIP archive; open it by itself"
                                        : e.reason});
    if (!e.seriesUid.empty()) refused[e.seriesUid].push_back(file);
  });

  for (auto& [uid, headers] : bySeries) {
    dropCopies(headers, result.skipped);
    std::vector<Series> volumes = buildVolumes(headers);
    checkCounts(headers, volumes);
    setRoles(volumes);
    const auto incomplete = refused.find(uid);
    for (Series& s : volumes) {
      if (incomplete != refused.end() && !s.error)
        s.error = "it is incomplete: '" + incomplete->second.front().filename().string() + "'" +
                  (incomplete->second.size() > 1
                       ? " and " + std::to_string(incomplete->second.size() - 1) + " more of its files were"
                       : std::string(" was")) +
                  " refused (see the skipped files)";
      result.series.push_back(std::move(s));
    }
  }
  std::stable_sort(result.series.begin(), result.series.end(),
                   [](const Series& a, const Series& b) { return a.number < b.number; });
  std::stable_sort(result.skipped.begin(), result.skipped.end(),
                   [](const SkippedFile& a, const SkippedFile& b) { return a.file < b.file; });
  progress.report(1.0, "reading image headers");
  return result;
}

/// Unpacks and scans; files of the private folder are named as entries of the archive.
ScanResult scanArchive(const fs::path& path, const Progress& progress) {
  ScanResult result;
  std::shared_ptr<const PrivateFolder> folder;
  try {
    folder = unpackArchive(path, result.skipped);
  } catch (const RefusedFile& e) {
    return {{}, {{path, e.reason}}};
  } catch (const BadInput& e) {
    return {{}, {{path, e.what()}}};
  }
  FolderWalk walk(result.skipped, progress);
  walk.walk(folder->path());
  result = scanFiles(walk.files, std::move(result), progress);
  for (Series& s : result.series) s.folder = folder;
  for (SkippedFile& s : result.skipped) {
    const fs::path inside = s.file.lexically_relative(folder->path());
    if (!inside.empty() && *inside.begin() != "..") s.file = path / inside;
  }
  return result;
}

}  // namespace

ScanResult scan(const fs::path& path, const Progress& progress) {
  ScanResult result;
  std::error_code failed;
  const fs::file_status status = fs::status(path, failed);
  if (!fs::exists(status)) throw BadInput("'" + path.filename().string() + "' does not exist");
  if (fs::is_directory(status)) {
    FolderWalk walk(result.skipped, progress);
    walk.walk(path);
    return scanFiles(walk.files, std::move(result), progress);
  }
  if (fs::is_regular_file(status) && looksLikeZip(path)) return scanArchive(path, progress);
  if (lowerCase(path.filename().string()) != "dicomdir") return scanFiles({path}, std::move(result), progress);
  std::vector<fs::path> files;
  try {
    files = listedFiles(path, result.skipped);
  } catch (const RefusedFile& e) {
    result.skipped.push_back({path, e.reason});
  }
  return scanFiles(files, std::move(result), progress);
}

}  // namespace glisson::dicom
