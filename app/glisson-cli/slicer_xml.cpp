// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer_xml.h"

#include <algorithm>
#include <cctype>
#include <iostream>

#include "base/version.h"
#include "base/xml_text.h"
#include "report/text.h"

namespace glisson::cli {
namespace {

/// Letters, digits and underscores only: Slicer takes nothing else for names and flags.
std::string identifier(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

std::string nameOf(const OptionRow& o) {
  if (!o.positional.empty()) return o.positional;
  return o.longNames.empty() ? std::string() : o.longNames.front();
}

std::string labelOf(std::string name) {
  std::replace(name.begin(), name.end(), '-', ' ');
  if (!name.empty()) name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return name;
}

std::string line(const std::string& tag, const std::string& text) {
  return "      <" + tag + ">" + xmlEscaped(text) + "</" + tag + ">\n";
}

/// What all parameters have: name, how it is given, what it is.
std::string common(const OptionRow& o, const std::string& suffix, const std::string& labelEnd, int index) {
  const std::string name = nameOf(o);
  std::string xml = line("name", identifier(name + suffix));
  xml += index >= 0 ? line("index", std::to_string(index)) : line("longflag", "--" + identifier(name));
  xml += line("label", labelOf(name) + labelEnd);
  std::string help = o.help;
  if (o.required && o.paths.size() > 1 && index < 0) help += " (needed: in one of its forms)";
  if (o.required && o.paths.size() <= 1) help += " (needed)";
  if (o.preset.empty() && !o.choices.empty()) {
    help += ": ";
    for (const std::string& c : o.choices) help += (c == o.choices.front() ? "" : ", ") + c;
    help += ", or nothing";
  }
  return xml + line("description", help);
}

std::string element(const std::string& tag, const std::string& attributes, const std::string& inside) {
  return "    <" + tag + attributes + ">\n" + inside + "    </" + tag + ">\n";
}

std::string pathParameter(const OptionRow& o, PathKind kind, bool output, int index) {
  const bool alone = o.paths.size() == 1 || index >= 0;
  const std::string channel = line("channel", output ? "output" : "input");
  switch (kind) {
    case PathKind::Folder:
      return element("directory", "", common(o, alone ? "" : "-folder", alone ? "" : " (folder)", index) + channel);
    case PathKind::File:
      return element("file", "", common(o, alone ? "" : "-file", alone ? "" : " (file)", index) + channel);
    case PathKind::Volume:
      return element("image", std::string(" type=\"scalar\"") + (o.many ? " multiple=\"true\"" : ""),
                     common(o, alone ? "" : "-volume", alone ? "" : " (volume)", index) + channel);
    case PathKind::Mask: break;
  }
  return element("image", " type=\"label\"",
                 common(o, alone ? "" : "-mask", alone ? "" : " (label map)", index) + channel);
}

std::string constraints(const OptionRow& o) {
  if (!o.least && !o.most && !o.above0) return {};
  std::string xml = "      <constraints>\n";
  if (o.least || o.above0) xml += "  " + line("minimum", report::number(o.least.value_or(0.0), 10));
  if (o.most) xml += "  " + line("maximum", report::number(*o.most, 10));
  return xml + "      </constraints>\n";
}

std::string enumeration(const OptionRow& o, const std::string& tag, const std::string& inside) {
  std::string elements;
  for (const std::string& c : o.choices) elements += line("element", c);
  return element(tag, "", inside + line("default", o.preset) + elements);
}

/// A value that is no path.
std::string valueParameter(const OptionRow& o, int index) {
  const std::string inside = common(o, "", "", index);
  const bool inOneWord = o.many && o.delimiter != '\0';
  if (o.kind == ValueKind::Flag) return element("boolean", "", inside + line("default", "false"));
  if (o.kind == ValueKind::Point) return element("point", " multiple=\"false\" coordinateSystem=\"lps\"", inside);
  if (inOneWord) return element(o.kind == ValueKind::Number ? "double-vector" : "string-vector", "", inside);
  if (o.preset.empty()) return element("string", "", inside);
  if (o.kind == ValueKind::Choice) return enumeration(o, "string-enumeration", inside);
  if (o.kind == ValueKind::IntegerChoice) return enumeration(o, "integer-enumeration", inside);
  const std::string preset = inside + line("default", o.preset);
  if (o.kind == ValueKind::Integer) return element("integer", "", preset + constraints(o));
  if (o.kind == ValueKind::Number) return element("double", "", preset + constraints(o));
  return element("string", "", preset);
}

std::string group(const std::string& label, const std::string& description, bool advanced, const std::string& inside) {
  if (inside.empty()) return {};
  return std::string("  <parameters") + (advanced ? " advanced=\"true\"" : "") + ">\n    <label>" + label +
         "</label>\n    <description>" + description + "</description>\n" + inside + "  </parameters>\n";
}

}  // namespace

std::string slicerXml(const SlicerModule& module, const VerbRow& verb, const std::vector<OptionRow>& commonOptions) {
  std::string inputs, outputs, settings;
  int place = 0;
  for (const OptionRow& o : verb.options) {
    if (nameOf(o) == "help" || nameOf(o) == "xml") continue;
    const int index = o.positional.empty() ? -1 : place++;
    if (o.kind != ValueKind::Path) {
      (o.required ? inputs : settings) += valueParameter(o, index);
      continue;
    }
    // By its place only one of several forms can be given.
    const std::size_t forms = index >= 0 ? 1 : o.paths.size();
    for (std::size_t f = 0; f < forms; ++f) inputs += pathParameter(o, o.paths[f], false, index);
  }
  for (OptionRow o : commonOptions) {
    if (o.kind != ValueKind::Path) {
      settings += valueParameter(o, -1);
      continue;
    }
    o.paths = module.output;
    for (const PathKind kind : module.output) outputs += pathParameter(o, kind, true, -1);
  }
  std::string xml = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<executable>\n";
  xml += "  <category>Glisson</category>\n  <title>" + xmlEscaped(module.title) + "</title>\n  <description>" +
         xmlEscaped(verb.help + ". " + researchUseOnly + ".") + "</description>\n  <version>" + version() +
         "</version>\n  <documentation-url></documentation-url>\n  <license>GPL-3.0-or-later</license>\n"
         "  <contributor>The Glisson authors</contributor>\n";
  xml += group("Input", "What is read", false, inputs);
  xml += group("Output", "What is written", false, outputs);
  xml += group("Settings", "What may be left as it is", true, settings);
  return xml + "</executable>\n";
}

void addSlicerXml(CLI::App& verb, const SlicerModule& module) {
  verb.add_flag_callback(
          "--xml",
          [&verb, module] {
            std::vector<OptionRow> offered;
            for (const char* name : {"--output", "--threads", "--strict"})
              offered.push_back(rowOf(*verb.get_parent()->get_option(name)));
            std::cout << slicerXml(module, tableOf(verb), offered) << std::flush;
            throw CLI::Success();
          },
          "describe this verb to 3D Slicer and end")
      ->trigger_on_parse();
}

}  // namespace glisson::cli
