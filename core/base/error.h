// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace glisson {

/// Root of every exception this project throws on purpose. The message says what is wrong, where, the value seen,
/// and what to do; it never holds a patient identifier.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The user's files, scene or region of interest cannot be used. Command line exit code 3.
class BadInput : public Error {
 public:
  using Error::Error;
};

/// A caller broke a documented precondition: our fault, not the user's. Exit code 1.
class BadArgument : public Error {
 public:
  using Error::Error;
};

/// A solve ended without the accuracy that was asked for. Exit code 4.
class SolverFailed : public Error {
 public:
  SolverFailed(const std::string& what, int iterations_, double residual_, double tolerance_)
      : Error(what), iterations(iterations_), residual(residual_), tolerance(tolerance_) {}
  int iterations;
  double residual;   ///< relative, ‖b − A x‖ / ‖b‖
  double tolerance;  ///< relative, as asked for
};

/// No way to draw: neither a display nor EGL. Exit code 1.
class RenderUnavailable : public Error {
 public:
  using Error::Error;
};

/// The user asked to stop. Exit code 5.
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
};

}  // namespace glisson
