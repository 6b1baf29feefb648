// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/diagnostic.h"

#include <algorithm>
#include <sstream>

#include "base/diagnostic_text.h"
#include "base/error.h"

namespace glisson {
namespace {

struct Entry {
  std::string_view name;
  Severity severity;
  std::string_view text;
};

constexpr Entry entries[] = {
#define GLISSON_DIAGNOSTIC(code, name, severity, text) {name, Severity::severity, text},
#include "base/diagnostics.def"
#undef GLISSON_DIAGNOSTIC
};

const Entry& entryOf(DiagnosticCode code) {
  return entries[static_cast<std::size_t>(code)];
}

std::string inWords(const DiagnosticValue& value) {
  if (const auto* word = std::get_if<std::string>(&value)) return *word;
  std::ostringstream out;
  out.precision(4);
  if (const auto* number = std::get_if<double>(&value))
    out << *number;
  else
    out << std::get<std::int64_t>(value);
  return out.str();
}

}  // namespace

std::string_view nameOf(DiagnosticCode code) {
  return entryOf(code).name;
}

std::string_view nameOf(Severity severity) {
  switch (severity) {
    case Severity::Note: return "note";
    case Severity::Warning: return "warning";
    default: return "error";
  }
}

Severity Diagnostic::severity() const {
  return entryOf(code).severity;
}

std::string Diagnostic::text() const {
  return filledIn(templateOf(code), *this);
}

std::string_view templateOf(DiagnosticCode code) {
  return entryOf(code).text;
}

std::string filledIn(std::string_view text, const Diagnostic& diagnostic) {
  const auto& arguments = diagnostic.arguments;
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t open = text.find('{', at);
    out += text.substr(at, open - at);
    if (open == std::string_view::npos) break;
    const std::size_t close = text.find('}', open);
    const std::string_view key = text.substr(open + 1, close - open - 1);
    const auto found = std::find_if(arguments.begin(), arguments.end(), [&](const auto& a) { return a.first == key; });
    if (found == arguments.end())
      throw BadArgument("diagnostic " + std::string(nameOf(diagnostic.code)) + " lacks its argument " +
                        std::string(key));
    out += inWords(found->second);
    at = close + 1;
  }
  return out;
}

void Diagnostics::add(DiagnosticCode code, std::vector<std::pair<std::string, DiagnosticValue>> arguments) {
  all_.push_back({code, std::move(arguments)});
}

void Diagnostics::add(const Diagnostics& others) {
  all_.insert(all_.end(), others.all_.begin(), others.all_.end());
}

bool Diagnostics::contains(DiagnosticCode code) const {
  return std::any_of(all_.begin(), all_.end(), [code](const Diagnostic& d) { return d.code == code; });
}

std::vector<std::string> Diagnostics::texts(Severity least) const {
  std::vector<std::string> out;
  for (const Diagnostic& d : all_)
    if (d.severity() >= least) out.push_back(d.text());
  return out;
}

}  // namespace glisson
