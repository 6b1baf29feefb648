// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/stored_frames.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/dcmjpls/djdecode.h>

#include <algorithm>
#include <map>
#include <mutex>

#include "base/error.h"
#include "dicom/detail/code_streams.h"
#include "dicom/detail/jpeg2000.h"

namespace glisson::dicom {
namespace {

using detail::bytesOf;
using detail::fragmentsOf;
using detail::isJpeg2000;

void registerCodecs() {
  static std::once_flag once;
  std::call_once(once, [] {
    DcmRLEDecoderRegistration::registerCodecs();
    DJDecoderRegistration::registerCodecs();
    DJLSDecoderRegistration::registerCodecs();
  });
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
  detail::checkCodeStreams(header, source);
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
