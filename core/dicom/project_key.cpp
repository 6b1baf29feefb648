// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <fstream>

#include "base/error.h"
#include "base/sha256.h"
#include "dicom/deidentify.h"

namespace glisson::dicom {
namespace {

constexpr const char* keyHeader = "glisson/project-key/1";

bool isHex(const std::string& s) {
  return s.size() == 64 && s.find_first_not_of("0123456789abcdef") == std::string::npos;
}

std::string freshSecret() {
  std::array<unsigned char, 64> bytes{};
  std::ifstream random("/dev/urandom", std::ios::binary);
  random.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!random) throw Error("the system's random source cannot be read");
  return sha256(bytes.data(), bytes.size());
}

std::string unhex(const std::string& hex) {
  const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  std::string bytes;
  for (std::size_t n = 0; n + 1 < hex.size(); n += 2)
    bytes += static_cast<char>(16 * digit(hex[n]) + digit(hex[n + 1]));
  return bytes;
}

}  // namespace

ProjectKey openProjectKey(const std::filesystem::path& file, const std::vector<std::filesystem::path>& keepOutOf) {
  const auto where = std::filesystem::weakly_canonical(std::filesystem::absolute(file));
  for (const auto& folder : keepOutOf) {
    const auto root = std::filesystem::weakly_canonical(std::filesystem::absolute(folder));
    const auto relative = where.lexically_relative(root);
    if (!relative.empty() && *relative.begin() != "..")
      throw BadInput("the key file lies inside a folder of images or results; keep it apart from both");
  }
  std::ifstream in(file);
  if (in) {
    std::string header, secret;
    if (!std::getline(in, header) || !std::getline(in, secret) || header != keyHeader || !isHex(secret))
      throw BadInput("the key file is not one of this software (it begins '" + std::string(keyHeader) +
                     "'); give another, or a name that is not there yet");
    return {secret};
  }
  const ProjectKey key{freshSecret()};
  const std::string text = std::string(keyHeader) + "\n" + key.secret + "\n";
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  const bool good = descriptor >= 0 &&
                    write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                    fsync(descriptor) == 0;
  if (descriptor >= 0) close(descriptor);
  if (!good) throw BadInput("the key file cannot be written; is its folder there and writable?");
  return key;
}

std::string keyedDigest(const ProjectKey& key, const std::string& text) {
  return hmacSha256(unhex(key.secret), text);
}

}  // namespace glisson::dicom
