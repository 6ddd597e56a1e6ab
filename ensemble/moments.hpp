#pragma once

#include <cstdint>

namespace jostle::inline ensemble {

/// Mean and spread of one observable at one tap over realizations, folded one value at a time in
/// the order of realizations (Welford 1962, on the differences from the first value, which are
/// exact where fluctuations are small), so that small fluctuations on a large mean keep their
/// digits. NaN values (failed realizations) are skipped.
class Moments {
 public:
  void add(double value);

  std::uint64_t count() const { return count_; }
  /// NaN without values.
  double mean() const;
  /// Population deviation, 1/M: sigma of Rosato et al. 2010. NaN without values.
  double sigma() const;
  /// Standard error of the mean, sqrt(sum of squares / (M (M - 1))). NaN below two values.
  double standard_error() const;

 private:
  std::uint64_t count_ = 0;
  double origin_ = 0;  // the first value
  double mean_ = 0;    // mean of the differences from it
  double sum_of_squares_ = 0;
};

}  // namespace jostle::inline ensemble
