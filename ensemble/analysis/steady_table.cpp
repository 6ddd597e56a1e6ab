#include <fmt/format.h>

#include <cmath>

#include "engine/numbers.hpp"
#include "ensemble/analysis/analyses.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr const char* flyvbjerg_petersen = "Flyvbjerg & Petersen 1989, doi:10.1063/1.457480";
constexpr const char* wolff = "Wolff 2004, doi:10.1016/S0010-4655(03)00467-3";

Quantity single_value(std::string name, double value, std::string units, std::string long_name,
                      std::string source = "") {
  return {std::move(name),  {}, std::vector{value}, std::move(units), std::move(long_name),
          std::move(source)};
}

/// Over realizations, where that is known, and within series.
void add_errors(Table& table, const std::string& name, const Change& change,
                const std::string& units) {
  const char* const averaging = change.scatter_error.known() ? "standard error over realizations"
                                                             : "standard error within the series";
  for (const Quantity& quantity :
       {single_value(name + "_error", error_or_nan(change.error()), units, averaging),
        single_value(name + "_dof", change.error().dof, "1", "its degrees of freedom"),
        single_value(name + "_within_error", error_or_nan(change.series_error), units,
                     "standard error from the memory of each series about its line"),
        single_value(name + "_within_dof", change.series_error.dof, "1",
                     "its degrees of freedom")}) {
    table.quantities.push_back(quantity);
  }
}

void add_blocking(Table& table, const AnalysedSeries& series, const BlockingResult& blocking) {
  std::vector<std::uint64_t> lengths, counts;
  std::vector<double> errors, errors_of_errors;
  for (const BlockingLevel& level : blocking.levels) {
    lengths.push_back(level.block_length);
    counts.push_back(level.n_blocks);
    errors.push_back(level.error);
    errors_of_errors.push_back(level.error_error);
  }
  const std::vector<std::string> axes = {"block_length"};
  table.axes = {{"block_length", axes, lengths, "taps", "taps of a block", flyvbjerg_petersen}};
  table.quantities.insert(
      table.quantities.end(),
      {{"blocks", axes, counts, "1", "blocks of all realizations", ""},
       {"block_error", axes, errors, series.units, "error of the mean if blocks are independent",
        flyvbjerg_petersen},
       {"block_error_error", axes, errors_of_errors, series.units, "its own standard error", ""},
       single_value("block_error_dof", infinite, "1", "its degrees of freedom")});
}

SteadyState in_units_of(const AnalysedSeries& series, SteadyState state) {
  state.trend.units = series.units;
  return state;
}

}  // namespace

Table steady_table(const AnalysedSeries& series, const SteadyState& state) {
  const bool single = state.realizations == 1;
  const bool has_blocked_error = state.blocking.plateau && state.error.known();
  const AutocorrelationTime& time = state.autocorrelation;
  Table table{.name = "steady/" + series.observable, .axes = {}, .quantities = {}, .notes = {}};
  table.quantities = {
      single_value("value", state.value, series.units, "mean over taps and realizations"),
      single_value("value_error", error_or_nan(state.error), series.units,
                   !single ? "standard error over realizations"
                   : state.error.known()
                       ? "error from the memories that the taps of the one "
                         "realization allow, for Student's t of value_dof"
                       : "none: the taps are too few for the autocorrelation time"),
      single_value("value_dof", state.error.dof, "1", "degrees of freedom of value_error"),
      single_value("blocked_error", state.blocking.error(), series.units,
                   has_blocked_error ? "standard error by blocking, realizations pooled"
                                     : lower_bound + " of the error: too few blocks for the memory",
                   flyvbjerg_petersen),
      single_value("sigma", state.sigma, series.units,
                   time.found()
                       ? "deviation of single taps about the steady value of their realization"
                       : lower_bound +
                             " of the deviation of single taps about the steady value of their "
                             "realization: the taps are too few for their memory",
                   "Philippe & Bideau 2001, fig. 3"),
      single_value("sigma_error", error_or_nan(state.sigma_error), series.units, "standard error"),
      single_value("sigma_dof", state.sigma_error.dof, "1", "degrees of freedom of sigma_error"),
      single_value("realization_sigma", state.realization_sigma, series.units,
                   "deviation of the realizations' means, 1/(M - 1)"),
      single_value("autocorrelation_time", time.time, "taps",
                   time.found() ? "integrated, 1/2 for independent taps"
                                : lower_bound + ": too long for this number of taps",
                   wolff),
      single_value("autocorrelation_time_error", time.found() ? time.error : not_a_number, "taps",
                   "standard error", wolff),
      single_value("autocorrelation_time_dof", time.found() ? infinite : 0, "1",
                   "its degrees of freedom"),
      single_value("drift", state.trend.line.value, series.units,
                   "change of the mean over the taps, by a straight line")};
  add_errors(table, "drift", state.trend.line, series.units);
  table.quantities.push_back(single_value("halves_difference", state.trend.halves.value,
                                          series.units, "second half of the taps less the first"));
  add_errors(table, "halves_difference", state.trend.halves, series.units);
  table.quantities.push_back(single_value(
      "drift_p", state.trend.tests > 0 ? state.trend.p : not_a_number, "1",
      "p-value for no drift as the null hypothesis; tests of line and halves, Bonferroni"));
  table.quantities.push_back(single_value(
      "drift_detectable", state.trend.tests > 0 ? state.trend.detectable : not_a_number,
      series.units, "smallest change over the taps detected with 80 % power"));
  add_blocking(table, series, state.blocking);
  const std::string plateau =
      state.blocking.plateau
          ? fmt::format("from blocks of {} taps",
                        state.blocking.levels[*state.blocking.plateau].block_length)
          : "none, as the taps are too few for the autocorrelation time of the series";
  table.notes = {{"observable", series.observable},
                 {"taps", fmt::format("{} to {}", series.first_tap, series.last_tap)},
                 {"realizations", fmt::to_string(state.realizations)},
                 {"plateau", plateau},
                 {"verdict", in_units_of(series, state).statement()}};
  return table;
}

}  // namespace jostle::inline ensemble
