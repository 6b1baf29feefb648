// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastography/readers.h"

#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"
#include "elastography/bootstrap.h"

namespace glisson::elastography {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Quantile of the F distribution.
double quantile(double p, double numerator, double denominator) {
  return boost::math::quantile(boost::math::fisher_f(numerator, denominator), p);
}

/// Interval of (F − 1) / (F + k − 1), the form of ICC(1,1) and ICC(3,1).
Correlation simple(double effect, double error, double freedomEffect, double freedomError, double k, double p) {
  Correlation c;
  c.value = (effect - error) / (effect + (k - 1.0) * error);
  if (!(error > 0.0)) return {c.value, nan, nan};
  const double f = effect / error;
  const double low = f / quantile(p, freedomEffect, freedomError), high = f * quantile(p, freedomError, freedomEffect);
  c.low = (low - 1.0) / (low + k - 1.0);
  c.high = (high - 1.0) / (high + k - 1.0);
  return c;
}

Correlation absolute(double msr, double msc, double mse, double n, double k, double p) {
  Correlation c;
  c.value = (msr - mse) / (msr + (k - 1.0) * mse + k * (msc - mse) / n);
  if (!(mse > 0.0)) return {c.value, nan, nan};
  const double f = msc / mse, rho = c.value;
  const double other = n * (1.0 + (k - 1.0) * rho) - k * rho;
  const double freedom = (k - 1.0) * (n - 1.0) * std::pow(k * rho * f + other, 2) /
                         ((n - 1.0) * k * k * rho * rho * f * f + other * other);
  const double low = quantile(p, n - 1.0, freedom), high = quantile(p, freedom, n - 1.0);
  const double rest = k * msc + (k * n - k - n) * mse;
  c.low = n * (msr - low * mse) / (low * rest + n * msr);
  c.high = n * (high * msr - mse) / (rest + n * high * msr);
  return c;
}

}  // namespace

ReaderReliability readerReliability(const Eigen::MatrixXd& values, double confidence) {
  const auto n = static_cast<double>(values.rows()), k = static_cast<double>(values.cols());
  if (n < 2.0 || k < 2.0)
    throw BadInput("reliability needs at least two cases and two readers; there are " + std::to_string(values.rows()) +
                   " cases and " + std::to_string(values.cols()) + " readers");
  if (!values.allFinite()) throw BadInput("a reading is not a finite number; leave its case out");
  if (!(confidence > 0.0 && confidence < 1.0)) throw BadArgument("a confidence level must lie between 0 and 1");
  const double mean = values.mean();
  const double total = (values.array() - mean).square().sum();
  if (!(total > 0.0)) throw BadInput("all readings are equal: there is nothing to tell cases apart by");
  const double rows = k * (values.rowwise().mean().array() - mean).square().sum();
  const double columns = n * (values.colwise().mean().array() - mean).square().sum();
  ReaderReliability r;
  r.cases = static_cast<int>(values.rows());
  r.readers = static_cast<int>(values.cols());
  r.confidence = confidence;
  r.betweenCases = rows / (n - 1.0);
  r.betweenReaders = columns / (k - 1.0);
  r.residual = std::max(0.0, total - rows - columns) / ((n - 1.0) * (k - 1.0));
  const double within = (total - rows) / (n * (k - 1.0));
  const double p = 0.5 + 0.5 * confidence;
  r.icc11 = simple(r.betweenCases, within, n - 1.0, n * (k - 1.0), k, p);
  r.icc21 = absolute(r.betweenCases, r.betweenReaders, r.residual, n, k, p);
  r.icc31 = simple(r.betweenCases, r.residual, n - 1.0, (n - 1.0) * (k - 1.0), k, p);
  return r;
}

BlandAltman blandAltman(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size() || a.size() < 3)
    throw BadInput("limits of agreement need the same three or more cases from both readers; there are " +
                   std::to_string(a.size()) + " and " + std::to_string(b.size()));
  BlandAltman r;
  r.n = static_cast<int>(a.size());
  const auto n = static_cast<double>(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!std::isfinite(a[i]) || !std::isfinite(b[i])) throw BadInput("a reading is not a finite number");
    r.mean.push_back(0.5 * (a[i] + b[i]));
    r.difference.push_back(b[i] - a[i]);
    r.bias += r.difference.back() / n;
  }
  double squares = 0.0;
  for (const double d : r.difference) squares += (d - r.bias) * (d - r.bias);
  r.sd = std::sqrt(squares / (n - 1.0));
  r.lowLimit = r.bias - 1.96 * r.sd;
  r.highLimit = r.bias + 1.96 * r.sd;
  const double t = quantileT(0.975, n - 1.0);
  r.bias_low = r.bias - t * r.sd / std::sqrt(n);
  r.bias_high = r.bias + t * r.sd / std::sqrt(n);
  r.limit_ci = t * std::sqrt(3.0 / n) * r.sd;
  return r;
}

}  // namespace glisson::elastography
