// SPDX-License-Identifier: GPL-3.0-or-later
#include "manual_pages.h"

namespace glisson::cli {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& w : words) text += (text.empty() ? "" : " ") + w;
  return text;
}

bool onlyFolders(const OptionRow& o) {
  return o.paths.size() == 1 && o.paths.front() == PathKind::Folder;
}

std::vector<std::string> namesOf(const OptionRow& o) {
  std::vector<std::string> names;
  for (const std::string& n : o.longNames) names.push_back("--" + n);
  for (const std::string& n : o.shortNames) names.push_back("-" + n);
  return names;
}

/// What may follow an option: a line of bash that sets COMPREPLY; nothing where any text may.
std::string valuesOf(const OptionRow& o) {
  if (o.kind == ValueKind::Path) return std::string("_glisson_cli_paths ") + (onlyFolders(o) ? "-d" : "-f");
  if (o.kind == ValueKind::Choice || o.kind == ValueKind::IntegerChoice)
    return "COMPREPLY=($(compgen -W \"" + joined(o.choices) + "\" -- \"$cur\"))";
  return o.kind == ValueKind::Flag ? std::string() : "COMPREPLY=()";
}

/// The cases of one verb: values by the option before, then its options, its own verbs or its positionals.
void addVerb(const VerbRow& verb, const std::string& key, std::string& values, std::string& words) {
  std::vector<std::string> names, positional;
  std::string places = "-f";
  for (const OptionRow& o : verb.options) {
    const std::vector<std::string> own = namesOf(o);
    names.insert(names.end(), own.begin(), own.end());
    if (own.empty() && !o.choices.empty()) positional = o.choices;
    if (own.empty() && onlyFolders(o)) places = "-d";
    const std::string then = valuesOf(o);
    if (own.empty() || then.empty()) continue;
    std::string pattern;
    for (const std::string& n : own) pattern += (pattern.empty() ? "" : "|") + ("\"" + key + ":" + n + "\"");
    values += "    " + pattern + ") " + then + "; return ;;\n";
  }
  for (const VerbRow& sub : verb.verbs) positional.push_back(sub.name);
  words += "    \"" + key + "\") options=\"" + joined(names) + "\"; words=\"" + joined(positional) +
           "\"; places=" + places + " ;;\n";
  for (const VerbRow& sub : verb.verbs) addVerb(sub, key + (key.empty() ? "" : " ") + sub.name, values, words);
}

}  // namespace

std::string bashCompletion(const VerbRow& program) {
  std::string values, words;
  addVerb(program, "", values, words);
  std::string common, commonValues, verbs;
  for (const OptionRow& o : program.options) {
    for (const std::string& n : namesOf(o)) common += " " + n;
    const std::string then = valuesOf(o);
    if (then.empty()) continue;
    std::string pattern;
    for (const std::string& n : namesOf(o)) pattern += (pattern.empty() ? "" : "|") + ("*:" + n);
    commonValues += "    " + pattern + ") " + then + "; return ;;\n";
  }
  for (const VerbRow& v : program.verbs) {
    verbs += " \"" + v.name + "\"";
    for (const VerbRow& sub : v.verbs) verbs += " \"" + v.name + " " + sub.name + "\"";
  }
  return "# bash completion of " + program.name + ", written by `" + program.name +
         " document`\n"
         "_glisson_cli_paths() {\n"
         "  compopt -o filenames 2>/dev/null\n"
         "  mapfile -t COMPREPLY < <(compgen \"$1\" -- \"$cur\")\n"
         "}\n\n"
         "_glisson_cli() {\n"
         "  local cur=\"${COMP_WORDS[COMP_CWORD]}\" prev=\"\" verb=\"\" options=\"\" words=\"\" places=-f word known\n"
         "  [ \"$COMP_CWORD\" -gt 0 ] && prev=\"${COMP_WORDS[COMP_CWORD-1]}\"\n"
         "  COMPREPLY=()\n"
         "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
         "    for known in" +
         verbs +
         "; do\n"
         "      [ \"${verb:+$verb }$word\" = \"$known\" ] && { verb=\"$known\"; break; }\n"
         "    done\n"
         "  done\n"
         "  case \"$verb:$prev\" in\n" +
         values + commonValues +
         "  esac\n"
         "  case \"$verb\" in\n" +
         words +
         "  esac\n"
         "  if [[ \"$cur\" == -* ]]; then\n"
         "    mapfile -t COMPREPLY < <(compgen -W \"$options" +
         common +
         "\" -- \"$cur\")\n"
         "  elif [ -n \"$words\" ]; then\n"
         "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$cur\")\n"
         "  elif [ -n \"$verb\" ]; then\n"
         "    _glisson_cli_paths \"$places\"\n"
         "  fi\n"
         "}\n"
         "complete -F _glisson_cli " +
         program.name + "\n";
}

}  // namespace glisson::cli
