#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ensemble/statistics/student_tests.hpp"

// When packings order, and how many still have not.
namespace jostle::inline ensemble {

/// The tap at which a realization has ordered; where it has not, the last at which it could have
/// been seen to, and `ordered` is false (censored on the right).
struct OrderingTime {
  std::uint64_t tap = 0;
  bool ordered = false;
  bool operator==(const OrderingTime&) const = default;
};

/// The first tap from which the series, X of taps 0, 1, .., is at or above `threshold` for `hold`
/// taps running, itself the first of them. Censored at tap n - hold: what would begin later is cut
/// off by the end. 1 <= hold <= n.
OrderingTime time_to_order(std::span<const double> series, double threshold, std::uint64_t hold);

/// Both ends of an interval; NaN where the data set no limit.
struct Limits {
  double low, high;
};

/// For the share in the population, of `n` drawn and `k` of them counted: Clopper & Pearson 1934,
/// doi:10.1093/biomet/26.4.404, from F's tails. It holds the truth at least as often as `level`,
/// whatever n.
Limits share_limits(std::uint64_t k, std::uint64_t n, double level);

/// S(t), the share of packings that have not ordered up to and with tap t. All realizations are
/// censored at one tap, so Kaplan & Meier's product (1958, doi:10.2307/2281868) is the plain share
/// of them, Greenwood's error the binomial one, and the limits are exact.
struct Survival {
  std::vector<std::uint64_t> taps;     // 0, those at which a realization ordered, the last
  std::vector<std::uint64_t> ordered;  // realizations so far, [n_taps]
  std::vector<double> share, error;    // S and Greenwood's error, [n_taps]
  std::vector<Limits> limits;          // limits of S, 95 %, [n_taps]
};
/// times: [M], M >= 1; `last`: at which they are censored.
Survival survival(std::span<const OrderingTime> times, std::uint64_t last);

/// The tap by which half of the realizations have ordered; NaN where fewer have.
double median_time(std::span<const OrderingTime> times);
/// The interval of the median between two of the ordered times, whatever their law (Brookmeyer &
/// Crowley 1982, doi:10.2307/2530286, by binomial probabilities instead of the normal law; David &
/// Nagaraja, Order Statistics, sec. 7.1). NaN on either side where too few realizations, or too few
/// that ordered, set no limit: 95 % needs six, 68 % three.
Limits median_limits(std::span<const OrderingTime> times, double level);

/// A mean over realizations with its error.
struct RealizationMean {
  double value = 0;
  ErrorOf error{};
};
/// How fast X grows: lines by least squares through taps 1 to n - 1 of each realization. On log10
/// t, decades weighing alike (1/t per tap), in units of X per decade; and on t, units of X per tap.
struct GrowthRates {
  RealizationMean per_decade, per_tap;
};
class GrowthOfSeries {
 public:
  void add(std::span<const double> series);  // [n], n >= 4
  GrowthRates result() const;

 private:
  std::vector<double> decades_, taps_;
};

/// Mean of values with its standard error, M - 1 degrees of freedom.
RealizationMean mean_of(std::span<const double> values);

}  // namespace jostle::inline ensemble
