// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace glisson::test {

/// Builds DICOM files byte by byte, so that a test can write what no library would.
class DicomBytes {
 public:
  static std::string little(std::uint64_t value, int bytes) {
    std::string out;
    for (int n = 0; n < bytes; ++n) out += static_cast<char>((value >> (8 * n)) & 0xFF);
    return out;
  }
  static std::string tag(std::uint32_t t) { return little(t >> 16, 2) + little(t & 0xFFFF, 2); }

  /// Explicit VR little endian; value padded to even length. announced replaces the true length where it is not
  /// negative.
  static std::string element(std::uint32_t t, const std::string& vr, std::string value, std::int64_t announced = -1) {
    if (value.size() % 2 != 0) value += vr == "UI" || vr == "OB" ? '\0' : ' ';
    const auto length = announced >= 0 ? static_cast<std::uint64_t>(announced) : value.size();
    const bool longForm =
        vr == "OB" || vr == "OW" || vr == "OF" || vr == "OD" || vr == "SQ" || vr == "UN" || vr == "UT";
    return tag(t) + vr + (longForm ? little(0, 2) + little(length, 4) : little(length, 2)) + value;
  }
  static std::string us(std::uint32_t t, unsigned value) { return element(t, "US", little(value, 2)); }

  static std::string meta(const std::string& transferSyntax) {
    return std::string(128, '\0') + "DICM" + element(0x00020010, "UI", transferSyntax);
  }

  static constexpr const char* explicitLittle = "1.2.840.10008.1.2.1";

  // An MR image of 4 × 3 pixels, one attribute after the other, each of which a test may change.
  std::string syntax = explicitLittle;
  std::string seriesUid = "1.2.3.4";
  std::string sopUid = "1.2.3.4.1";
  std::string position = "0\\0\\0";
  std::string orientation = "1\\0\\0\\0\\1\\0";
  std::string spacing = "2\\3";
  std::string photometric = "MONOCHROME2";
  std::string first0008;    ///< elements of group 0008 before the SOP class
  std::string extra0008;    ///< elements of group 0008 after the modality
  std::string extra0018;    ///< elements of group 0018
  std::string extraNumber;  ///< element (0020,0013)
  std::string extra0020;    ///< elements of group 0020 after the orientation
  std::string extraBeforePixels;
  std::string rescale;  ///< elements (0028,1052) and on
  unsigned rows = 3, columns = 4, samples = 1, allocated = 16, stored = 16, highBit = 15, representation = 0;
  std::string frames;  ///< NumberOfFrames, absent where empty
  std::string pixels = std::string(24, '\1');
  std::int64_t pixelLength = -1;  ///< announced, where it lies
  std::string pixelVr = "OW";
  std::uint32_t pixelTag = 0x7FE00010;

  std::string dataset() const {
    std::string d = first0008 + element(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.4") +
                    element(0x00080018, "UI", sopUid) + element(0x00080060, "CS", "MR") + extra0008 +
                    element(0x00100010, "PN", "PHI^CANARY") + element(0x00100020, "LO", "PHI^CANARY") + extra0018 +
                    element(0x0020000D, "UI", "1.2.3") + element(0x0020000E, "UI", seriesUid) +
                    element(0x00200011, "IS", "5") + extraNumber;
    if (!position.empty()) d += element(0x00200032, "DS", position);
    d += element(0x00200037, "DS", orientation) + element(0x00200052, "UI", "1.2.3.9") + extra0020 +
         us(0x00280002, samples) + element(0x00280004, "CS", photometric);
    if (!frames.empty()) d += element(0x00280008, "IS", frames);
    d += us(0x00280010, rows) + us(0x00280011, columns) + element(0x00280030, "DS", spacing) +
         us(0x00280100, allocated) + us(0x00280101, stored) + us(0x00280102, highBit) + us(0x00280103, representation) +
         rescale + extraBeforePixels;
    return d + element(pixelTag, pixelVr, pixels, pixelLength);
  }
  std::string bytes() const { return meta(syntax) + dataset(); }

  std::filesystem::path write(const std::filesystem::path& file) const { return write(file, bytes()); }
  static std::filesystem::path write(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }
};

}  // namespace glisson::test
