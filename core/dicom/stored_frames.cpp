#include "dicom/stored_frames.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/dcmjpls/djdecode.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <span>

#include "base/error.h"
#include "dicom/detail/jpeg2000.h"

namespace glisson::dicom {
namespace {

void registerCodecs() {
  static std::once_flag once;
  std::call_once(once, [] {
    DcmRLEDecoderRegistration::registerCodecs();
    DJDecoderRegistration::registerCodecs();
    DJLSDecoderRegistration::registerCodecs();
  });
}

bool isRle(const std::string& syntax) {
  return syntax == UID_RLELosslessTransferSyntax;
}

bool isJpeg2000(const std::string& syntax) {
  return syntax == UID_JPEG2000LosslessOnlyTransferSyntax || syntax == UID_JPEG2000TransferSyntax;
}

/// The fragments of a frame: one each, or all of them where there is one frame.
std::span<const Fragment> fragmentsOf(const ImageHeader& header, int frame) {
  const std::vector<Fragment>& all = header.layout.pixels->fragments;
  const std::size_t pictures = header.isMosaic() ? 1 : header.frames.size();
  if (pictures == 1) return all;
  return std::span(all).subspan(static_cast<std::size_t>(frame), 1);
}

std::vector<std::uint8_t> bytesOf(std::span<const Fragment> fragments, const ByteSource& source, std::uint64_t most) {
  std::vector<std::uint8_t> out;
  for (const Fragment& f : fragments) {
    if (out.size() >= most) break;
    const auto piece = source.bytes(f.offset, std::min<std::uint64_t>(f.length, most - out.size()));
    out.insert(out.end(), piece.begin(), piece.end());
  }
  return out;
}

/// A run-length code stream has no size of its own: each segment [PS3.5 annex G] must unpack to one byte of every
/// pixel, or rows and columns are not what was compressed. One byte of padding is allowed.
void checkRunLengths(const std::vector<std::uint8_t>& b, std::uint64_t segments, std::uint64_t pixels,
                     const std::string& where) {
  const auto offset = [&b](std::uint64_t at) {
    const auto n = static_cast<std::size_t>(at);
    return static_cast<std::size_t>(b[n]) | static_cast<std::size_t>(b[n + 1]) << 8 |
           static_cast<std::size_t>(b[n + 2]) << 16 | static_cast<std::size_t>(b[n + 3]) << 24;
  };
  for (std::uint64_t s = 0; s < segments; ++s) {
    std::size_t at = offset(4 + 4 * s);
    const std::size_t end = s + 1 < segments ? offset(8 + 4 * s) : b.size();
    std::uint64_t unpacked = 0;
    while (at + 1 < end) {
      const int n = static_cast<std::int8_t>(b[at]);
      if (n == -128) {
        ++at;
        continue;
      }
      unpacked += static_cast<std::uint64_t>(n >= 0 ? n + 1 : 1 - n);
      at += n >= 0 ? static_cast<std::size_t>(n) + 2 : 2;
    }
    if (at > end || unpacked < pixels || unpacked > pixels + 1)
      throw BadInput("has a run-length segment of " + std::to_string(unpacked) + " pixels where its header says " +
                     std::to_string(pixels) + where);
  }
}

std::string sizeText(int width, int height, int components) {
  return std::to_string(width) + " x " + std::to_string(height) + " pixels of " + std::to_string(components) +
         " sample(s)";
}

}  // namespace

std::optional<std::string> undecodable(const std::string& transferSyntax) {
  static const std::map<std::string, std::string> codecs = {
      {UID_JPEG2000Part2MulticomponentImageCompressionLosslessOnlyTransferSyntax, "JPEG 2000 Part 2"},
      {UID_JPEG2000Part2MulticomponentImageCompressionTransferSyntax, "JPEG 2000 Part 2"},
      {"1.2.840.10008.1.2.4.201", "High-Throughput JPEG 2000"},
      {"1.2.840.10008.1.2.4.202", "High-Throughput JPEG 2000"},
      {"1.2.840.10008.1.2.4.203", "High-Throughput JPEG 2000"},
      {"1.2.840.10008.1.2.8.1", "deflated image frame"}};
  static const std::string jpeg = "1.2.840.10008.1.2.4.";
  const auto known = codecs.find(transferSyntax);
  if (known == codecs.end()) {
    static constexpr const char* decodable[] = {"50", "51", "53", "55", "57", "70", "80", "81", "90", "91"};
    const bool other =
        transferSyntax.starts_with(jpeg) && std::none_of(std::begin(decodable), std::end(decodable),
                                                         [&](const char* end) { return transferSyntax == jpeg + end; });
    if (!other) return {};
    return "its pixels are compressed with a codec that is not supported (transfer syntax " + transferSyntax +
           "); convert it to an uncompressed transfer syntax";
  }
  return "its pixels are compressed as " + known->second + ", which is not supported (transfer syntax " +
         transferSyntax + "); convert it to an uncompressed transfer syntax";
}

bool isLossy(const std::string& transferSyntax) {
  return transferSyntax == UID_JPEGProcess1TransferSyntax || transferSyntax == UID_JPEGProcess2_4TransferSyntax ||
         transferSyntax == UID_JPEGProcess6_8TransferSyntax || transferSyntax == UID_JPEGProcess10_12TransferSyntax ||
         transferSyntax == UID_JPEGLSLossyTransferSyntax;
}

bool hasLossyWavelet(const ImageHeader& header, const ByteSource& source) {
  if (header.layout.transferSyntax != UID_JPEG2000TransferSyntax || header.layout.pixels->fragments.empty())
    return false;
  return !detail::jpeg2000Size(bytesOf(fragmentsOf(header, 0), source, 4096)).reversible;
}

struct StoredFrames::Decoder {
  DcmFileFormat file;
  DcmPixelData* pixels = nullptr;
  Uint32 fragment = 0;
};

StoredFrames::StoredFrames(const ImageHeader& header, const ByteSource& source) : header_(header), source_(source) {
  if (const auto why = undecodable(header.layout.transferSyntax)) throw BadInput(*why);
  if (!header.layout.pixels->encapsulated) return;
  if (header.kind != PixelKind::Integer || header.bitsAllocated > 16)
    throw BadInput("has compressed pixels of " + std::to_string(header.bitsAllocated) +
                   " bits; 8 or 16 can be decoded");
  checkCodeStreams();
  if (isJpeg2000(header.layout.transferSyntax)) return;
  registerCodecs();
  decoder_ = std::make_unique<Decoder>();
  DcmElement* element = nullptr;
  if (decoder_->file.loadFile(header.file.c_str()).bad() ||
      decoder_->file.getDataset()->findAndGetElement(DCM_PixelData, element).bad() || element == nullptr)
    throw BadInput("has compressed pixels that cannot be parsed");
  decoder_->pixels = dynamic_cast<DcmPixelData*>(element);
  if (decoder_->pixels == nullptr) throw BadInput("has compressed pixels that cannot be parsed");
}

StoredFrames::~StoredFrames() = default;

void StoredFrames::checkCodeStreams() const {
  const auto& fragments = header_.layout.pixels->fragments;
  const std::size_t pictures = header_.isMosaic() ? 1 : header_.frames.size();
  if (isJpeg2000(header_.layout.transferSyntax) && pictures > 1 && fragments.size() != pictures)
    throw BadInput("has " + std::to_string(pictures) + " frames in " + std::to_string(fragments.size()) +
                   " compressed fragments; which belong together is not guessed");
  const std::size_t images = fragments.size() == pictures ? fragments.size() : 1;
  for (std::size_t n = 0; n < images; ++n) {
    const Fragment& f = fragments[n];
    const auto where = " (frame " + std::to_string(n + 1) + ")";
    const std::vector<std::uint8_t> b = source_.bytes(f.offset, std::min<std::uint64_t>(f.length, 1U << 16));
    const auto number16 = [&b](std::size_t at) { return (b[at] << 8) | b[at + 1]; };
    if (isRle(header_.layout.transferSyntax)) {
      const auto number32 = [&b](std::size_t at) {
        return static_cast<std::uint64_t>(b[at]) | static_cast<std::uint64_t>(b[at + 1]) << 8 |
               static_cast<std::uint64_t>(b[at + 2]) << 16 | static_cast<std::uint64_t>(b[at + 3]) << 24;
      };
      if (b.size() < 64) throw BadInput("has a run-length code stream without its header" + where);
      const std::uint64_t segments = number32(0);
      const auto expected = static_cast<std::uint64_t>(header_.samples * header_.bitsAllocated / 8);
      if (segments != expected)
        throw BadInput("has a run-length code stream of " + std::to_string(segments) + " segments where " +
                       std::to_string(expected) + " were expected" + where);
      std::uint64_t last = 64;
      for (std::size_t s = 0; s < expected; ++s) {
        const std::uint64_t begin = number32(4 + 4 * s);
        if (begin < last || begin > f.length) throw BadInput("has run-length segments outside of their frame" + where);
        last = begin;
      }
      if (fragments.size() == pictures)
        checkRunLengths(source_.bytes(f.offset, f.length), expected,
                        static_cast<std::uint64_t>(header_.rows) * static_cast<std::uint64_t>(header_.columns), where);
      continue;
    }
    if (isJpeg2000(header_.layout.transferSyntax)) {
      const detail::Jpeg2000Size size =
          detail::jpeg2000Size(bytesOf(fragmentsOf(header_, static_cast<int>(n)), source_, 4096));
      if (size.width != header_.columns || size.height != header_.rows || size.components != header_.samples)
        throw BadInput("has a JPEG 2000 code stream of " + std::to_string(size.width) + " x " +
                       std::to_string(size.height) + " pixels of " + std::to_string(size.components) +
                       " sample(s), but its header says " + sizeText(header_.columns, header_.rows, header_.samples) +
                       where);
      if (size.bits > header_.bitsAllocated)
        throw BadInput("has a JPEG 2000 code stream of " + std::to_string(size.bits) + " bits, but its header says " +
                       std::to_string(header_.bitsAllocated) + where);
      if (size.isSigned != header_.isSigned)
        throw BadInput(std::string("has a JPEG 2000 code stream of ") + (size.isSigned ? "signed" : "unsigned") +
                       " numbers, but its header says " + (header_.isSigned ? "signed" : "unsigned") + " (0028,0103)" +
                       where);
      continue;
    }
    if (b.size() < 4 || b[0] != 0xFF || b[1] != 0xD8)
      throw BadInput("has compressed pixels that do not begin as a JPEG code stream" + where);
    std::size_t at = 2;
    bool found = false;
    while (!found && at + 10 <= b.size() && b[at] == 0xFF) {
      const int marker = b[at + 1];
      const bool frameHeader =
          (marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC) || marker == 0xF7;
      if (frameHeader) {
        const int height = number16(at + 5);
        const int width = number16(at + 7);
        const int components = b[at + 9];
        if (height != header_.rows || width != header_.columns || components != header_.samples)
          throw BadInput("has a code stream of " + sizeText(width, height, components) + ", but its header says " +
                         sizeText(header_.columns, header_.rows, header_.samples) + where);
        if (b[at + 4] > header_.bitsAllocated)
          throw BadInput("has a code stream of " + std::to_string(b[at + 4]) + " bits, but its header says " +
                         std::to_string(header_.bitsAllocated) + where);
        found = true;
      }
      at += marker == 0xFF ? 1 : 2 + static_cast<std::size_t>(number16(at + 2));
    }
    if (!found) throw BadInput("has a code stream without an image size" + where);
  }
}

std::vector<std::uint8_t> StoredFrames::readNative(int frame) const {
  const std::uint64_t frameBytes = header_.frameBytes();
  const PixelElement& pixels = *header_.layout.pixels;
  auto bytes = source_.bytes(pixels.offset + static_cast<std::uint64_t>(frame) * frameBytes, frameBytes);
  if (!header_.layout.bigEndian) return bytes;
  const auto width = header_.bitsAllocated == 8 ? (pixels.words ? 2 : 1) : header_.bitsAllocated / 8;
  if (frameBytes % static_cast<std::uint64_t>(width) != 0)
    throw BadInput("has an odd number of 8-bit pixels in big-endian words, whose order is not defined");
  for (auto it = bytes.begin(); it != bytes.end(); it += width) std::reverse(it, it + width);
  return bytes;
}

std::vector<std::uint8_t> StoredFrames::read(int frame) {
  if (!header_.layout.pixels->encapsulated) return readNative(frame);
  if (!decoder_) {
    const auto stream = bytesOf(fragmentsOf(header_, frame), source_, source_.size());
    return detail::decodeJpeg2000(stream, header_.rows, header_.columns, header_.bitsAllocated / 8);
  }
  const std::uint64_t frameBytes = header_.frameBytes();
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(frameBytes + frameBytes % 2));
  OFString colourModel;
  const OFCondition status = decoder_->pixels->getUncompressedFrame(
      decoder_->file.getDataset(), static_cast<Uint32>(frame), decoder_->fragment, bytes.data(),
      static_cast<Uint32>(bytes.size()), colourModel);
  if (status.bad())
    throw BadInput("has compressed pixels that cannot be decoded (frame " + std::to_string(frame + 1) + ": " +
                   status.text() + ")");
  bytes.resize(static_cast<std::size_t>(frameBytes));
  return bytes;
}

}  // namespace glisson::dicom
