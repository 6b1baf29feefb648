// SPDX-License-Identifier: GPL-3.0-or-later
#include "pacs/detail/association.h"

#include <dcmtk/config/osconfig.h>
// Parts of DCMTK's network layer need its configuration first.
#include <dcmtk/dcmnet/assoc.h>
#include <dcmtk/dcmnet/dcmtrans.h>
#include <dcmtk/dcmnet/dul.h>
#include <dcmtk/oflog/oflog.h>
#include <netdb.h>
#include <sys/socket.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <mutex>

#include "pacs/detail/trouble.h"

namespace glisson::pacs::detail {
namespace {

constexpr long largestPdu = 65536;

/// DCMTK looks names up without a message of its own.
std::string addressOf(const Node& node) {
  addrinfo wanted{};
  wanted.ai_family = AF_INET;
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(node.host.c_str(), nullptr, &wanted, &found) != 0 || found == nullptr)
    throw NetworkError("the host '" + node.host.substr(0, 64) +
                       "' is not known to this computer's network; check --host");
  char text[INET_ADDRSTRLEN] = {};
  inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(found->ai_addr)->sin_addr, text, sizeof(text));
  freeaddrinfo(found);
  return text;
}

}  // namespace

void quietNetwork(int timeout_s) {
  static std::once_flag once;
  std::call_once(once, [] { OFLog::configure(OFLogger::OFF_LOG_LEVEL); });
  dcmDisableGethostbyaddr.set(OFTrue);
  dcmConnectionTimeout.set(timeout_s);
  dcmSocketSendTimeout.set(timeout_s);
  dcmSocketReceiveTimeout.set(timeout_s);
}

Agreed agreedContext(T_ASC_Association& association, int context) {
  T_ASC_PresentationContext found{};
  if (context < 1 || context > 255 ||
      ASC_findAcceptedPresentationContext(association.params, static_cast<T_ASC_PresentationContextID>(context), &found)
          .bad())
    return {};
  return {context, found.abstractSyntax, found.acceptedTransferSyntax};
}

Association::Association(const Node& node, const std::vector<Proposal>& proposals, const Progress& progress, int life_s)
    : place_(placeOf(node)) {
  check(node);
  progress.check();
  quietNetwork(node.timeout_s);
  const std::string address = addressOf(node) + ":" + std::to_string(node.port);
  T_ASC_Parameters* parameters = nullptr;
  try {
    if (ASC_initializeNetwork(NET_REQUESTOR, 0, node.timeout_s, &network_).bad() ||
        ASC_createAssociationParameters(&parameters, largestPdu).bad())
      throw NetworkError("the network of this computer cannot be used");
    ASC_setAPTitles(parameters, node.callingTitle.c_str(), node.calledTitle.c_str(), nullptr);
    ASC_setTransportLayerType(parameters, OFFalse);
    ASC_setPresentationAddresses(parameters, "localhost", address.c_str());
    int number = 1;
    for (const Proposal& p : proposals) {
      std::vector<const char*> syntaxes;
      for (const std::string& s : p.transferSyntaxes) syntaxes.push_back(s.c_str());
      if (number > 255) break;
      ASC_addPresentationContext(parameters, static_cast<T_ASC_PresentationContextID>(number), p.sopClass.c_str(),
                                 syntaxes.data(), static_cast<int>(syntaxes.size()),
                                 p.sentToUs ? ASC_SC_ROLE_SCP : ASC_SC_ROLE_DEFAULT);
      number += 2;
    }
    const OFCondition asked =
        ASC_requestAssociation(network_, parameters, &association_, nullptr, nullptr, DUL_NOBLOCK, node.timeout_s);
    if (association_ != nullptr) parameters = nullptr;  // the association owns it now
    if (asked.bad())
      throw NetworkError(whyNoAssociation(node, asked, association_ != nullptr ? association_->params : parameters));
    channel_ = std::make_unique<Channel>(*association_, node.timeout_s, life_s, progress);
  } catch (...) {
    if (parameters != nullptr) ASC_destroyAssociationParameters(&parameters);
    drop();
    throw;
  }
}

void Association::drop() {
  if (association_ != nullptr) ASC_destroyAssociation(&association_);
  if (network_ != nullptr) ASC_dropNetwork(&network_);
  association_ = nullptr;
  network_ = nullptr;
}

Association::~Association() {
  if (association_ != nullptr) ASC_abortAssociation(association_);
  drop();
}

void Association::release() {
  if (association_ != nullptr) ASC_releaseAssociation(association_);
  drop();
}

Agreed Association::find(const std::string& sopClass, const std::string& transferSyntax) const {
  const int count = ASC_countPresentationContexts(association_->params);
  for (int n = 0; n < count; ++n) {
    T_ASC_PresentationContext c{};
    if (ASC_getPresentationContext(association_->params, n, &c).bad() || c.resultReason != ASC_P_ACCEPTANCE) continue;
    if (sopClass == c.abstractSyntax && (transferSyntax.empty() || transferSyntax == c.acceptedTransferSyntax))
      return {c.presentationContextID, c.abstractSyntax, c.acceptedTransferSyntax};
  }
  return {};
}

Agreed Association::need(const std::string& sopClass, const std::string& what) const {
  const Agreed a = find(sopClass);
  if (a.context == 0) throw NetworkError("the server at " + place_ + " does not offer " + what);
  return a;
}

}  // namespace glisson::pacs::detail
