#include "fitting/curve.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <utility>

namespace jostle::inline fitting {

namespace {

// Squares of residuals over squared errors stay far from the ends of double precision.
constexpr double least_size = 1e-120, largest_size = 1e120, widest_ratio = 1e30;

// "t is not finite at 2 points, the first being number 3 (nan)"
template <typename Bad>
void report(const std::vector<double>& values, const char* message, Bad bad,
            std::vector<std::string>& faults) {
  const auto first = std::find_if(values.begin(), values.end(), bad);
  if (first == values.end()) return;
  std::ostringstream text;
  text << message << " at " << std::count_if(first, values.end(), bad) << " of " << values.size()
       << " points, the first being number " << first - values.begin() + 1 << " (" << *first << ")";
  faults.push_back(text.str());
}

// The points of these numbers, in this order.
Curve chosen(const Curve& curve, const std::vector<std::size_t>& points) {
  Curve part{.t = {}, .x = {}, .n_realizations = curve.n_realizations};
  part.offsets = curve.offsets;
  for (const std::size_t i : points) {
    part.t.push_back(curve.t[i]);
    part.x.push_back(curve.x[i]);
    if (!curve.sigma.empty()) part.sigma.push_back(curve.sigma[i]);
    for (std::size_t r = 0; r < curve.n_realizations; ++r) {
      part.values.push_back(curve.values[i * curve.n_realizations + r]);
      if (!curve.present.empty()) {
        part.present.push_back(curve.present[i * curve.n_realizations + r]);
      }
    }
  }
  return part;
}

// The error of each mean over their root mean square, by the number of realizations present.
std::vector<double> error_growth(const Curve& curve) {
  std::vector<double> growth(curve.x.size(), 1.0);
  if (curve.present.empty()) return growth;
  double sum = 0;
  for (std::size_t i = 0; i < growth.size(); ++i) {
    const auto row = curve.present.begin() + static_cast<std::ptrdiff_t>(i * curve.n_realizations);
    const auto n = std::accumulate(row, row + static_cast<std::ptrdiff_t>(curve.n_realizations), 0);
    growth[i] = 1 / std::sqrt(static_cast<double>(n));
    sum += growth[i] * growth[i];
  }
  for (double& factor : growth) factor /= std::sqrt(sum / static_cast<double>(growth.size()));
  return growth;
}

}  // namespace

// Differences from the first realization keep the digits of small fluctuations.
Curve mean_curve(std::vector<double> t, std::vector<double> values, std::size_t n_realizations) {
  Curve curve{.t = std::move(t), .x = {}};
  for (std::size_t i = 0; i < curve.t.size(); ++i) {
    const double* row = values.data() + i * n_realizations;
    double sum = 0;
    for (std::size_t r = 0; r < n_realizations; ++r) sum += row[r] - row[0];
    curve.x.push_back(row[0] + sum / static_cast<double>(n_realizations));
  }
  if (n_realizations < 2) return curve;
  curve.values = std::move(values);
  curve.n_realizations = n_realizations;
  return curve;
}

Curve with_pooled_errors(Curve curve, bool relative) {
  if (curve.n_realizations == 0 || !curve.sigma.empty()) return curve;
  const std::size_t m = curve.n_realizations;
  double sum = 0;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    for (std::size_t r = 0; r < m; ++r) {
      const double deviation = curve.values[i * m + r] - curve.x[i];
      sum += std::pow(relative ? deviation / curve.x[i] : deviation, 2);
    }
  }
  const double error = std::sqrt(sum / static_cast<double>(curve.x.size() * m * (m - 1)));
  if (!(error > 0) || !std::isfinite(error)) return curve;
  const std::vector<double> growth = error_growth(curve);
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    curve.sigma.push_back(growth[i] * (relative ? error * std::abs(curve.x[i]) : error));
  }
  return curve;
}

std::vector<std::string> faults(const Curve& curve) {
  std::vector<std::string> found;
  const std::size_t n = curve.t.size();
  if (n == 0)
    found.push_back("the curve has no points: none was measured, or none is in the range");
  if (curve.x.size() != n || (!curve.sigma.empty() && curve.sigma.size() != n)) {
    std::ostringstream text;
    text << "the columns differ in length: t " << n << ", X " << curve.x.size() << ", sigma "
         << curve.sigma.size();
    found.push_back(text.str());
    return found;
  }
  if (curve.n_realizations == 1 || curve.values.size() != n * curve.n_realizations) {
    std::ostringstream text;
    text << curve.values.size() << " values of " << curve.n_realizations << " realizations at " << n
         << " points: two or more realizations need a value each at every point";
    found.push_back(text.str());
    return found;
  }
  const auto not_finite = [](double value) { return !std::isfinite(value); };
  report(curve.t, "t is not finite", not_finite, found);
  report(curve.x, "X is not finite", not_finite, found);
  report(curve.sigma, "sigma is not finite", not_finite, found);
  report(curve.values, "a realization is not finite", not_finite, found);
  const auto extreme = [](double value) {
    return std::isfinite(value) && value != 0 &&
           !(std::abs(value) >= least_size && std::abs(value) <= largest_size);
  };
  report(
      curve.sigma,
      "sigma is beyond what squares can hold (allowed: 1e-120 to 1e120; choose a unit)",
      [&](double value) { return value > 0 && extreme(value); }, found);
  const auto size = [](double largest, double value) { return std::max(largest, std::abs(value)); };
  const double largest = std::accumulate(curve.x.begin(), curve.x.end(), 0.0, size);
  if (extreme(largest)) {
    std::ostringstream text;
    text << "X of at most " << largest
         << " is beyond what squares can hold (allowed: 1e-120 to 1e120); choose a unit";
    found.push_back(text.str());
  }
  const auto [least, most] = std::minmax_element(curve.sigma.begin(), curve.sigma.end());
  if (found.empty() && !curve.sigma.empty() && *least > 0 && largest > 0 &&
      (*most > widest_ratio * *least || largest > widest_ratio * *least ||
       *most > widest_ratio * largest)) {
    std::ostringstream text;
    text << "sigma from " << *least << " to " << *most << " and X of at most " << largest
         << " differ by more than a factor 1e30, and weigh nothing or everything: leave out the "
            "points that are not known, and give the others their errors";
    found.push_back(text.str());
  }
  report(
      curve.sigma, "sigma is not positive", [](double value) { return value <= 0; }, found);
  return found;
}

Curve restricted(const Curve& curve, double first, double last) {
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < curve.t.size(); ++i) {
    if (curve.t[i] >= first && curve.t[i] <= last) points.push_back(i);
  }
  return chosen(curve, points);
}

Curve thinned(const Curve& curve, std::size_t n) {
  if (curve.t.size() <= n) return curve;
  std::vector<std::size_t> order(curve.t.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return curve.t[a] < curve.t[b]; });
  const double first = curve.t[order.front()], last = curve.t[order.back()];
  const bool logarithmic = first > 0 && last > 100 * first;
  std::vector<std::size_t> points;
  std::size_t taken = order.size();  // the rank taken last
  for (std::size_t k = 0; k < n; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(n - 1);
    std::size_t rank = static_cast<std::size_t>(share * static_cast<double>(order.size() - 1));
    if (logarithmic) {
      const double wanted = first * std::pow(last / first, share) * (1 - 1e-12);
      const auto found = std::partition_point(order.begin(), order.end(),
                                              [&](std::size_t i) { return curve.t[i] < wanted; });
      rank =
          std::min<std::size_t>(static_cast<std::size_t>(found - order.begin()), order.size() - 1);
    }
    if (rank == taken) continue;
    taken = rank;
    points.push_back(order[rank]);
  }
  return chosen(curve, points);
}

}  // namespace jostle::inline fitting
