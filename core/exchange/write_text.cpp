#include "exchange/write_text.h"

#include <fcntl.h>
#include <unistd.h>

#include <charconv>
#include <cmath>
#include <fstream>

#include "base/error.h"

namespace glisson::exchange {

void writeBytes(const std::filesystem::path& file, const std::string& bytes) {
  const auto temporary = file.parent_path() / ("." + file.filename().string() + ".part-" + std::to_string(getpid()));
  std::error_code failed;
  bool good = false;
  {
    std::ofstream out(temporary, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.flush();
    good = static_cast<bool>(out);
  }
  if (good) {
    const int descriptor = open(temporary.c_str(), O_RDONLY | O_CLOEXEC);
    good = descriptor >= 0 && fsync(descriptor) == 0;
    if (descriptor >= 0) close(descriptor);
  }
  if (good) std::filesystem::rename(temporary, file, failed);
  if (good && !failed) return;
  std::filesystem::remove(temporary, failed);
  throw BadInput("'" + file.filename().string() +
                 "' cannot be written; is the folder there, writable, and the disk not full?");
}

std::string xmlEscaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&apos;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20) out += c;
    }
  }
  return out;
}

std::string number(double value) {
  if (!std::isfinite(value)) return "nan";
  char text[40];
  const auto [end, problem] = std::to_chars(text, text + sizeof text, value);
  return problem == std::errc{} ? std::string(text, end) : "nan";
}

}  // namespace glisson::exchange
