// SPDX-License-Identifier: GPL-3.0-or-later
#include "manual_pages.h"

#include <sstream>

#include "base/version.h"

namespace glisson::cli {
namespace {

/// Text as roff takes it: no line begins with a request, '-' is the dash that can be copied.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool atStart = out.empty() || out.back() == '\n';
    if (atStart && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

/// Help of several lines keeps its lines: the formats of an export.
std::string paragraphs(const std::string& text) {
  std::istringstream lines(text);
  std::string out, one;
  std::getline(lines, one);
  out = roff(one) + "\n";
  while (std::getline(lines, one)) out += ".br\n" + roff(one) + "\n";
  return out;
}

std::string option(const OptionRow& o) {
  std::string names;
  for (const std::string& n : o.shortNames) names += (names.empty() ? "" : ", ") + ("\\fB\\-" + roff(n) + "\\fR");
  for (const std::string& n : o.longNames) names += (names.empty() ? "" : ", ") + ("\\fB\\-\\-" + roff(n) + "\\fR");
  if (names.empty()) names = "\\fI" + roff(o.positional) + "\\fR";
  std::string type = o.typeName.substr(0, o.typeName.find(':'));
  std::string text =
      ".TP\n" + names + (type.empty() ? "" : " \\fI" + roff(type) + "\\fR") + (o.many ? " ..." : "") + "\n";
  text += paragraphs(o.help);
  std::string rest;
  for (const std::string& c : o.choices) rest += (rest.empty() ? "one of " : ", ") + c;
  if (o.least && o.most) {
    std::ostringstream range;
    range << "from " << *o.least << " to " << *o.most;
    rest = range.str();
  }
  if (o.required) rest += rest.empty() ? "needed" : "; needed";
  if (!o.preset.empty()) rest += (rest.empty() ? "" : "; ") + ("otherwise " + o.preset);
  if (!rest.empty()) text += "(" + roff(rest) + ")\n";
  return text;
}

std::string options(const std::string& heading, const std::vector<OptionRow>& rows) {
  if (rows.empty()) return {};
  std::string text = ".SH " + heading + "\n";
  for (const OptionRow& o : rows) text += option(o);
  return text;
}

std::string begin(const std::string& page, const std::string& whatis) {
  std::string upper = page;
  for (char& c : upper)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return ".TH " + roff(upper) + " 1 \"\" \"Glisson " + version() + "\" \"Glisson\"\n.SH NAME\n" + roff(page) + " \\- " +
         roff(whatis) + "\n";
}

std::string firstLine(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

std::string end() {
  return std::string(".SH NOTE\n") + roff(researchUseOnly) + ".\n";
}

std::string called(const VerbRow& verb, const std::string& command) {
  std::string text = ".B " + roff(command) + "\n";
  for (const OptionRow& o : verb.options)
    if (!o.positional.empty())
      text += std::string(o.required ? "" : "[") + "\\fI" + roff(o.positional) + "\\fR" + (o.many ? " ..." : "") +
              (o.required ? "" : "]") + "\n";
  return text + "[\\fIoptions\\fR]\n";
}

std::string verbPage(const VerbRow& verb, const std::string& page, const std::string& command) {
  std::string text = begin(page, firstLine(verb.help));
  text += ".SH SYNOPSIS\n" + called(verb, command);
  for (const VerbRow& sub : verb.verbs) text += ".br\n" + called(sub, command + " " + sub.name);
  text += ".SH DESCRIPTION\n" + paragraphs(verb.help) + options("OPTIONS", verb.options);
  for (const VerbRow& sub : verb.verbs) text += options(roff(sub.name), sub.options);
  return text + ".SH SEE ALSO\n.BR " + roff(programName) + " (1),\nwhose common options this verb takes too.\n" + end();
}

std::string programPage(const VerbRow& program) {
  std::string text = begin(program.name, "patient-specific biomechanics for image-guided liver surgery");
  text += ".SH SYNOPSIS\n.B " + roff(program.name) + "\n\\fIverb\\fR [\\fIoptions\\fR]\n";
  text += ".SH DESCRIPTION\n" + paragraphs(program.help);
  text += ".SH VERBS\n";
  for (const VerbRow& v : program.verbs) text += ".TP\n\\fB" + roff(v.name) + "\\fR\n" + roff(firstLine(v.help)) + "\n";
  text += options("COMMON OPTIONS", program.options);
  text += ".SH EXIT STATUS\n";
  for (const auto& [code, meaning] :
       std::vector<std::pair<const char*, const char*>>{{"0", "done"},
                                                        {"1", "failed"},
                                                        {"2", "wrong usage"},
                                                        {"3", "bad input, or a warning with --strict"},
                                                        {"4", "not converged: the result is marked and not drawn"},
                                                        {"5", "cancelled"},
                                                        {"6", "part of a batch failed"}})
    text += std::string(".TP\n") + code + "\n" + roff(meaning) + "\n";
  text += ".SH SEE ALSO\n";
  for (const VerbRow& v : program.verbs)
    text += ".BR " + roff(program.name + "-" + v.name) + " (1)" + (&v == &program.verbs.back() ? "" : ",") + "\n";
  return text + end();
}

}  // namespace

std::vector<std::pair<std::string, std::string>> manualPages(const VerbRow& program) {
  std::vector<std::pair<std::string, std::string>> pages = {{program.name + ".1", programPage(program)}};
  for (const VerbRow& v : program.verbs) {
    const std::string page = program.name + "-" + v.name;
    pages.emplace_back(page + ".1", verbPage(v, page, program.name + " " + v.name));
  }
  return pages;
}

}  // namespace glisson::cli
