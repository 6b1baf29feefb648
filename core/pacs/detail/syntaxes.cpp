// SPDX-License-Identifier: GPL-3.0-or-later
#include "pacs/detail/syntaxes.h"

#include <algorithm>

namespace glisson::pacs::detail {
namespace {

bool has(const std::vector<std::string>& list, const std::string& uid) {
  return std::find(list.begin(), list.end(), uid) != list.end();
}

}  // namespace

const std::vector<std::string>& plainSyntaxes() {
  static const std::vector<std::string> list{explicitLittle, implicitLittle};
  return list;
}

const std::vector<std::string>& packedSyntaxes() {
  static const std::vector<std::string> list{
      "1.2.840.10008.1.2.4.70",  // JPEG lossless, first-order prediction
      "1.2.840.10008.1.2.4.57",  // JPEG lossless
      "1.2.840.10008.1.2.4.80",  // JPEG-LS lossless
      "1.2.840.10008.1.2.4.90",  // JPEG 2000 lossless
      "1.2.840.10008.1.2.5",     // run-length
      "1.2.840.10008.1.2.1.99",  // deflated
      "1.2.840.10008.1.2.2",     // big endian
      "1.2.840.10008.1.2.4.50",  // JPEG baseline, with loss
      "1.2.840.10008.1.2.4.91",  // JPEG 2000, perhaps with loss
  };
  return list;
}

bool isPlainSyntax(const std::string& uid) {
  return has(plainSyntaxes(), uid);
}

const std::vector<std::string>& imageClasses() {
  static const std::vector<std::string> list{
      "1.2.840.10008.5.1.4.1.1.4",    // MR
      "1.2.840.10008.5.1.4.1.1.4.1",  // Enhanced MR
      "1.2.840.10008.5.1.4.1.1.2",    // CT
      "1.2.840.10008.5.1.4.1.1.2.1",  // Enhanced CT
      "1.2.840.10008.5.1.4.1.1.7",    // Secondary Capture
  };
  return list;
}

const std::vector<std::string>& derivedClasses() {
  static const std::vector<std::string> list{
      "1.2.840.10008.5.1.4.1.1.4.3",    // Enhanced MR colour
      "1.2.840.10008.5.1.4.1.1.7.2",    // multi-frame grey byte Secondary Capture
      "1.2.840.10008.5.1.4.1.1.7.3",    // multi-frame grey word Secondary Capture
      "1.2.840.10008.5.1.4.1.1.7.4",    // multi-frame true colour Secondary Capture
      "1.2.840.10008.5.1.4.1.1.4.4",    // Legacy Converted Enhanced MR
      "1.2.840.10008.5.1.4.1.1.2.2",    // Legacy Converted Enhanced CT
      "1.2.840.10008.5.1.4.1.1.66.4",   // Segmentation
      "1.2.840.10008.5.1.4.1.1.66.5",   // Surface Segmentation
      "1.2.840.10008.5.1.4.1.1.66.1",   // Spatial Registration
      "1.2.840.10008.5.1.4.1.1.30",     // Parametric Map
      "1.2.840.10008.5.1.4.1.1.481.3",  // RT Structure Set
      "1.2.840.10008.5.1.4.1.1.88.11",  // Basic Text SR
      "1.2.840.10008.5.1.4.1.1.88.22",  // Enhanced SR
      "1.2.840.10008.5.1.4.1.1.88.33",  // Comprehensive SR
      "1.2.840.10008.5.1.4.1.1.88.34",  // Comprehensive 3D SR
      "1.2.840.10008.5.1.4.1.1.11.1",   // Grayscale Presentation State
      "1.2.840.10008.5.1.4.1.1.6.1",    // Ultrasound
      "1.2.840.10008.5.1.4.1.1.3.1",    // Ultrasound, multi-frame
      "1.2.840.10008.5.1.4.1.1.128",    // PET
  };
  return list;
}

bool isReceivedClass(const std::string& uid) {
  return has(imageClasses(), uid) || has(derivedClasses(), uid);
}

std::vector<Proposal> proposalsToReceive() {
  // One context in each transfer syntax: the server may then send every object in the one in which it keeps it.
  std::vector<Proposal> all;
  for (const std::string& c : imageClasses()) {
    all.push_back({c, plainSyntaxes(), true});
    for (const std::string& s : packedSyntaxes()) all.push_back({c, {s}, true});
  }
  for (const std::string& c : derivedClasses()) {
    all.push_back({c, plainSyntaxes(), true});
    all.push_back({c, {"1.2.840.10008.1.2.5"}, true});
    all.push_back({c, {"1.2.840.10008.1.2.1.99"}, true});
  }
  return all;
}

}  // namespace glisson::pacs::detail
