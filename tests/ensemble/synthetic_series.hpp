#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "engine/bed/random.hpp"

// Series with known answers.
namespace jostle::synthetic {

class Gaussian {
 public:
  explicit Gaussian(std::uint64_t seed, std::uint64_t realization = 0)
      : random_(stream_key(seed, 0, realization, Purpose::resampling)) {}

  double operator()() {
    const double radius = std::sqrt(-2 * std::log(random_.uniform()));
    return radius * std::cos(2 * std::numbers::pi * random_.uniform());
  }

 private:
  RandomStream random_;
};

/// x' = rho x + e with e of variance 1, stationary from the start.
inline std::vector<double> autoregressive(double rho, std::size_t n, std::uint64_t seed,
                                          std::uint64_t realization = 0) {
  Gaussian gaussian(seed, realization);
  std::vector<double> series{gaussian() / std::sqrt(1 - rho * rho)};
  while (series.size() < n) series.push_back(rho * series.back() + gaussian());
  return series;
}

inline std::vector<double> random_walk(std::size_t n, std::uint64_t seed,
                                       std::uint64_t realization = 0) {
  Gaussian gaussian(seed, realization);
  std::vector<double> series{0};
  while (series.size() < n) series.push_back(series.back() + gaussian());
  return series;
}

inline std::vector<double> with_ramp(std::vector<double> series, double change) {
  const auto n = static_cast<double>(series.size());
  for (std::size_t i = 0; i < series.size(); ++i) series[i] += change * static_cast<double>(i) / n;
  return series;
}

}  // namespace jostle::synthetic
