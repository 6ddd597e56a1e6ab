#include "ensemble/analysis/volumes/volume_table.hpp"

#include <cmath>

#include "engine/numbers.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "ensemble/statistics/jackknife.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr const char* nowak = "Nowak et al. 1998, doi:10.1103/PhysRevE.57.1971";
constexpr const char* dean = "Dean & Lefevre 2003, doi:10.1103/PhysRevLett.90.198301";

/// Columns of a table along one axis.
class ColumnsAlong {
 public:
  ColumnsAlong(Table& table, std::string axis) : table_(table), axis_(std::move(axis)) {}

  void add(const std::string& name, auto values, const std::string& units,
           const std::string& meaning, const char* source = "") {
    table_.quantities.push_back({name, {axis_}, std::move(values), units, meaning, source});
  }
  /// With its error, degrees of freedom and 95 % interval.
  void add(const std::string& name, const std::vector<Jackknifed>& values, const std::string& units,
           const std::string& meaning, const char* source = "") {
    std::vector<double> value, error, dof, low, high;
    for (const Jackknifed& estimate : values) {
      value.push_back(estimate.value);
      error.push_back(error_or_nan(estimate.error));
      dof.push_back(estimate.error.dof);
      const double half = student_half_width(
          error.back(),
          estimate.error.known() ? static_cast<std::size_t>(estimate.error.dof) + 1 : 0,
          interval_levels[1]);
      low.push_back(estimate.value - half);
      high.push_back(estimate.value + half);
    }
    add(name, std::move(value), units, meaning, source);
    add(name + "_error", std::move(error), units, "standard error, jackknife over realizations");
    add(name + "_dof", std::move(dof), "1", "its degrees of freedom");
    add(name + "_low_95", std::move(low), units, "lower end of the 95 % interval, Student's t");
    add(name + "_high_95", std::move(high), units, "its upper end");
  }
  /// Variances, whose logarithm has the error.
  void add_variances(const std::string& name, const std::vector<LogEstimate>& values,
                     const std::string& units, const std::string& meaning) {
    std::vector<double> value, error, low_68, high_68, low, high;
    for (const LogEstimate& estimate : values) {
      value.push_back(estimate.value);
      error.push_back(estimate.error);
      low_68.push_back(estimate.low_68);
      high_68.push_back(estimate.high_68);
      low.push_back(estimate.low_95);
      high.push_back(estimate.high_95);
    }
    add(name, std::move(value), units, meaning, nowak);
    add(name + "_error", std::move(error), units,
        "standard error of ln of the value, jackknife over realizations, times the value");
    add(name + "_low_68", std::move(low_68), units,
        "lower end of the 68 % interval, Student's t of ln of the value");
    add(name + "_high_68", std::move(high_68), units, "its upper end");
    add(name + "_low_95", std::move(low), units,
        "lower end of the 95 % interval, Student's t of ln of the value");
    add(name + "_high_95", std::move(high), units, "its upper end");
  }

 private:
  Table& table_;
  std::string axis_;
};

Jackknifed mean_of(const SteadyVolumes& state) {
  Replicates means{state.mean(state.realizations()), {}};
  for (std::size_t r = 0; state.realizations() > 1 && r < state.realizations(); ++r)
    means.left_out.push_back(state.mean(r));
  return jackknifed(means);
}

LogEstimate scaled(const LogEstimate& estimate, double factor) {
  return {estimate.value * factor,   estimate.error * factor,  estimate.low_68 * factor,
          estimate.high_68 * factor, estimate.low_95 * factor, estimate.high_95 * factor};
}

void add_states(const Column& observable, const std::string& control, const std::string& units,
                const VolumeOf& volume_of, std::span<const VolumeState> states, Table& table) {
  ColumnsAlong columns(table, "state");
  std::vector<std::uint64_t> index, first, last;
  std::vector<double> strengths;
  std::vector<std::string> steady;
  std::vector<Jackknifed> means, volumes;
  std::vector<LogEstimate> variances, volume_variances;
  for (const VolumeState& state : states) {
    index.push_back(index.size());
    first.push_back(state.first_tap);
    last.push_back(state.last_tap);
    strengths.push_back(state.strength);
    SteadyState with_units = state.steady;
    with_units.trend.units = observable.units;
    steady.push_back(with_units.statement());
    means.push_back(mean_of(state.observable));
    variances.push_back(variance_of(state.observable));
    Jackknifed volume = mean_of(state.volumes);
    volume.value /= volume_of.spheres;
    volume.error.error /= volume_of.spheres;
    volumes.push_back(volume);
    volume_variances.push_back(scaled(variance_of(state.volumes), 1 / volume_of.spheres));
  }
  table.axes.push_back({"state", {"state"}, std::move(index), "1", "steady state", ""});
  columns.add(control, std::move(strengths), units, "strength of the taps");
  columns.add("first_tap", std::move(first), "taps", "first tap of the state");
  columns.add("last_tap", std::move(last), "taps", "last tap of the state");
  columns.add("steady", std::move(steady), "1", "verdict on the steady state");
  columns.add(observable.name, means, observable.units, observable.long_name);
  const std::string squared = observable.units == "1" ? "1" : observable.units + "^2";
  columns.add_variances("variance", variances, squared,
                        "variance over taps and realizations together, about their common mean; "
                        "the jackknife of its logarithm removes the bias");
  columns.add("volume", volumes, "sphere volumes", "volume per sphere, V/N");
  columns.add_variances("volume_variance", volume_variances, "sphere volumes^2",
                        "variance of V over N, which does not depend on N where parts of a bed "
                        "are independent");
}

void add_steps(std::span<const CompactivityStep> steps, std::span<const std::size_t> used,
               Table& table) {
  ColumnsAlong columns(table, "neighbours");
  std::vector<std::uint64_t> index, start, end;
  std::vector<double> separation, overlap;
  std::vector<Jackknifed> fluctuations, histograms, difference, bend;
  for (const CompactivityStep& step : steps) {
    index.push_back(index.size());
    start.push_back(used[step.start]);
    end.push_back(used[step.end]);
    separation.push_back(step.separation);
    overlap.push_back(step.overlap);
    fluctuations.push_back(jackknifed(step.fluctuations));
    const Jackknifed none{not_a_number, {}};
    histograms.push_back(step.overlaps ? jackknifed(step.histograms) : none);
    difference.push_back(step.overlaps ? jackknifed(difference_of(step)) : none);
    bend.push_back(step.overlaps ? jackknifed(step.curvature) : none);
  }
  const std::string per_volume = "1/sphere volumes";
  table.axes.push_back({"neighbours", {"neighbours"}, std::move(index), "1", "two states", ""});
  columns.add("from_state", std::move(start), "1", "the first of the two");
  columns.add("to_state", std::move(end), "1", "the second");
  columns.add("separation", std::move(separation), "1",
              "difference of the mean volumes over the geometric mean of the deviations");
  columns.add("overlap", std::move(overlap), "1",
              "sum over bins of the smaller share of the two histograms", dean);
  columns.add("step_fluctuations", fluctuations, per_volume,
              "change of 1/X, -(V_2 - V_1) / (s_1 s_2) with the deviations s of V", nowak);
  columns.add("step_histograms", histograms, per_volume,
              "change of 1/X, slope of ln(P_1/P_2) against V", dean);
  columns.add("step_difference", difference, per_volume, "histograms less fluctuations");
  columns.add("bend", bend, per_volume,
              "change of the slope of ln P_1/P_2 over a deviation; 0 with one density of states",
              dean);
}

}  // namespace

Table volume_table(std::string name, const Column& observable, const std::string& control,
                   const std::string& units, const VolumeOf& volume_of,
                   std::span<const VolumeState> states, const VolumeBins& bins) {
  Table table{.name = std::move(name)};
  add_states(observable, control, units, volume_of, states, table);
  std::vector<SteadyVolumes> steady;
  std::vector<std::size_t> used;
  std::string left_out;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i].used()) {
      steady.push_back(states[i].volumes);
      used.push_back(i);
    } else {
      left_out += finite_text("{}{:.4g}", left_out.empty() ? "" : ", ", states[i].strength);
    }
  }
  const std::vector<CompactivityStep> steps = compactivity_steps(steady, bins);
  ColumnsAlong columns(table, "state");
  const auto inverse_x = [&](const char* suffix, Replicates CompactivityStep::*estimator,
                             const char* meaning, const char* source) {
    std::vector<Jackknifed> all(states.size(), {not_a_number, {}});
    const std::vector<Jackknifed> found = inverse_compactivity(steps, estimator);
    for (std::size_t i = 0; i < used.size(); ++i) all[used[i]] = found[i];
    columns.add(std::string("inverse_x_") + suffix, all, "1/sphere volumes", meaning, source);
  };
  inverse_x("fluctuations", &CompactivityStep::fluctuations,
            "1/X less that of the first steady state, sum of step_fluctuations", nowak);
  inverse_x("histograms", &CompactivityStep::histograms,
            "1/X less that of the first steady state, sum of step_histograms", dean);
  add_steps(steps, used, table);
  table.notes = {{"observable", observable.name},
                 {"spheres", finite_text("{:.6g}", volume_of.spheres)},
                 {"realizations", std::to_string(states.front().volumes.realizations())}};
  if (!left_out.empty())
    table.notes.emplace_back("left_out", "not steady, at " + control + " " + left_out);
  const Jackknifed drift = drift_together(steady);
  const auto add_value = [&table](const char* quantity, double value, const char* meaning) {
    table.quantities.push_back({quantity, {}, std::vector{value}, "1", meaning, ""});
  };
  add_value(
      "drift_together", drift.value,
      "change of the volume over the taps of a state, in deviations of single taps, mean of those "
      "used");
  add_value("drift_together_error", error_or_nan(drift.error), "standard error over realizations");
  add_value("drift_together_dof", drift.error.dof, "its degrees of freedom");
  table.notes.emplace_back("verdict", used.size() < 2
                                          ? "cannot decide: fewer than two states are steady"
                                          : compactivity_verdict(steps, drift).statement);
  return table;
}

}  // namespace jostle::inline ensemble
