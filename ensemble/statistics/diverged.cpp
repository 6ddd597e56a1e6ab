#include "ensemble/statistics/diverged.hpp"

#include <algorithm>
#include <cmath>

namespace jostle::inline ensemble {

namespace {

constexpr double absurd = 100;

double largest_of(const std::vector<double>& fitted) {
  double largest = 0;
  for (const double x : fitted) largest = std::max(largest, std::abs(x));
  return largest;
}

}  // namespace

bool has_diverged(const Fit& fit, std::size_t parameter) {
  const Estimate& estimate = fit.estimates[parameter];
  if (estimate.identifiability == Identifiability::fixed) return false;
  const double size = std::abs(estimate.value);
  if (!std::isfinite(size)) return true;
  const bool rough = !(estimate.standard_error <= absurd * size);
  if (estimate.parameter.lower == 0) return rough;
  return rough && estimate.parameter.unit == ParameterUnit::value &&
         size > absurd * largest_of(fit.fitted);
}

std::string diverged_parameters(const Fit& fit) {
  std::string names;
  for (std::size_t j = 0; j < fit.estimates.size(); ++j) {
    if (!has_diverged(fit, j)) continue;
    names += (names.empty() ? "" : ", ") + fit.estimates[j].parameter.name;
  }
  if (names.empty()) return "";
  return "the data do not limit " + names + ": the best fit is at infinity";
}

}  // namespace jostle::inline ensemble
