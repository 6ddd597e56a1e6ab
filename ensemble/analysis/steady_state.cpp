#include "ensemble/analysis/steady_state.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <limits>

namespace jostle::inline ensemble {

namespace {

// What keeps the taps from deciding; empty where nothing does.
std::string reasons_for_doubt(const SteadyState& state) {
  std::string reasons;
  const auto add = [&](const std::string& reason) {
    reasons += (reasons.empty() ? "" : "; ") + reason;
  };
  const auto n = static_cast<double>(state.n_taps);
  if (state.trend.tests == 0) {
    add("one realization, too short for its memory, tells nothing of a drift");
  } else if (!(state.detectable() <= SteadyStateTest::largest_unseen)) {
    add(fmt::format(
        "only a change of {:.2g} or more over the taps, {:.2g} deviations of single taps, "
        "would have been found with 80 %",
        state.trend.detectable, state.detectable()));
  }
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

double SteadyState::detectable() const {
  return trend.detectable == 0 ? 0 : trend.detectable / trend.sigma;
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
      return fmt::format(
          "reached: {}; a change of {:.2g} over the taps, {:.2g} deviations of single taps, would "
          "have been found with 80 %",
          trend.statement(), trend.detectable, detectable());
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
  const double blocks =
      state.blocking.plateau
          ? static_cast<double>(state.blocking.levels[*state.blocking.plateau].n_blocks)
          : 1;  // the error has a lower bound, and is not known
  state.error = single ? ErrorOf{state.blocking.error(), blocks - 1}
                       : ErrorOf{means_.standard_error(), realizations - 1};
  state.realization_sigma = single ? std::numeric_limits<double>::quiet_NaN()
                                   : means_.standard_error() * std::sqrt(realizations);
  state.sigma = std::sqrt(state.autocorrelation.variance);
  state.sigma_error = single || state.sigma == 0 ? sigma_error(state)
                                                 : variances_.standard_error() / (2 * state.sigma);
  state.sigma_dof = single ? std::numeric_limits<double>::infinity() : realizations - 1;
  return state;
}

}  // namespace jostle::inline ensemble
