// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/directory.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <map>

#include "base/error.h"
#include "base/text.h"
#include "dicom/detail/attributes.h"
#include "dicom/detail/header_wire.h"
#include "dicom/detail/reader_process.h"

namespace glisson::dicom {
namespace {

namespace fs = std::filesystem;

/// A name as discs and their copies write it: without case, version and closing dot.
std::string plainName(std::string name) {
  name = lowerCase(std::move(name));
  if (name.ends_with(";1")) name.resize(name.size() - 2);
  if (name.ends_with(".")) name.pop_back();
  return name;
}

/// Entries of the folders that a DICOMDIR speaks of, each folder read once.
class Folders {
 public:
  /// The entry of that name, or empty.
  fs::path find(const fs::path& folder, const std::string& name) {
    auto [known, fresh] = names_.try_emplace(folder);
    if (fresh) {
      std::error_code failed;
      for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed))
        known->second.emplace(plainName(it->path().filename().string()), it->path());
    }
    const auto found = known->second.find(plainName(name));
    return found == known->second.end() ? fs::path() : found->second;
  }

 private:
  std::map<fs::path, std::map<std::string, fs::path>> names_;
};

std::vector<std::vector<std::string>> readDirectorySafely(const fs::path& file) {
  try {
    ByteSource source(file);
    if (!isDeflated(source) && readLayout(source).plain) return readDirectory(source);
  } catch (const BadInput& e) {
    RefusedFile refused;
    refused.reason = e.what();
    throw refused;
  }
  return IsolatedFile(file).directory();
}

}  // namespace

std::vector<std::vector<std::string>> readDirectory(ByteSource& source) {
  const FileLayout layout = readLayout(source);
  DcmDataset data;
  parseHeader(source, layout, data);
  DcmSequenceOfItems* records = nullptr;
  if (data.findAndGetSequence(DCM_DirectoryRecordSequence, records).bad() || records == nullptr)
    throw BadInput("is no DICOMDIR: it has no directory records (0004,1220)");
  std::vector<std::vector<std::string>> files;
  DcmObject* one = nullptr;
  while ((one = records->nextInContainer(one)) != nullptr) {
    const std::string id = text(*static_cast<DcmItem*>(one), DCM_ReferencedFileID);
    if (id.empty()) continue;
    std::vector<std::string> parts;
    std::size_t begin = 0;
    while (begin <= id.size()) {
      const std::size_t end = std::min(id.find('\\', begin), id.size());
      std::string part = id.substr(begin, end - begin);
      while (!part.empty() && part.back() == ' ') part.pop_back();
      parts.push_back(std::move(part));
      begin = end + 1;
    }
    files.push_back(std::move(parts));
  }
  return files;
}

std::vector<fs::path> listedFiles(const fs::path& dicomdir, std::vector<SkippedFile>& skipped) {
  std::vector<fs::path> files;
  Folders folders;
  const fs::path root = dicomdir.has_parent_path() ? dicomdir.parent_path() : fs::path(".");
  for (const std::vector<std::string>& parts : readDirectorySafely(dicomdir)) {
    fs::path shown;
    fs::path here = root;
    std::string why;
    for (const std::string& part : parts) {
      shown /= detail::shownFrom(part);
      if (part.empty() || part == "." || part == ".." || part.find('/') != std::string::npos ||
          part.find('\0') != std::string::npos)
        why = "is listed in the DICOMDIR with a name that is no plain path";
      if (!why.empty()) continue;
      here = folders.find(here, part);
      std::error_code failed;
      if (here.empty())
        why = "is listed in the DICOMDIR and missing";
      else if (fs::is_symlink(fs::symlink_status(here, failed)))
        why = "is listed in the DICOMDIR and is a link";
    }
    std::error_code failed;
    if (why.empty() && !fs::is_regular_file(here, failed)) why = "is listed in the DICOMDIR and is no regular file";
    if (why.empty())
      files.push_back(here);
    else
      skipped.push_back({root / shown.relative_path(), why});
  }
  return files;
}

}  // namespace glisson::dicom
