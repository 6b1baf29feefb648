// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnostics_json.h"

#include <algorithm>
#include <iterator>

#include "base/error.h"

namespace glisson::cli {
namespace {

/// Texts that no diagnostic says.
std::vector<std::string> others(const Diagnostics& diagnostics, const std::vector<std::string>& warnings) {
  const std::vector<std::string> said = diagnostics.texts();
  std::vector<std::string> out;
  std::copy_if(warnings.begin(), warnings.end(), std::back_inserter(out),
               [&](const std::string& text) { return std::find(said.begin(), said.end(), text) == said.end(); });
  return out;
}

}  // namespace

Json diagnosticsJson(const Diagnostics& diagnostics, const std::vector<std::string>& warnings) {
  Json all = Json::array();
  for (const Diagnostic& d : diagnostics) {
    Json arguments = Json::object();
    for (const auto& [name, value] : d.arguments)
      std::visit([&, &key = name](const auto& v) { arguments[key] = v; }, value);
    all.push_back({{"code", nameOf(d.code)},
                   {"severity", nameOf(d.severity())},
                   {"text", d.text()},
                   {"arguments", std::move(arguments)}});
  }
  for (const std::string& text : others(diagnostics, warnings))
    all.push_back(
        {{"code", "remark"}, {"severity", nameOf(Severity::Warning)}, {"text", text}, {"arguments", Json::object()}});
  return all;
}

void refuseIfStrict(const Context& context, const Diagnostics& diagnostics, const std::vector<std::string>& warnings) {
  if (!context.strict) return;
  std::vector<std::string> doubts = diagnostics.texts(Severity::Warning);
  const std::vector<std::string> more = others(diagnostics, warnings);
  doubts.insert(doubts.end(), more.begin(), more.end());
  if (doubts.empty()) return;
  throw BadInput("refused, because --strict allows no warning: " + doubts.front() +
                 (doubts.size() > 1 ? " (and " + std::to_string(doubts.size() - 1) + " more)" : std::string()));
}

}  // namespace glisson::cli
