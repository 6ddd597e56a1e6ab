#include "ensemble/steady_state.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <limits>

#include "fitting/distributions.hpp"

namespace jostle {

namespace {

constexpr double significance = 0.0027;  // 3 standard errors of a normal variable

Difference halves_of(const Moments& differences, const BlockingResult& blocking) {
  Difference halves{.value = differences.mean()};
  double dof = static_cast<double>(differences.count()) - 1;
  halves.error = differences.standard_error();
  if (differences.count() == 1) {
    // Each half has twice the variance of the whole.
    halves.error = 2 * blocking.error();
    dof =
        blocking.plateau ? static_cast<double>(blocking.levels[*blocking.plateau].n_blocks) - 1 : 1;
  }
  if (halves.value == 0) return halves;
  halves.tails = halves.error > 0 ? student_tails(halves.value / halves.error, dof) : 0;
  return halves;
}

std::string reasons_against(const SteadyState& state) {
  std::string reasons;
  const auto add = [&](const std::string& reason) {
    reasons += (reasons.empty() ? "" : "; ") + reason;
  };
  if (state.trend.drifts()) {
    add(fmt::format("it drifts: {:+.2g} over {} taps, error {:.1g}", state.trend.change,
                    state.n_taps, state.trend.slope_error * static_cast<double>(state.n_taps)));
  }
  if (state.halves.tails < significance) {
    add(fmt::format("its halves differ by {:.2g}, error {:.1g}", state.halves.value,
                    state.halves.error));
  }
  const auto n = static_cast<double>(state.n_taps);
  if (!state.autocorrelation.found() ||
      n < SteadyStateTest::fewest_times * state.autocorrelation.time) {
    add(fmt::format("{} taps are fewer than {} autocorrelation times ({:.3g} taps{})", state.n_taps,
                    SteadyStateTest::fewest_times, state.autocorrelation.time,
                    state.autocorrelation.found() ? "" : " or more"));
  }
  if (state.realizations == 1 && !state.blocking.plateau) {
    add("the blocking error of the one realization has no plateau");
  }
  return reasons;
}

// Of a Gaussian process: Bartlett 1946.
double sigma_error(const SteadyState& state) {
  const auto n = static_cast<double>(state.n_taps * state.realizations);
  return state.sigma * std::sqrt((1 + 2 * state.autocorrelation.squares) / (2 * n));
}

}  // namespace

void SteadyStateTest::add(std::span<const double> series) {
  assert((n_taps_ == 0 || series.size() == n_taps_) && series.size() >= fewest_taps);
  n_taps_ = series.size();
  Moments all, first, second;
  for (const double value : series) all.add(value);
  for (const double value : series.first(n_taps_ / 2)) first.add(value);
  for (const double value : series.last(n_taps_ / 2)) second.add(value);
  means_.add(all.mean());
  halves_.add(second.mean() - first.mean());
  variances_.add(all.sigma() * all.sigma());
  blocking_.add(series);
  autocorrelation_.add(series);
  trend_.add(series);
}

SteadyState SteadyStateTest::result() const {
  assert(n_taps_ > 0);
  SteadyState state{.n_taps = n_taps_,
                    .realizations = means_.count(),
                    .value = means_.mean(),
                    .blocking = blocking_.result(),
                    .autocorrelation = autocorrelation_.result(),
                    .trend = trend_.result(),
                    .halves = {},
                    .reasons_against = {}};
  const auto realizations = static_cast<double>(state.realizations);
  const bool single = state.realizations == 1;
  state.error = single ? state.blocking.error() : means_.standard_error();
  state.realization_sigma = single ? std::numeric_limits<double>::quiet_NaN()
                                   : means_.standard_error() * std::sqrt(realizations);
  state.sigma = std::sqrt(state.autocorrelation.variance);
  state.sigma_error = single || state.sigma == 0 ? sigma_error(state)
                                                 : variances_.standard_error() / (2 * state.sigma);
  state.halves = halves_of(halves_, state.blocking);
  state.reasons_against = reasons_against(state);
  return state;
}

}  // namespace jostle
