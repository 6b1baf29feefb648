// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/product_words.h"

#include <vector>

#include "base/text.h"

namespace glisson::dicom {
namespace {

struct Word {
  const char* text;
  SeriesRole role;
};

constexpr Word words[] = {{"confidence", SeriesRole::Confidence},
                          {"confmap", SeriesRole::Confidence},
                          {"conf map", SeriesRole::Confidence},
                          {"95conf", SeriesRole::Confidence},
                          {"95% conf", SeriesRole::Confidence},
                          {"stiffness", SeriesRole::Stiffness},
                          {"stiff", SeriesRole::Stiffness},
                          {"elastogram", SeriesRole::Stiffness},
                          {"shear mod", SeriesRole::Stiffness},
                          {"shearmod", SeriesRole::Stiffness},
                          {"young", SeriesRole::Stiffness},
                          {"elastic mod", SeriesRole::Stiffness},
                          {"wave speed", SeriesRole::Stiffness},
                          {"wavespeed", SeriesRole::Stiffness},
                          {"shear speed", SeriesRole::Stiffness},
                          {"wave velocity", SeriesRole::Stiffness},
                          {"wave", SeriesRole::Wave},
                          {"displacement", SeriesRole::Wave},
                          {"loss mod", SeriesRole::Other},
                          {"storage mod", SeriesRole::Other},
                          {"damping", SeriesRole::Other},
                          {"viscosity", SeriesRole::Other},
                          {"strain", SeriesRole::Other}};

/// Small letters; what parts words is a space.
std::string spaced(std::string text) {
  text = lowerCase(std::move(text));
  for (char& c : text)
    if (c == '_' || c == '-' || c == '\\' || c == '/') c = ' ';
  return text;
}

/// Parts a name before each word after which something else is spoken of.
std::vector<std::string> parts(const std::string& text) {
  std::vector<std::string> out(1);
  std::size_t at = 0;
  while (at < text.size()) {
    bool cut = false;
    for (const char* word : {" of ", " with ", " from ", " by ", " for ", " without "}) {
      if (text.compare(at, std::char_traits<char>::length(word), word) != 0) continue;
      out.emplace_back();
      at += std::char_traits<char>::length(word) - 1;
      cut = true;
      break;
    }
    if (!cut) out.back() += text[at++];
  }
  return out;
}

bool holds(const std::string& text, const char* word) {
  return text.find(word) != std::string::npos;
}

/// The word that ends last, the longest of several.
const Word* lastWord(const std::string& text, bool elastographyOnly) {
  const Word* last = nullptr;
  std::size_t end = 0;
  for (const Word& w : words) {
    const std::string word = w.text;
    if (!elastographyOnly && (word == "displacement" || w.role == SeriesRole::Other || word == "young")) continue;
    std::size_t at = text.rfind(word);
    if (word == "wave" && at != std::string::npos && at >= 5 && text.compare(at - 5, 5, "micro") == 0)
      at = std::string::npos;
    if (at == std::string::npos) continue;
    const std::size_t here = at + word.size();
    if (here > end || (here == end && word.size() > std::string(last->text).size())) {
      last = &w;
      end = here;
    }
  }
  return last;
}

/// Whether the word stands for the unit of the values: not in "0-8 kPa", which is how they are shown, nor in "1/kPa".
bool namesUnit(const std::string& text, const std::string& word) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const std::size_t before = at == 0 ? std::string::npos : text.find_last_not_of(" _", at - 1);
    const char c = before == std::string::npos ? ' ' : text[before];
    if (c != '/' && (c < '0' || c > '9')) return true;
  }
  return false;
}

}  // namespace

std::optional<std::string> unitInWords(const std::string& description) {
  const std::string text = lowerCase(description);
  if (namesUnit(text, "kpa")) return "kPa";
  if (holds(text, "(pa)") || holds(text, "[pa]")) return "Pa";
  if (holds(text, "(m/s)") || holds(text, "[m/s]")) return "m/s";
  return std::nullopt;
}

std::optional<Product> productNamed(const std::string& name, bool shearAlone) {
  const std::string all = spaced(name);
  for (const std::string& part : parts(all)) {
    const Word* word = lastWord(part, shearAlone);
    if (word == nullptr) continue;
    Product product{word->role, word->text, false};
    const char* map = holds(part, "stiff") ? "stiff" : holds(part, "elastogram") ? "elastogram" : nullptr;
    const bool share = holds(part, "%") || holds(part, "95");
    if (map != nullptr && word->role == SeriesRole::Confidence && (share || unitInWords(name)))
      product = {SeriesRole::Stiffness, map, true};
    if (product.role == SeriesRole::Stiffness)
      product.masked = product.masked || holds(all, "mask") || (holds(all, "conf") && share);
    return product;
  }
  if (shearAlone && holds(all, "shear")) return Product{SeriesRole::Stiffness, "shear", false};
  return std::nullopt;
}

}  // namespace glisson::dicom
