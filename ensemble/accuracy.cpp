#include "ensemble/accuracy.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "ensemble/moments.hpp"

namespace jostle {

namespace {

double variance(const Moments& moments) {
  const double error = moments.standard_error();
  return error * error * static_cast<double>(moments.count());
}

double largest_bias(const Setting& setting) {
  return std::abs(setting.bias) + setting.bias_error;
}

}  // namespace

PairedBias paired_bias(std::span<const double> values, std::span<const double> reference) {
  assert(values.size() == reference.size());
  Moments difference, own, others;
  for (std::size_t r = 0; r < values.size(); ++r) {
    if (std::isnan(values[r]) || std::isnan(reference[r])) continue;
    difference.add(values[r] - reference[r]);
    own.add(values[r]);
    others.add(reference[r]);
  }
  return {.pairs = difference.count(),
          .bias = difference.mean(),
          .error = difference.standard_error(),
          .variance_reduction = (variance(own) + variance(others)) / variance(difference)};
}

double remainder(double two_before, double before, double last) {
  constexpr double slowest = 0.9;
  const double step = last - before, ratio = step / (before - two_before);
  return ratio > 0 && ratio < slowest ? step * ratio / (1 - ratio) : step;
}

double total_error(const Setting& setting, std::uint64_t realizations) {
  const double statistical = setting.sigma / std::sqrt(static_cast<double>(realizations));
  return std::hypot(largest_bias(setting), statistical);
}

std::optional<Choice> cheapest(std::span<const Setting> settings, double target) {
  std::optional<Choice> best;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const double bias = largest_bias(settings[i]);
    if (!(bias < target)) continue;
    const double left = target * target - bias * bias;
    const double realizations =
        std::max(2.0, std::ceil(settings[i].sigma * settings[i].sigma / left));
    const double seconds = realizations * settings[i].realization_seconds;
    if (!(realizations < 1e9) || (best && best->core_seconds <= seconds)) continue;
    best = {i, static_cast<std::uint64_t>(realizations), seconds};
  }
  return best;
}

std::vector<std::uint64_t> pareto_front(std::span<const Setting> settings) {
  std::vector<std::uint64_t> front;
  for (const Setting& one : settings) {
    const bool beaten = std::ranges::any_of(settings, [&](const Setting& other) {
      return largest_bias(other) < largest_bias(one) &&
             other.realization_seconds < one.realization_seconds;
    });
    front.push_back(!beaten && !std::isnan(largest_bias(one)));
  }
  return front;
}

}  // namespace jostle
