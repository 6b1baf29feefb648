// SPDX-License-Identifier: GPL-3.0-or-later
#include "pacs/node.h"

#include <algorithm>

namespace glisson::pacs {

void checkTitle(const std::string& title, const std::string& option) {
  const bool plain = std::all_of(title.begin(), title.end(), [](char c) { return c >= ' ' && c < 127 && c != '\\'; });
  const bool blank = title.find_first_not_of(' ') == std::string::npos;
  if (blank || title.size() > 16 || !plain)
    throw BadInput(option +
                   " is no AE title: 1 to 16 ASCII characters are needed, not only spaces, no backslash (it has " +
                   std::to_string(title.size()) + ")");
}

void check(const Node& node) {
  if (node.host.empty() || node.host.size() > 253)
    throw BadInput("--host is no host name; give a name or an IPv4 address");
  if (node.port < 1 || node.port > 65535)
    throw BadInput("--port is " + std::to_string(node.port) + "; it must be 1 to 65535");
  if (node.timeout_s < 1 || node.timeout_s > 3600)
    throw BadInput("--timeout is " + std::to_string(node.timeout_s) + " s; it must be 1 to 3600");
  checkTitle(node.calledTitle, "--called");
  checkTitle(node.callingTitle, "--calling");
}

bool isUid(const std::string& uid) {
  if (uid.empty() || uid.size() > 64 || uid.find_first_not_of("0123456789.") != std::string::npos) return false;
  return uid.front() != '.' && uid.back() != '.' && uid.find("..") == std::string::npos;
}

void checkUid(const std::string& uid, const std::string& option) {
  if (!isUid(uid))
    throw BadInput(option + " is no UID: digits and single dots, at most 64 characters (as `pacs find` lists them)");
}

}  // namespace glisson::pacs
