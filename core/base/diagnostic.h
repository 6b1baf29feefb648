// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace glisson {

/// How serious a diagnostic is.
enum class Severity { Note, Warning, Error };

/// What can be said about inputs and results. One entry each in diagnostics.def, with its name in JSON, its severity
/// and its English text.
enum class DiagnosticCode {
#define GLISSON_DIAGNOSTIC(code, name, severity, text) code,
#include "base/diagnostics.def"
#undef GLISSON_DIAGNOSTIC
};

std::string_view nameOf(DiagnosticCode code);  ///< as in JSON: "difference-withheld"
std::string_view nameOf(Severity severity);    ///< "note", "warning", "error"

/// A number, a count or a word of the program's own (never a patient's name, never a sentence).
using DiagnosticValue = std::variant<double, std::int64_t, std::string>;

/// One fact about an input or a result, as data; its text is made from the table when somebody reads it.
struct Diagnostic {
  DiagnosticCode code{};
  std::vector<std::pair<std::string, DiagnosticValue>> arguments;

  Severity severity() const;  ///< of the code
  /// The table's text with its {arguments} filled in; numbers with four significant digits. Throws BadArgument if the
  /// text names an argument that is not there.
  std::string text() const;
};

/// Diagnostics in the order in which they arose.
class Diagnostics {
 public:
  void add(DiagnosticCode code, std::vector<std::pair<std::string, DiagnosticValue>> arguments = {});
  void add(const Diagnostics& others);
  bool contains(DiagnosticCode code) const;
  bool empty() const { return all_.empty(); }
  std::size_t size() const { return all_.size(); }
  /// Texts of those at least as severe as `least`.
  std::vector<std::string> texts(Severity least = Severity::Note) const;
  auto begin() const { return all_.begin(); }
  auto end() const { return all_.end(); }

 private:
  std::vector<Diagnostic> all_;
};

}  // namespace glisson
