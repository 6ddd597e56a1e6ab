#include "ensemble/analysis/steady_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "ensemble/statistics/finite_text.hpp"
#include "ensemble/statistics/mean_error.hpp"
#include "fitting/intervals/distributions.hpp"

namespace jostle::inline ensemble {

namespace {

// Fewer independent values of one realization give no honest error, and no steady state.
constexpr double fewest_for_error = 4, fewest_for_verdict = 10;

// True if blocks without a plateau scatter by more than this error of the mean allows, as a slow
// memory beside a fast one does: F-test of the largest error by blocking, which is a lower bound.
bool is_below_blocking(const ErrorOf& error, const BlockingResult& blocking) {
  constexpr double level = 0.01;
  if (blocking.plateau || !error.known() || !(error.error > 0)) return false;
  const auto largest = std::ranges::max_element(blocking.levels, {}, &BlockingLevel::error);
  if (largest == blocking.levels.end()) return false;
  return fisher_tail(std::pow(largest->error / error.error, 2),
                     static_cast<double>(largest->n_blocks) - 1, error.dof) < level;
}

// The reason why the taps cannot decide; empty if they can.
std::string reasons_for_doubt(const SteadyState& state) {
  std::string reasons;
  const auto add = [&](const std::string& reason) {
    reasons += (reasons.empty() ? "" : "; ") + reason;
  };
  const auto n = static_cast<double>(state.n_taps);
  if (state.trend.tests == 0) {
    add(state.realizations == 1
            ? "one realization, too short for its autocorrelation time, cannot test for a drift"
            : "realizations that all change alike have no scatter to test a drift by");
  } else if (!(state.detectable() <= SteadyStateTest::largest_unseen)) {
    add(state.trend.power("only "));
  }
  if (!state.autocorrelation.found()) {
    add(finite_text(
        "{} taps are too few to estimate the autocorrelation time ({:.3g} taps or more)",
        state.n_taps, state.autocorrelation.time));
  } else if (n < SteadyStateTest::fewest_times * state.autocorrelation.time) {
    add(finite_text("{} taps are fewer than {} autocorrelation times ({:.3g} taps)", state.n_taps,
                    SteadyStateTest::fewest_times, state.autocorrelation.time));
  }
  if (state.realizations == 1 &&
      (state.independent_values < fewest_for_verdict || !state.error.known())) {
    add("the one realization remembers for as long as the taps");
  }
  return reasons;
}

// By the scatter of the variances of realizations, of one by Bartlett 1946 for a Gaussian process;
// and by the error of the autocorrelation time, which corrects the variance. None of a lower bound.
ErrorOf sigma_error(const SteadyState& state, const Moments& variances) {
  const AutocorrelationTime& memory = state.autocorrelation;
  const double dof = state.realizations == 1 ? std::numeric_limits<double>::infinity()
                                             : static_cast<double>(state.realizations) - 1;
  if (state.sigma == 0) return {0, dof};
  if (!memory.found()) return {};
  const double by_time = memory.variance_error / (2 * state.sigma);
  const auto n = static_cast<double>(state.n_taps * state.realizations);
  const double scatter = state.realizations == 1
                             ? state.sigma * std::sqrt((1 + 2 * memory.squares) / (2 * n))
                             : state.sigma * variances.standard_error() / (2 * variances.mean());
  return {std::hypot(scatter, by_time), dof};
}

// Means of neighbouring taps, at most 4096: an error of the mean needs no more.
std::vector<double> thinned(std::span<const double> series) {
  constexpr std::size_t most = 4096;
  const std::size_t length = (series.size() + most - 1) / most;
  std::vector<double> means;
  for (std::size_t i = 0; i + length <= series.size(); i += length) {
    const auto block = series.subspan(i, length);
    means.push_back(std::accumulate(block.begin(), block.end(), 0.0) / static_cast<double>(length));
  }
  return means;
}

}  // namespace

double SteadyState::detectable() const {
  return trend.detectable_in_sigma();
}

Verdict SteadyState::verdict() const {
  if (trend.drifts()) return Verdict::not_reached;
  return reasons_for_doubt(*this).empty() ? Verdict::reached : Verdict::cannot_decide;
}

std::string SteadyState::statement() const {
  switch (verdict()) {
    case Verdict::not_reached:
      return "not reached: " + trend.statement();
    case Verdict::reached:
      return "reached: " + trend.statement() + (trend.is_constant() ? "" : "; " + trend.power());
    case Verdict::cannot_decide:
      return fmt::format("cannot decide with {} realization{}: {}{}{}", realizations,
                         realizations == 1 ? "" : "s", trend.tests > 0 ? trend.statement() : "",
                         trend.tests > 0 ? ", but " : "", reasons_for_doubt(*this));
  }
  return {};
}

void SteadyStateTest::add(std::span<const double> series) {
  assert((n_taps_ == 0 || series.size() == n_taps_) && series.size() >= fewest_taps);
  n_taps_ = series.size();
  if (means_.count() == 0) only_ = thinned(series);
  Moments all;
  for (const double value : series) all.add(value);
  means_.add(all.mean());
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
                    .trend = trend_.result()};
  const auto realizations = static_cast<double>(state.realizations);
  const bool single = state.realizations == 1;
  if (single) {
    const MeanError found = mean_error(only_);
    state.error = found.error;
    state.independent_values = found.independent_values;
    if (state.independent_values < fewest_for_error ||
        is_below_blocking(found.error, state.blocking)) {
      state.error = {std::fmax(found.error.error, state.blocking.error()), 0};
    }
  } else {
    state.error = {means_.standard_error(), realizations - 1};
    state.independent_values = std::numeric_limits<double>::quiet_NaN();
  }
  state.realization_sigma = single ? std::numeric_limits<double>::quiet_NaN()
                                   : means_.standard_error() * std::sqrt(realizations);
  state.sigma = std::sqrt(state.autocorrelation.variance);
  state.sigma_error = sigma_error(state, variances_);
  return state;
}

}  // namespace jostle::inline ensemble
