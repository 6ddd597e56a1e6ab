#include "ensemble/statistics/jackknife.hpp"

#include <cmath>

#include "engine/numbers.hpp"
#include "ensemble/moments.hpp"

namespace jostle::inline ensemble {

double jackknife_error(std::span<const double> left_out) {
  Moments moments;
  for (const double estimate : left_out) {
    if (std::isnan(estimate)) return not_a_number;
    moments.add(estimate);
  }
  if (moments.count() < 2) return not_a_number;
  return moments.sigma() * std::sqrt(static_cast<double>(moments.count() - 1));
}

double student_half_width(double error, std::size_t realizations, double level) {
  return half_width(error, static_cast<double>(realizations) - 1, level);
}

}  // namespace jostle::inline ensemble
