// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pacs/detail/channel.h"
#include "pacs/node.h"

struct T_ASC_Association;
struct T_ASC_Network;

namespace glisson::pacs::detail {

/// DCMTK's settings of the whole process: no log (it would quote values of the patient), no name look-ups, its time
/// limits. Cheap to call again.
void quietNetwork(int timeout_s);

/// What is proposed: one class in one or several transfer syntaxes, best first.
struct Proposal {
  std::string sopClass;
  std::vector<std::string> transferSyntaxes;
  bool sentToUs = false;  ///< the other side will send objects of this class to us (C-GET)
};

/// One context that was agreed upon.
struct Agreed {
  int context = 0;  ///< 0: none
  std::string sopClass, transferSyntax;
};

/// The agreed context of that number, or none.
Agreed agreedContext(T_ASC_Association& association, int context);

/// An association that we asked for; aborted by the destructor unless released.
class Association {
 public:
  /// Throws BadInput (node), NetworkError with the reason, Cancelled.
  Association(const Node& node, const std::vector<Proposal>& proposals, const Progress& progress,
              int life_s = 4 * 3600);
  ~Association();
  Association(const Association&) = delete;
  Association& operator=(const Association&) = delete;

  /// The agreed context for a class, in this transfer syntax where one is given.
  Agreed find(const std::string& sopClass, const std::string& transferSyntax = {}) const;
  Agreed agreed(int context) const { return agreedContext(*association_, context); }
  /// As find(); throws NetworkError, saying that the server does not offer `what`.
  Agreed need(const std::string& sopClass, const std::string& what) const;
  Channel& channel() { return *channel_; }
  /// Ends in peace; never throws.
  void release();

 private:
  void drop();
  T_ASC_Network* network_ = nullptr;
  T_ASC_Association* association_ = nullptr;
  std::unique_ptr<Channel> channel_;
  std::string place_;
};

}  // namespace glisson::pacs::detail
