// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <initializer_list>
#include <string>

namespace glisson {

/// Of what a surgeon reads: the sentence that says how sure an answer is, and its pictures.
enum class Language { English, German };

/// "en", "de".
const char* nameOf(Language language);
/// The reverse; English where the name is none of these.
Language languageNamed(const std::string& name);

/// The text in the language, with values in the places that are marked by @, in their order. English texts are their
/// own keys, German ones stand in german.inc. Throws BadArgument where there is no German for it, or another number of
/// values.
std::string phrase(const char* english, Language language, std::initializer_list<std::string> values = {});

/// A number as the language writes it: German has a comma where English has a point.
std::string inLanguage(std::string number, Language language);

}  // namespace glisson
