#include "ensemble/analysis/motion/motion_curves.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/numbers.hpp"
#include "ensemble/moments.hpp"
#include "ensemble/statistics/jackknife.hpp"
#include "ensemble/statistics/log_estimate.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr MeanEstimate no_mean{not_a_number, not_a_number, 0};
constexpr std::size_t n_directions = 3, x = 0, y = 1, z = 2;

template <class Value>
std::vector<double> by_realization(std::size_t n, const Value& value) {
  std::vector<double> row;
  for (std::size_t r = 0; r < n; ++r) row.push_back(value(r));
  return row;
}

/// <x^2> - <x>^2 of each realization, 0 where rounding made it negative; NaN where there is none.
std::vector<double> about_mean(std::span<const double> square, std::span<const double> mean) {
  return by_realization(mean.size(), [&](std::size_t r) {
    const double variance = square[r] - mean[r] * mean[r];
    return variance < 0 ? 0 : variance;
  });
}

/// Values of two rows where both have one.
struct Pairs {
  std::vector<double> first, second;
};
Pairs pairs(std::span<const double> first, std::span<const double> second) {
  Pairs found;
  for (std::size_t r = 0; r < first.size(); ++r) {
    if (std::isnan(first[r]) || std::isnan(second[r])) continue;
    found.first.push_back(first[r]);
    found.second.push_back(second[r]);
  }
  return found;
}

double sum(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// <fourth> / (gaussian <second>^2) - 1 of the means over realizations, with the jackknife's error;
/// no number where nothing moved. `gaussian`: the ratio that Gaussian displacements of so many
/// realizations have in the mean.
template <class Gaussian>
MeanEstimate non_gaussian(std::span<const double> fourth, std::span<const double> second,
                          const Gaussian& gaussian) {
  const Pairs moments = pairs(fourth, second);
  const std::size_t n = moments.first.size();
  const auto parameter = [&](double fourths, double seconds, std::size_t realizations) {
    const auto m = static_cast<double>(realizations);
    return seconds > 0 ? m * fourths / (seconds * seconds * gaussian(m)) - 1 : not_a_number;
  };
  const double fourths = sum(moments.first), seconds = sum(moments.second);
  const std::vector<double> left_out = by_realization(n > 1 ? n : 0, [&](std::size_t r) {
    return parameter(fourths - moments.first[r], seconds - moments.second[r], n - 1);
  });
  return {parameter(fourths, seconds, n), jackknife_error(left_out),
          std::max(0.0, static_cast<double>(n) - 1)};
}

}  // namespace

MeanEstimate mean_estimate(std::span<const double> row) {
  Moments moments;
  for (const double value : row) moments.add(value);
  return {moments.mean(), moments.standard_error(),
          std::max(0.0, static_cast<double>(moments.count()) - 1)};
}

std::vector<double> lateral_squares(const MotionRecords& records, std::size_t origin,
                                    std::size_t lag) {
  const auto along_x = records.row("square_displacement", origin, lag, x),
             along_y = records.row("square_displacement", origin, lag, y);
  return by_realization(along_x.size(), [&](std::size_t r) { return along_x[r] + along_y[r]; });
}

std::vector<double> vertical_squares(const MotionRecords& records, std::size_t origin,
                                     std::size_t lag) {
  return about_mean(records.row("square_displacement", origin, lag, z),
                    records.row("mean_displacement", origin, lag, z));
}

std::vector<double> layer_lateral_squares(const MotionRecords& records, std::size_t origin,
                                          std::size_t lag, std::size_t layer) {
  const auto row = [&](std::size_t direction) {
    return records.row("layer_square_displacement", origin, lag, n_directions * layer + direction);
  };
  const auto along_x = row(x), along_y = row(y);
  return by_realization(along_x.size(), [&](std::size_t r) { return along_x[r] + along_y[r]; });
}

std::vector<double> layer_vertical_squares(const MotionRecords& records, std::size_t origin,
                                           std::size_t lag, std::size_t layer) {
  return about_mean(records.row("layer_square_displacement", origin, lag, n_directions * layer + z),
                    records.row("layer_settling", origin, lag, layer));
}

MeanEstimate lateral_non_gaussian(const MotionRecords& records, std::size_t origin,
                                  std::size_t lag) {
  return non_gaussian(records.row("lateral_quartic", origin, lag),
                      lateral_squares(records, origin, lag), [](double) { return 2.0; });
}

MeanEstimate vertical_non_gaussian(const MotionRecords& records, std::size_t origin,
                                   std::size_t lag) {
  return non_gaussian(records.row("vertical_quartic", origin, lag),
                      vertical_squares(records, origin, lag), [](double) { return 3.0; });
}

MeanEstimate layer_lateral_non_gaussian(const MotionRecords& records, std::size_t origin,
                                        std::size_t lag, std::size_t layer) {
  const auto n =
      static_cast<double>(layer_sizes(records.n_spheres, records.settings.layers)[layer]);
  return non_gaussian(records.row("layer_lateral_quartic", origin, lag, layer),
                      layer_lateral_squares(records, origin, lag, layer),
                      [&](double m) { return 2 * n * m / (n * m + 1); });
}

MeanEstimate layer_vertical_non_gaussian(const MotionRecords& records, std::size_t origin,
                                         std::size_t lag, std::size_t layer) {
  const auto n =
      static_cast<double>(layer_sizes(records.n_spheres, records.settings.layers)[layer]);
  return non_gaussian(records.row("layer_vertical_quartic", origin, lag, layer),
                      layer_vertical_squares(records, origin, lag, layer),
                      [&](double m) { return 3 * (n - 1) * m / ((n - 1) * m + 2); });
}

std::vector<double> independent_susceptibility(const MotionRecords& records,
                                               std::string_view overlap, std::size_t origin,
                                               std::size_t lag, std::size_t length) {
  const std::size_t n_lengths = records.settings.overlap_lengths.size();
  const auto sizes = layer_sizes(records.n_spheres, records.settings.layers);
  std::vector<double> sums(records.n_realizations, 0.0);
  for (std::size_t layer = 0; layer < sizes.size(); ++layer) {
    if (sizes[layer] == 0) continue;
    const auto n = static_cast<double>(sizes[layer]);
    const auto row = records.row(overlap, origin, lag, n_lengths * layer + length);
    for (std::size_t r = 0; r < row.size(); ++r)
      sums[r] += n > 1 ? n * row[r] * (1 - row[r]) * n / (n - 1) : not_a_number;
  }
  for (double& sum : sums) sum /= records.n_spheres;
  return sums;
}

LogEstimate four_point_susceptibility(std::span<const double> overlaps, std::uint32_t n_spheres) {
  LogEstimate found = variance_estimate(overlaps);
  const double n = n_spheres, q = mean_estimate(overlaps).value;
  const double least = n * std::min(q, 1 - q), group = n * found.value / (q * (1 - q));
  if (!(least >= fewest_spheres && least >= 0.5 * group)) {
    const double value = found.value;
    found = no_estimate();
    found.value = value;
  }
  for (double LogEstimate::*field :
       {&LogEstimate::value, &LogEstimate::error, &LogEstimate::low_68, &LogEstimate::high_68,
        &LogEstimate::low_95, &LogEstimate::high_95})
    found.*field *= n;
  return found;
}

std::vector<double> kind_lateral_squares(const MotionRecords& records, std::size_t origin,
                                         std::size_t lag, std::size_t kind) {
  const auto row = [&](std::size_t direction) {
    return records.row("kind_square_displacement", origin, lag, n_directions * kind + direction);
  };
  const auto along_x = row(x), along_y = row(y);
  return by_realization(along_x.size(), [&](std::size_t r) { return along_x[r] + along_y[r]; });
}

std::vector<double> kind_rise(const MotionRecords& records, std::size_t origin, std::size_t lag,
                              std::size_t kind) {
  const auto kinds = records.row("kind_mean_displacement", origin, lag, n_directions * kind + z),
             bed = records.row("mean_displacement", origin, lag, z);
  return by_realization(bed.size(), [&](std::size_t r) { return kinds[r] - bed[r]; });
}

std::vector<double> kind_vertical_squares(const MotionRecords& records, std::size_t origin,
                                          std::size_t lag, std::size_t kind) {
  const std::size_t place = n_directions * kind + z;
  const auto square = records.row("kind_square_displacement", origin, lag, place),
             mean = records.row("kind_mean_displacement", origin, lag, place),
             bed = records.row("mean_displacement", origin, lag, z);
  return by_realization(bed.size(), [&](std::size_t r) {
    const double about_bed = square[r] - (2 * mean[r] - bed[r]) * bed[r];
    return about_bed < 0 ? 0 : about_bed;  // rounding
  });
}

namespace {

/// d ln <r^2> / d ln t of the squares of a lag, [n_realizations] of each lag.
template <class Squares>
MeanEstimate exponent_of(const std::vector<std::uint64_t>& lags, std::size_t lag,
                         const Squares& squares_at) {
  const auto later = std::ranges::lower_bound(lags, 2 * lags[lag]);
  const auto earlier = std::ranges::upper_bound(lags, lags[lag] / 2);
  if (later == lags.end() || earlier == lags.begin()) return no_mean;
  const auto early = static_cast<std::size_t>(earlier - lags.begin()) - 1,
             late = static_cast<std::size_t>(later - lags.begin());
  const Pairs squares = pairs(squares_at(early), squares_at(late));
  const double decades =
      std::log(static_cast<double>(lags[late]) / static_cast<double>(lags[early]));
  const double slope = std::log(sum(squares.second) / sum(squares.first)) / decades;
  if (!std::isfinite(slope)) return no_mean;
  const auto first = ln_means_without_one(squares.first),
             second = ln_means_without_one(squares.second);
  const std::vector<double> left_out =
      by_realization(first.size(), [&](std::size_t r) { return (second[r] - first[r]) / decades; });
  return {slope, jackknife_error(left_out),
          std::max(0.0, static_cast<double>(left_out.size()) - 1)};
}

}  // namespace

MeanEstimate lateral_exponent(const MotionRecords& records, std::size_t origin, std::size_t lag) {
  return exponent_of(records.settings.lags, lag,
                     [&](std::size_t index) { return lateral_squares(records, origin, index); });
}

MeanEstimate kind_lateral_exponent(const MotionRecords& records, std::size_t origin,
                                   std::size_t lag, std::size_t kind) {
  return exponent_of(records.settings.lags, lag, [&](std::size_t index) {
    return kind_lateral_squares(records, origin, index, kind);
  });
}

LogEstimate lateral_ratio(const MotionRecords& records, std::size_t origin, std::size_t lag) {
  if (origin == 0) return no_estimate();
  const Pairs squares =
      pairs(lateral_squares(records, origin, lag), lateral_squares(records, 0, lag));
  const MeanEstimate logarithm =
      mean_estimate(by_realization(squares.first.size(), [&](std::size_t r) {
        const double ratio = std::log(squares.first[r] / squares.second[r]);
        return std::isfinite(ratio) ? ratio : not_a_number;
      }));
  return log_estimate(std::exp(logarithm.value), {logarithm.error, logarithm.dof});
}

}  // namespace jostle::inline ensemble
