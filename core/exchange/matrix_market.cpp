#include "exchange/matrix_market.h"

#include <fstream>
#include <sstream>

#include "base/error.h"
#include "exchange/write_text.h"

namespace glisson::exchange {
namespace {

std::string heading(const char* kind, const std::vector<std::string>& comments) {
  std::string out = std::string("%%MatrixMarket matrix ") + kind + "\n";
  for (const std::string& c : comments) out += "% " + c + "\n";
  return out;
}

}  // namespace

void writeMatrixMarket(const std::filesystem::path& file, const SparseMatrix& lower,
                       const std::vector<std::string>& comments) {
  if (lower.rows() != lower.cols()) throw BadArgument("a symmetric matrix must be square");
  std::string out = heading("coordinate real symmetric", comments);
  std::size_t entries = 0;
  std::string body;
  for (Eigen::Index c = 0; c < lower.outerSize(); ++c)
    for (SparseMatrix::InnerIterator it(lower, c); it; ++it) {
      if (it.row() < it.col()) continue;
      body += std::to_string(it.row() + 1) + " " + std::to_string(it.col() + 1) + " " + number(it.value()) + "\n";
      ++entries;
    }
  out += std::to_string(lower.rows()) + " " + std::to_string(lower.cols()) + " " + std::to_string(entries) + "\n";
  writeBytes(file, out + body);
}

void writeMatrixMarket(const std::filesystem::path& file, const Eigen::VectorXd& column,
                       const std::vector<std::string>& comments) {
  std::string out = heading("array real general", comments) + std::to_string(column.size()) + " 1\n";
  for (Eigen::Index n = 0; n < column.size(); ++n) out += number(column[n]) + "\n";
  writeBytes(file, out);
}

SparseMatrix readMatrixMarket(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  int at = 0;
  const auto fail = [&](const std::string& why) {
    throw BadInput("'" + file.filename().string() + "', line " + std::to_string(at) + ": " + why);
  };
  const auto next = [&] {
    ++at;
    return static_cast<bool>(std::getline(in, line));
  };
  if (!next() || line != "%%MatrixMarket matrix coordinate real symmetric")
    fail("a symmetric real coordinate matrix was expected");
  while (next() && !line.empty() && line[0] == '%') {
  }
  long rows = 0, columns = 0, entries = 0;
  if (!(std::istringstream(line) >> rows >> columns >> entries) || rows != columns || rows < 1 || entries < 0)
    fail("the size of the matrix cannot be read");
  std::vector<Eigen::Triplet<double>> triplets;
  for (long n = 0; n < entries; ++n) {
    long r = 0, c = 0;
    double v = 0.0;
    if (!next() || !(std::istringstream(line) >> r >> c >> v) || r < c || c < 1 || r > rows)
      fail("an entry 'row column value' of the lower triangle was expected");
    triplets.emplace_back(static_cast<int>(r - 1), static_cast<int>(c - 1), v);
    if (r != c) triplets.emplace_back(static_cast<int>(c - 1), static_cast<int>(r - 1), v);
  }
  SparseMatrix matrix(rows, columns);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

}  // namespace glisson::exchange
