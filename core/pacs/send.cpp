// SPDX-License-Identifier: GPL-3.0-or-later
#include "pacs/send.h"

#include <dcmtk/config/osconfig.h>
// DCMTK's headers need its configuration first.
#include <dcmtk/dcmdata/dcostrma.h>
#include <dcmtk/dcmdata/dctk.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <set>

#include "dicom/file_layout.h"
#include "pacs/detail/association.h"
#include "pacs/detail/syntaxes.h"
#include "pacs/detail/trouble.h"

namespace glisson::pacs {

using namespace detail;

namespace {

/// Largest file that is sent; also bounds what a file that must be written anew takes in memory.
constexpr std::uint64_t largestFile = std::uint64_t{2} << 30;
/// Contexts that one association can propose.
constexpr std::size_t contextsPerAssociation = 120;

struct Outgoing {
  std::filesystem::path file;
  std::string sopClass, sopInstance, transferSyntax;
  std::uint64_t begin = 0, end = 0;  ///< of the data set in the file
  bool plain = false;
};

std::vector<std::filesystem::path> filesOf(const std::vector<std::filesystem::path>& paths) {
  namespace fs = std::filesystem;
  std::vector<fs::path> all;
  for (const fs::path& p : paths) {
    std::error_code failed;
    if (!fs::exists(p, failed)) throw BadInput("'" + p.filename().string() + "' does not exist");
    if (!fs::is_directory(p, failed)) {
      all.push_back(p);
      continue;
    }
    std::vector<fs::path> below;
    for (const auto& entry : fs::recursive_directory_iterator(p, fs::directory_options::skip_permission_denied))
      if (entry.is_regular_file(failed) && !entry.is_symlink(failed)) below.push_back(entry.path());
    std::sort(below.begin(), below.end());
    all.insert(all.end(), below.begin(), below.end());
  }
  if (all.empty()) throw BadInput("there is no file to send");
  return all;
}

std::uint32_t take(const std::vector<std::uint8_t>& from, std::size_t at, int bytes) {
  std::uint32_t value = 0;
  for (int n = 0; n < bytes; ++n)
    value |= static_cast<std::uint32_t>(from[at + static_cast<std::size_t>(n)]) << (8 * n);
  return value;
}

/// Text elements of the file meta information, which is explicit little endian always.
std::map<std::uint16_t, std::string> metaOf(const std::vector<std::uint8_t>& bytes) {
  std::map<std::uint16_t, std::string> all;
  for (std::size_t at = 0; at + 8 <= bytes.size() && take(bytes, at, 2) == 0x0002;) {
    const auto element = static_cast<std::uint16_t>(take(bytes, at + 2, 2));
    const std::string vr(bytes.begin() + static_cast<std::ptrdiff_t>(at) + 4,
                         bytes.begin() + static_cast<std::ptrdiff_t>(at) + 6);
    const bool isLong = vr == "OB" || vr == "UN" || vr == "OW";
    if (isLong && at + 12 > bytes.size()) break;
    const std::size_t length = isLong ? take(bytes, at + 8, 4) : take(bytes, at + 6, 2);
    at += isLong ? 12 : 8;
    if (length > bytes.size() - at) break;
    std::string value(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                      bytes.begin() + static_cast<std::ptrdiff_t>(at + length));
    while (!value.empty() && (value.back() == '\0' || value.back() == ' ')) value.pop_back();
    all[element] = value;
    at += length;
  }
  return all;
}

/// Throws BadInput with the reason.
Outgoing read(const std::filesystem::path& file) {
  dicom::ByteSource source(file);
  Outgoing o;
  o.file = file;
  o.end = source.size();
  if (o.end > largestFile) throw BadInput("is larger than 2 GiB");
  const dicom::FileLayout layout = dicom::readLayout(source);
  o.begin = layout.datasetOffset;
  o.transferSyntax = layout.transferSyntax;
  o.plain = layout.plain;
  if (o.begin < 132 + 8 || o.begin > 65536) throw BadInput("has no file meta information");
  const auto meta = metaOf(source.bytes(132, o.begin - 132));
  const auto textOf = [&](std::uint16_t element) {
    const auto found = meta.find(element);
    return found == meta.end() ? std::string() : found->second;
  };
  o.sopClass = textOf(0x0002);
  o.sopInstance = textOf(0x0003);
  if (!isUid(o.sopClass) || !isUid(o.sopInstance))
    throw BadInput("names no SOP class and instance in its meta information");
  if (!isUid(o.transferSyntax)) throw BadInput("names no transfer syntax");
  if ((o.end - o.begin) % 2 != 0) throw BadInput("has an odd number of bytes");
  return o;
}

/// Collects what DCMTK writes.
class Collector : public DcmConsumer {
 public:
  OFBool good() const override { return OFTrue; }
  OFCondition status() const override { return EC_Normal; }
  OFBool isFlushed() const override { return OFTrue; }
  offile_off_t avail() const override { return offile_off_t{1} << 30; }
  offile_off_t write(const void* from, offile_off_t count) override {
    bytes.append(static_cast<const char*>(from), static_cast<std::size_t>(count));
    return count;
  }
  void flush() override {}
  std::string bytes;
};

class CollectingStream : public DcmOutputStream {
 public:
  explicit CollectingStream(Collector& to) : DcmOutputStream(&to) {}
};

/// The data set of a file whose layout is plain, in implicit little endian.
std::string rewritten(const Outgoing& o) {
  DcmFileFormat format;
  Collector collector;
  CollectingStream stream(collector);
  if (format.loadFile(o.file.c_str()).bad()) throw BadInput("cannot be read");
  format.loadAllDataIntoMemory();
  DcmDataset& dataset = *format.getDataset();
  dataset.transferInit();
  const OFCondition written = dataset.write(stream, EXS_LittleEndianImplicit, EET_ExplicitLength, nullptr);
  dataset.transferEnd();
  if (written.bad()) throw BadInput("cannot be written in implicit little endian, the only form that the server takes");
  return std::move(collector.bytes);
}

/// Sends one object; the reason where it was refused.
std::optional<std::string> sendOne(Association& association, const Node& node, const Outgoing& o) {
  Channel& channel = association.channel();
  Agreed agreed = association.find(o.sopClass, o.transferSyntax);
  std::optional<std::string> anew;
  if (agreed.context == 0) {
    agreed = association.find(o.sopClass, implicitLittle);
    if (agreed.context == 0 || !o.plain)
      return association.find(o.sopClass).context == 0 ? "the server does not take this kind of object"
                                                       : "the server does not take its transfer syntax";
    anew = rewritten(o);
  }
  std::ifstream in(o.file, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(o.begin));
  if (!in) throw BadInput("cannot be read");
  Command request = Command::of(StoreRequest, channel.nextMessageId(), o.sopClass);
  request.uid(AffectedInstance, o.sopInstance).word(Priority, 0).word(DataSetType, 1);
  channel.send(agreed.context, request);
  if (anew) {
    channel.sendData(agreed.context, *anew);
  } else {
    std::uint64_t left = o.end - o.begin;
    channel.sendData(agreed.context, [&](char* to, std::size_t count) {
      const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(count, left));
      // A file that shrinks meanwhile must not arrive as a shorter object: the association is given up.
      if (!in.read(to, static_cast<std::streamsize>(n))) throw NetworkError("a file changed while it was sent");
      left -= n;
      return n;
    });
  }
  const Channel::Message answer = channel.receiveAnswer();
  if (answer.command.wordOr(Field, 0) != StoreResponse)
    throw NetworkError("the server at " + placeOf(node) + " answered C-STORE with another command");
  const std::uint16_t status = answer.command.wordOr(Status, 0x0110);
  if (isStored(status)) return std::nullopt;
  return "the server refused it: " + meaningOf(status, node.callingTitle);
}

}  // namespace

Sent send(const Node& node, const std::vector<std::filesystem::path>& paths, const Progress& progress) {
  check(node);
  const std::vector<std::filesystem::path> files = filesOf(paths);
  Sent sent;
  std::vector<Outgoing> outgoing;
  for (std::size_t n = 0; n < files.size(); ++n) {
    progress.report(0.1 * static_cast<double>(n) / static_cast<double>(files.size()), "reading files");
    try {
      outgoing.push_back(read(files[n]));
    } catch (const BadInput& e) {
      sent.failed.push_back({files[n], e.what()});
    }
  }
  for (std::size_t at = 0; at < outgoing.size();) {
    // As many files as one association has contexts for.
    std::set<std::pair<std::string, std::string>> kinds;
    std::size_t end = at;
    for (; end < outgoing.size(); ++end) {
      auto more = kinds;
      more.emplace(outgoing[end].sopClass, outgoing[end].transferSyntax);
      if (outgoing[end].plain) more.emplace(outgoing[end].sopClass, implicitLittle);
      if (more.size() > contextsPerAssociation) break;
      kinds = std::move(more);
    }
    std::vector<Proposal> proposals;
    for (const auto& [sopClass, syntax] : kinds) proposals.push_back({sopClass, {syntax}});
    Association association(node, proposals, progress);
    for (; at < end; ++at) {
      progress.report(0.1 + 0.9 * static_cast<double>(at) / static_cast<double>(outgoing.size()),
                      std::to_string(sent.objects) + " objects sent");
      const Outgoing& o = outgoing[at];
      try {
        if (const auto reason = sendOne(association, node, o)) {
          sent.failed.push_back({o.file, *reason});
        } else {
          ++sent.objects;
          sent.bytes += o.end - o.begin;
        }
      } catch (const BadInput& e) {
        sent.failed.push_back({o.file, e.what()});
      } catch (const NetworkError& e) {
        throw NetworkError(std::string(e.what()) + " (" + std::to_string(sent.objects) + " of " +
                           std::to_string(files.size()) + " files had been stored)");
      }
    }
    association.release();
  }
  const auto place = [&](const NotSent& f) { return std::find(files.begin(), files.end(), f.file) - files.begin(); };
  std::stable_sort(sent.failed.begin(), sent.failed.end(),
                   [&](const NotSent& a, const NotSent& b) { return place(a) < place(b); });
  progress.report(1.0, std::to_string(sent.objects) + " objects sent");
  return sent;
}

}  // namespace glisson::pacs
