// SPDX-License-Identifier: GPL-3.0-or-later
#include "pacs/detail/trouble.h"

#include <dcmtk/config/osconfig.h>
// Parts of DCMTK's network layer need its configuration first.
#include <dcmtk/dcmnet/assoc.h>
#include <dcmtk/dcmnet/cond.h>

#include <array>
#include <cstdio>

#include "base/text.h"

namespace glisson::pacs::detail {
namespace {

std::string rejection(const Node& node, T_ASC_Parameters* parameters) {
  T_ASC_RejectParameters r{};
  if (parameters == nullptr || ASC_getRejectParameters(parameters, &r).bad()) return "it gave no reason";
  switch (r.reason) {
    case ASC_REASON_SU_CALLINGAETITLENOTRECOGNIZED:
      return "it does not know our AE title '" + node.callingTitle +
             "' (calling AE title not recognised); have it entered there, or give --calling";
    case ASC_REASON_SU_CALLEDAETITLENOTRECOGNIZED:
      return "it is not called '" + node.calledTitle + "' (called AE title not recognised); give --called";
    case ASC_REASON_SP_PRES_TEMPORARYCONGESTION: return "it is busy (temporary congestion); try again later";
    case ASC_REASON_SP_PRES_LOCALLIMITEXCEEDED:
      return "it has too many associations (local limit exceeded); try again later";
    case ASC_REASON_SU_APPCONTEXTNAMENOTSUPPORTED:
    case ASC_REASON_SP_ACSE_PROTOCOLVERSIONNOTSUPPORTED: return "it does not speak this version of DICOM";
    default:
      return r.result == ASC_RESULT_REJECTEDTRANSIENT
                 ? "it gave no reason, but may accept later; try again"
                 : "it gave no reason; does it know our AE title '" + node.callingTitle + "'?";
  }
}

std::string sentenceFor(std::uint16_t status, const std::string& ourTitle) {
  switch (status) {
    case 0x0110: return "processing failure";
    case 0x0112: return "no such object";
    case 0x0117: return "invalid object instance";
    case 0x0122: return "this kind of object or service is not supported there";
    case 0x0124: return "not authorised";
    case 0x0210: return "duplicate invocation";
    case 0x0211: return "unrecognised operation";
    case 0x0212: return "mistyped argument";
    case 0xa701: return "out of resources: it cannot count the matches";
    case 0xa702: return "out of resources: it cannot send the objects (does it reach and know '" + ourTitle + "'?)";
    case 0xa801:
      return "it does not know the AE title '" + ourTitle +
             "' as a destination; have it entered there with this computer's address and the port of --receive-port, "
             "or leave out --move";
    case 0xb000: return "done, some objects failed";
    case 0xfe00: return "it was cancelled there";
    default: break;
  }
  if ((status & 0xff00) == 0xa700) return "out of resources";
  if ((status & 0xff00) == 0xa900) return "the data do not fit the service";
  if ((status & 0xf000) == 0xb000) return "stored with a warning";
  if ((status & 0xf000) == 0xc000) return "it was unable to process the request";
  return "it failed";
}

}  // namespace

std::string placeOf(const Node& node) {
  return node.host + ":" + std::to_string(node.port);
}

std::string whyNoAssociation(const Node& node, const OFCondition& condition, T_ASC_Parameters* parameters) {
  const std::string place = placeOf(node);
  if (condition == DUL_ASSOCIATIONREJECTED)
    return "association rejected by " + place + ": " + rejection(node, parameters);
  const std::string text = lowerCase(condition.text());
  if (text.find("refused") != std::string::npos)
    return "connection refused: no DICOM server listens at " + place + "; check --host and --port";
  if (condition == DUL_READTIMEOUT || text.find("timeout") != std::string::npos ||
      text.find("timed out") != std::string::npos || text.find("in progress") != std::string::npos)
    return "timeout: " + place + " did not answer within " + std::to_string(node.timeout_s) +
           " s; check --host and --port, or give a longer --timeout";
  if (text.find("unreachable") != std::string::npos || text.find("no route") != std::string::npos)
    return place + " cannot be reached from this computer's network";
  if (condition == DUL_PEERABORTEDASSOCIATION || text.find("closed") != std::string::npos)
    return place + " closed the connection before an association; is it a DICOM server, and does it expect encryption?";
  return "no association with " + place + "; is it a DICOM server?";
}

std::string meaningOf(std::uint16_t status, const std::string& ourTitle) {
  std::array<char, 16> number{};
  std::snprintf(number.data(), number.size(), "0x%04X", static_cast<unsigned>(status));
  return sentenceFor(status, ourTitle) + " (status " + number.data() + ")";
}

}  // namespace glisson::pacs::detail
