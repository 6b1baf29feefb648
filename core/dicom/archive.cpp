// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/archive.h"

#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "dicom/detail/header_wire.h"
#include "dicom/detail/image_header.h"
#include "dicom/detail/reader_process.h"
#include "dicom/detail/reader_protocol.h"

namespace glisson::dicom {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t maxEntries = 200'000;

struct Input {
  const ByteSource* source = nullptr;
  std::uint64_t at = 0;
  std::array<char, 64 * 1024> piece{};
};

la_ssize_t readPiece(struct archive*, void* user, const void** bytes) {
  auto& in = *static_cast<Input*>(user);
  const std::size_t n = static_cast<std::size_t>(std::min<std::uint64_t>(in.piece.size(), in.source->size() - in.at));
  if (n > 0) in.source->read(in.at, in.piece.data(), n);
  in.at += n;
  *bytes = in.piece.data();
  return static_cast<la_ssize_t>(n);
}

la_int64_t seekInput(struct archive*, void* user, la_int64_t offset, int whence) {
  auto& in = *static_cast<Input*>(user);
  const auto size = static_cast<la_int64_t>(in.source->size());
  const la_int64_t base = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? static_cast<la_int64_t>(in.at) : size;
  const la_int64_t place = base + offset;
  if (place < 0 || place > size) return ARCHIVE_FATAL;
  in.at = static_cast<std::uint64_t>(place);
  return place;
}

bool isArchiveName(const fs::path& name) {
  const std::string e = extensionOf(name);
  return e == ".zip" || e == ".gz" || e == ".tgz" || e == ".7z" || e == ".rar" || e == ".tar" || e == ".bz2" ||
         e == ".xz";
}

/// The entry's place below the folder, or nothing where its name is no plain relative path.
std::optional<fs::path> placeOf(const std::string& name) {
  if (name.empty() || name.size() > 1024 || name.front() == '/' || name.find('\0') != std::string::npos) return {};
  fs::path place;
  int depth = 0;
  for (const fs::path& part : fs::path(name)) {
    const std::string text = part.string();
    if (text.empty() || text == ".") continue;
    if (text == ".." || text.size() > 200 || text.find('\\') != std::string::npos || ++depth > 32) return {};
    place /= part;
  }
  if (place.empty()) return {};
  return place;
}

/// Writes the wanted entries, never over a file that is there, never more than the budget.
class Unpacker {
 public:
  Unpacker(const fs::path& root, std::uint64_t budget, std::vector<SkippedFile>& skipped, fs::path archive)
      : root_(root), budget_(budget), skipped_(skipped), archive_(std::move(archive)) {}
  ~Unpacker() { finish(); }

  bool begin(const std::string& name) {
    finish();
    if (++entries_ > maxEntries) refuse("holds more than 200000 entries; it is refused");
    const auto place = placeOf(name);
    if (!place) {
      skip("an entry", "has a name that is no plain path inside the archive; it was not unpacked");
      return false;
    }
    if (isArchiveName(*place)) {
      skip(place->string(), "is an archive inside the archive; unpack it by hand");
      return false;
    }
    pending_ = *place;
    return true;
  }

  void data(const char* bytes, std::size_t count) {
    if (count > 0) make();
    written_ += count;
    if (written_ > budget_)
      refuse("unpacks to more than 256 MiB and 100 times its size, or than half of the free space; it is refused");
    while (count > 0 && descriptor_ >= 0) {
      const ssize_t n = write(descriptor_, bytes, count);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) refuse("cannot be unpacked: the temporary folder is full or read-only");
      bytes += n;
      count -= static_cast<std::size_t>(n);
    }
  }

  void refused(const std::string& name, const std::string& reason) {
    if (++entries_ > maxEntries) refuse("holds more than 200000 entries; it is refused");
    const auto place = placeOf(name);
    skip(place ? place->string() : "an entry", reason);
  }

  void finish() {
    if (descriptor_ >= 0) close(descriptor_);
    descriptor_ = -1;
    if (!pending_.empty()) ++empty_;
    pending_.clear();
  }

  /// After the last entry.
  void tellEmpty() {
    finish();
    if (empty_ > 0)
      skipped_.push_back({archive_, "holds " + std::to_string(empty_) + " empty files, which were left out"});
  }

 private:
  /// The file of the entry, once there is something to write: empty ones are none.
  void make() {
    if (pending_.empty()) return;
    const fs::path place = std::exchange(pending_, {});
    std::error_code failed;
    fs::create_directories((root_ / place).parent_path(), failed);
    descriptor_ =
        failed ? -1 : open((root_ / place).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (descriptor_ < 0)
      skip(place.string(), "occurs twice in the archive, or its name cannot be used; the first one counts");
  }

  [[noreturn]] static void refuse(const std::string& reason) {
    RefusedFile r;
    r.reason = reason;
    throw r;
  }
  void skip(const std::string& entry, const std::string& reason) {
    skipped_.push_back({archive_ / detail::shownFrom(entry), reason});
  }

  fs::path root_;
  std::uint64_t budget_;
  std::vector<SkippedFile>& skipped_;
  fs::path archive_;
  fs::path pending_;  ///< of the entry that begins; empty once its file is made
  std::size_t empty_ = 0;
  int descriptor_ = -1;
  std::uint64_t written_ = 0;
  std::size_t entries_ = 0;
};

}  // namespace

void readArchive(ByteSource& source, const ArchiveEntries& entries) {
  const std::unique_ptr<struct archive, int (*)(struct archive*)> reader(archive_read_new(), archive_read_free);
  archive_read_support_format_zip(reader.get());
  Input input;
  input.source = &source;
  archive_read_set_callback_data(reader.get(), &input);
  archive_read_set_read_callback(reader.get(), readPiece);
  archive_read_set_seek_callback(reader.get(), seekInput);
  if (archive_read_open1(reader.get()) != ARCHIVE_OK) throw BadInput("is a damaged ZIP archive");
  for (;;) {
    archive_entry* entry = nullptr;
    const int state = archive_read_next_header(reader.get(), &entry);
    if (state == ARCHIVE_EOF) return;
    if (state != ARCHIVE_OK && state != ARCHIVE_WARN) throw BadInput("is a damaged or truncated ZIP archive");
    const char* raw = archive_entry_pathname(entry);
    const std::string name = raw != nullptr ? std::string(raw).substr(0, 2000) : std::string();
    if (archive_entry_filetype(entry) == AE_IFDIR) continue;
    if (archive_entry_is_encrypted(entry) != 0) {
      entries.refused(name, "is encrypted in the archive; unpack it by hand with its password");
      continue;
    }
    if (archive_entry_filetype(entry) != AE_IFREG) {
      entries.refused(name, "is a link or special file in the archive; it was not unpacked");
      continue;
    }
    if (!entries.begin(name)) return;
    std::array<char, detail::dataPiece> piece;
    for (;;) {
      const la_ssize_t got = archive_read_data(reader.get(), piece.data(), piece.size());
      if (got == 0) break;
      if (got < 0) throw BadInput("is a damaged or truncated ZIP archive");
      if (!entries.data(piece.data(), static_cast<std::size_t>(got))) return;
    }
  }
}

bool looksLikeZip(const fs::path& file) {
  std::array<char, 4> b{};
  std::ifstream in(file, std::ios::binary);
  in.read(b.data(), b.size());
  return in && b[0] == 'P' && b[1] == 'K' && ((b[2] == 3 && b[3] == 4) || (b[2] == 5 && b[3] == 6));
}

std::unique_ptr<PrivateFolder> unpackArchive(const fs::path& file, std::vector<SkippedFile>& skipped) {
  auto folder = std::make_unique<PrivateFolder>();
  std::error_code failed;
  const std::uint64_t size = fs::file_size(file, failed);
  const fs::space_info space = fs::space(folder->path(), failed);
  const std::uint64_t budget =
      std::min<std::uint64_t>(256ULL * 1024 * 1024 + 100 * size, failed ? UINT64_MAX : space.available / 2);
  Unpacker unpacker(folder->path(), budget, skipped, file);
  IsolatedFile isolated(file);
  isolated.unpack({[&](const std::string& name) { return unpacker.begin(name); },
                   [&](const char* bytes, std::size_t count) { unpacker.data(bytes, count); },
                   [&](const std::string& name, const std::string& reason) { unpacker.refused(name, reason); }});
  unpacker.tellEmpty();
  return folder;
}

}  // namespace glisson::dicom
