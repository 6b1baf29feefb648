// SPDX-License-Identifier: GPL-3.0-or-later
#include "pacs/detail/object_store.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/sha256.h"
#include "base/version.h"
#include "dicom/file_layout.h"
#include "pacs/detail/syntaxes.h"

namespace glisson::pacs::detail {
namespace {

void put(std::string& to, std::uint64_t value, int bytes) {
  for (int n = 0; n < bytes; ++n) to += static_cast<char>((value >> (8 * n)) & 0xff);
}

void putMeta(std::string& to, std::uint16_t element, const char* vr, std::string value, char pad = '\0') {
  if (value.size() % 2 != 0) value += pad;
  put(to, 0x0002, 2);
  put(to, element, 2);
  to += vr;
  if (std::string(vr) == "OB") {
    put(to, 0, 2);
    put(to, value.size(), 4);
  } else {
    put(to, value.size(), 2);
  }
  to += value;
}

/// A file that goes away again unless it is kept.
class Part {
 public:
  Part(const std::filesystem::path& folder, const std::string& name)
      : path_(folder / name),
        descriptor_(open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600)) {
    good_ = descriptor_ >= 0;
  }
  ~Part() {
    if (descriptor_ >= 0) close(descriptor_);
    if (descriptor_ >= 0 && !kept_) unlink(path_.c_str());
  }
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  void write(const char* from, std::size_t count) {
    while (good_ && count > 0) {
      const ssize_t n = ::write(descriptor_, from, count);
      if (n < 0 && errno == EINTR) continue;
      good_ = n > 0;
      if (!good_) return;
      from += n;
      count -= static_cast<std::size_t>(n);
    }
  }
  bool sync() { return good_ = good_ && fsync(descriptor_) == 0; }
  bool keepAs(const std::filesystem::path& final) {
    kept_ = good_ && rename(path_.c_str(), final.c_str()) == 0;
    if (!kept_) return false;
    const int folder = open(final.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder >= 0) {
      fsync(folder);
      close(folder);
    }
    return true;
  }
  bool good() const { return good_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int descriptor_;
  bool good_ = false, kept_ = false;
};

}  // namespace

std::string fileNameFor(const std::string& sopInstanceUid) {
  return sha256(sopInstanceUid.data(), sopInstanceUid.size()).substr(0, 32) + ".dcm";
}

std::string fileHead(const std::string& sopClass, const std::string& sopInstance, const std::string& transferSyntax) {
  std::string meta;
  putMeta(meta, 0x0001, "OB", std::string("\0\1", 2));
  putMeta(meta, 0x0002, "UI", sopClass);
  putMeta(meta, 0x0003, "UI", sopInstance);
  putMeta(meta, 0x0010, "UI", transferSyntax);
  // Of this software; from a UUID, as PS3.5 annex B.2 has it.
  putMeta(meta, 0x0012, "UI", "2.25.259142251335572318934122195773829990842");
  putMeta(meta, 0x0013, "SH", "GLISSON", ' ');
  std::string all(128, '\0');
  all += "DICM";
  std::string length;
  put(length, meta.size(), 4);
  putMeta(all, 0x0000, "UL", length);
  return all + meta;
}

ObjectStore::ObjectStore(std::filesystem::path folder, const Limits& limits)
    : folder_(std::move(folder)), limits_(limits) {
  if (folder_.empty()) throw BadInput("there is no folder to receive into: give --output");
  std::error_code failed;
  std::filesystem::create_directories(folder_, failed);
  if (failed || !std::filesystem::is_directory(folder_, failed))
    throw BadInput("the folder given by --output cannot be made or is no folder");
}

std::size_t ObjectStore::count() const {
  const std::lock_guard lock(mutex_);
  return result_.files.size() + result_.alreadyThere;
}

void ObjectStore::addAssociation(bool accepted) {
  const std::lock_guard lock(mutex_);
  ++(accepted ? result_.associations : result_.rejected);
}

Received ObjectStore::result() const {
  const std::lock_guard lock(mutex_);
  Received r = result_;
  for (const auto& [reason, count] : refused_) r.refused.push_back({reason, count});
  return r;
}

std::uint16_t ObjectStore::refuse(std::uint16_t status, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  ++refused_[reason];
  return status;
}

void ObjectStore::skipData(Channel& channel, const Channel::Message& request) const {
  std::uint64_t seen = 0;
  if (request.command.hasData())
    channel.receiveData(request.context, [&](const char*, std::size_t count) {
      seen += count;
      if (seen > limits_.objectBytes) throw NetworkError("an object is larger than is allowed");
    });
}

std::uint16_t ObjectStore::receive(Channel& channel, const Channel::Message& request, const Agreed& agreed) {
  const std::string instance = request.command.text(AffectedInstance), sopClass = request.command.text(AffectedClass);
  std::uint16_t status = 0;
  if (!request.command.hasData())
    status = refuse(0xc000, "without a data set");
  else if (!isUid(instance))
    status = refuse(0x0117, "its SOP Instance UID is no UID");
  else if (agreed.context == 0 || sopClass != agreed.sopClass || !isReceivedClass(sopClass))
    status = refuse(0x0122, "of a class that was not agreed upon");
  const std::filesystem::path final = folder_ / fileNameFor(instance);
  std::string name;
  bool there = false;
  if (status == 0) {
    std::error_code ignored;
    there = std::filesystem::symlink_status(final, ignored).type() != std::filesystem::file_type::not_found;
    const std::lock_guard lock(mutex_);
    if (there) ++result_.alreadyThere;
    if (!there &&
        (result_.files.size() + result_.alreadyThere >= limits_.objects || result_.bytes >= limits_.totalBytes)) {
      ++refused_["beyond the number or size of all objects that is allowed"];
      status = 0xa700;
    }
    name = "." + final.filename().string() + ".part-" + std::to_string(getpid()) + "-" + std::to_string(++serial_);
  }
  if (status != 0 || there) {
    skipData(channel, request);
    return status;
  }
  Part part(folder_, name);
  const std::string head = fileHead(sopClass, instance, agreed.transferSyntax);
  part.write(head.data(), head.size());
  std::uint64_t bytes = 0;
  channel.receiveData(request.context, [&](const char* from, std::size_t count) {
    bytes += count;
    if (bytes > limits_.objectBytes) {
      refuse(0xa700, "larger than is allowed");
      throw NetworkError("an object is larger than the " + std::to_string(limits_.objectBytes) + " bytes allowed");
    }
    part.write(from, count);
  });
  if (!part.sync()) return refuse(0xa700, "it could not be written (disk full, or the folder not writable)");
  try {
    dicom::ByteSource source(part.path());
    dicom::readLayout(source);
  } catch (const BadInput& e) {
    return refuse(0xc000, "it " + std::string(e.what()).substr(0, 200));
  }
  if (!part.keepAs(final)) return refuse(0xa700, "it could not be written (disk full, or the folder not writable)");
  const std::lock_guard lock(mutex_);
  result_.files.push_back(final);
  result_.bytes += bytes;
  return 0;
}

}  // namespace glisson::pacs::detail
