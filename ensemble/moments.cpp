#include "ensemble/moments.hpp"

#include <cmath>

#include "engine/numbers.hpp"

namespace jostle::inline ensemble {

void Moments::add(double value) {
  if (std::isnan(value)) return;
  if (count_ == 0) origin_ = value;
  ++count_;
  const double x = value - origin_;
  const double deviation = x - mean_;
  mean_ += deviation / static_cast<double>(count_);
  sum_of_squares_ += deviation * (x - mean_);
}

double Moments::mean() const {
  return count_ == 0 ? not_a_number : origin_ + mean_;
}

double Moments::sigma() const {
  if (count_ == 0) return not_a_number;
  return std::sqrt(sum_of_squares_ / static_cast<double>(count_));
}

double Moments::standard_error() const {
  if (count_ < 2) return not_a_number;
  const double m = static_cast<double>(count_);
  return std::sqrt(sum_of_squares_ / (m * (m - 1)));
}

}  // namespace jostle::inline ensemble
