// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/language.h"

#include <algorithm>
#include <cstring>
#include <iterator>

#include "base/error.h"

namespace glisson {
namespace {

struct Text {
  const char *english, *german;
};
constexpr Text texts[] = {
#include "base/german.inc"
};

}  // namespace

const char* nameOf(Language language) {
  return language == Language::English ? "en" : "de";
}

Language languageNamed(const std::string& name) {
  return name == nameOf(Language::German) ? Language::German : Language::English;
}

std::string phrase(const char* english, Language language, std::initializer_list<std::string> values) {
  const Text* found = std::find_if(std::begin(texts), std::end(texts),
                                   [&](const Text& text) { return std::strcmp(text.english, english) == 0; });
  if (found == std::end(texts)) throw BadArgument(std::string("there is no German for '") + english + "'");
  std::string out;
  auto value = values.begin();
  for (const char* c = language == Language::English ? english : found->german; *c != '\0'; ++c)
    if (*c != '@')
      out += *c;
    else if (value != values.end())
      out += *value++;
    else
      throw BadArgument(std::string("too few values for '") + english + "'");
  if (value != values.end()) throw BadArgument(std::string("too many values for '") + english + "'");
  return out;
}

std::string inLanguage(std::string number, Language language) {
  if (language == Language::German) std::replace(number.begin(), number.end(), '.', ',');
  return number;
}

}  // namespace glisson
