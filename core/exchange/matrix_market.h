#pragma once

#include <Eigen/SparseCore>
#include <filesystem>
#include <string>
#include <vector>

namespace glisson::exchange {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Writes the lower triangle of a symmetric matrix as "matrix coordinate real symmetric" with all digits of a double;
/// comments come first, a line each (unit, ordering). Throws BadArgument where the matrix is not square, BadInput where
/// the file cannot be written.
void writeMatrixMarket(const std::filesystem::path& file, const SparseMatrix& lower,
                       const std::vector<std::string>& comments);

/// A dense column, "matrix array real general".
void writeMatrixMarket(const std::filesystem::path& file, const Eigen::VectorXd& column,
                       const std::vector<std::string>& comments);

/// Reads what is written above: the full symmetric matrix. Throws BadInput, naming the line.
SparseMatrix readMatrixMarket(const std::filesystem::path& file);

}  // namespace glisson::exchange
