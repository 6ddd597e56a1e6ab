#include "ensemble/analysis/hysteresis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "ensemble/moments.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline ensemble {

namespace {

// Adds factor times the integral from low to high of straight lines through the values at
// strengths[steps], as weights of the values.
void add_integral(std::span<const double> strengths, std::vector<std::size_t> steps, double low,
                  double high, double factor, std::vector<double>& weights) {
  if (strengths[steps.front()] > strengths[steps.back()]) std::ranges::reverse(steps);
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    const double left = strengths[steps[i]], right = strengths[steps[i + 1]];
    const double begin = std::max(left, low), end = std::min(right, high);
    if (!(begin < end)) continue;
    const double share = (0.5 * (begin + end) - left) / (right - left);
    weights[steps[i]] += factor * (end - begin) * (1 - share);
    weights[steps[i + 1]] += factor * (end - begin) * share;
  }
}

Loop loop_between(std::span<const double> strengths, const std::vector<std::size_t>& earlier,
                  const std::vector<std::size_t>& later, std::span<const double> values,
                  std::uint32_t realizations) {
  const auto [low_1, high_1] = std::minmax(strengths[earlier.front()], strengths[earlier.back()]);
  const auto [low_2, high_2] = std::minmax(strengths[later.front()], strengths[later.back()]);
  Loop loop;
  loop.lowest = std::max(low_1, low_2);
  loop.highest = std::min(high_1, high_2);
  std::vector<double> weights(strengths.size(), 0.0);
  add_integral(strengths, later, loop.lowest, loop.highest, 1, weights);
  add_integral(strengths, earlier, loop.lowest, loop.highest, -1, weights);
  Moments areas;
  for (std::uint32_t r = 0; r < realizations; ++r) {
    double area = 0;
    for (std::size_t step = earlier.front(); step <= later.back(); ++step) {
      area += weights[step] * values[step * realizations + r];  // NaN where one is missing
    }
    areas.add(area);
  }
  loop.area = areas.mean();
  loop.realizations = areas.count();
  if (areas.count() > 1)
    loop.error = {areas.standard_error(), static_cast<double>(areas.count() - 1)};
  loop.p = p_value(loop.area, loop.error);
  return loop;
}

void add_steps(const ProtocolSteps& steps, Table& table) {
  const std::size_t n = steps.strengths.size();
  std::vector<std::uint64_t> index(n), branch(n), first_tap, last_tap;
  for (std::size_t i = 0; i < n; ++i) index[i] = i;
  const auto all = branches(steps.strengths);
  for (std::size_t b = all.size(); b-- > 0;) {  // a step at a turn counts to the branch it ends
    for (const std::size_t step : all[b]) branch[step] = b;
  }
  for (const StepTaps& window : steps.windows) {
    first_tap.push_back(window.first);
    last_tap.push_back(window.last);
  }
  table.axes.push_back({"step", {"step"}, std::move(index), "1", "step of the protocol", ""});
  const auto add = [&](const std::string& name, auto values, const std::string& units,
                       const char* meaning) {
    table.quantities.push_back({name, {"step"}, std::move(values), units, meaning, ""});
  };
  add(steps.control, steps.strengths, steps.units, "strength of the taps");
  add("branch", std::move(branch), "1", "branch, the next where the strength turns");
  add("first_tap", std::move(first_tap), "taps", "first tap of the mean");
  add("last_tap", std::move(last_tap), "taps", "last tap of the mean");
}

void add_values(const Column& observable, std::span<const double> values, std::size_t n_steps,
                std::uint32_t realizations, Table& table) {
  std::vector<double> means, errors, dof;
  std::vector<std::uint64_t> counts;
  for (std::size_t step = 0; step < n_steps; ++step) {
    Moments moments;
    for (const double value : values.subspan(step * realizations, realizations)) {
      moments.add(value);
    }
    means.push_back(moments.mean());
    errors.push_back(moments.standard_error());
    dof.push_back(moments.count() > 1 ? static_cast<double>(moments.count() - 1) : 0);
    counts.push_back(moments.count());
  }
  const auto add = [&](const std::string& suffix, auto column, const std::string& units,
                       const std::string& meaning) {
    table.quantities.push_back(
        {observable.name + suffix, {"step"}, std::move(column), units, meaning, observable.source});
  };
  add("", std::move(means), observable.units, observable.long_name + ", mean of the last taps");
  add("_error", std::move(errors), observable.units, "standard error over realizations");
  add("_dof", std::move(dof), "1", "degrees of freedom of the error");
  add("_count", std::move(counts), "1", "realizations that reached the step's end");
}

void add_loops(const std::vector<Loop>& all, const std::string& strength_units,
               const std::string& units, Table& table) {
  std::vector<std::uint64_t> index, earlier, later, counts;
  std::vector<double> lowest, highest, areas, errors, dof, p, corrected;
  std::vector<std::string> statements;
  for (const Loop& loop : all) {
    index.push_back(index.size());
    earlier.push_back(loop.earlier);
    later.push_back(loop.later);
    counts.push_back(loop.realizations);
    lowest.push_back(loop.lowest);
    highest.push_back(loop.highest);
    areas.push_back(loop.area);
    errors.push_back(error_or_nan(loop.error));
    dof.push_back(loop.error.dof);
    p.push_back(loop.p);
    corrected.push_back(loop.corrected);
    statements.push_back(loop.statement(units));
  }
  table.axes.push_back({"loop", {"loop"}, std::move(index), "1", "pair of branches", ""});
  const auto add = [&](const char* name, auto column, const std::string& unit,
                       const char* meaning) {
    table.quantities.push_back({name, {"loop"}, std::move(column), unit, meaning, ""});
  };
  add("earlier_branch", std::move(earlier), "1", "branch of the loop");
  add("later_branch", std::move(later), "1", "branch of the loop");
  add("lowest_strength", std::move(lowest), strength_units, "where the branches begin to overlap");
  add("highest_strength", std::move(highest), strength_units, "where they end to");
  add("area", std::move(areas), units,
      "integral over strength of the later branch less the earlier");
  add("area_error", std::move(errors), units, "standard error over realizations");
  add("area_dof", std::move(dof), "1", "degrees of freedom of area_error");
  add("area_p", std::move(p), "1", "p-value of no area, this loop alone, Student's t");
  add("area_p_corrected", std::move(corrected), "1",
      "the same for all loops together, Holm 1979, Scand. J. Statist. 6, 65");
  add("area_verdict", std::move(statements), "1", "whether the branches differ");
  add("area_count", std::move(counts), "1", "realizations that have all steps of both branches");
}

}  // namespace

std::vector<std::vector<std::size_t>> branches(std::span<const double> strengths) {
  if (strengths.empty()) return {};
  std::vector<std::vector<std::size_t>> all = {{0}};
  bool rising = false, known = false;
  for (std::size_t i = 1; i < strengths.size(); ++i) {
    if (strengths[i] != strengths[i - 1]) {
      const bool rises = strengths[i] > strengths[i - 1];
      if (known && rises != rising) {
        // If several steps have the strength of the turn, the last belongs to the way back alone.
        if (all.back().size() > 1 && strengths[i - 1] == strengths[i - 2]) all.back().pop_back();
        all.push_back({i - 1});
      }
      rising = rises;
      known = true;
    }
    all.back().push_back(i);
  }
  return all;
}

std::vector<Loop> loops(std::span<const double> strengths, std::span<const double> values,
                        std::uint32_t realizations) {
  assert(values.size() == strengths.size() * realizations);
  const auto all = branches(strengths);
  std::vector<Loop> found;
  for (std::size_t b = 1; b < all.size(); ++b) {
    found.push_back(loop_between(strengths, all[b - 1], all[b], values, realizations));
    found.back().earlier = b - 1;
    found.back().later = b;
  }
  std::vector<double> p;
  for (const Loop& loop : found) p.push_back(loop.p);
  p = corrected_for_number(p);
  for (std::size_t i = 0; i < found.size(); ++i) {
    Loop& loop = found[i];
    loop.corrected = p[i];
    const double level = Loop::level / static_cast<double>(found.size());
    loop.detectable = loop.error.known() && !std::isnan(loop.p)
                          ? loop.error.error * smallest_effect_found(level, loop.error.dof)
                          : std::numeric_limits<double>::infinity();
  }
  return found;
}

std::string Loop::statement(const std::string& units) const {
  if (!error.known()) {
    return fmt::format("cannot decide with {} realization{}: an area needs two for its error",
                       realizations, realizations == 1 ? "" : "s");
  }
  if (area == 0 && error.error == 0) {
    return fmt::format("the branches are equal in every realization, {} realizations",
                       realizations);
  }
  if (std::isnan(corrected)) {
    return finite_text(
        "cannot decide with {} realizations: the area is {:+.2g}{} in each, and without scatter it "
        "has no error",
        realizations, area, unit_behind(units));
  }
  if (corrected < level) {
    return finite_text("the branches differ: area {:+.2g}{} ({}, {} realizations)", area,
                       unit_behind(units), p_text(corrected), realizations);
  }
  return finite_text(
      "cannot decide with {} realizations: {}, only an area of {:.2g}{} or more would have been "
      "found with 80 %",
      realizations, p_text(corrected), detectable, unit_behind(units));
}

std::vector<double> step_values(const ProtocolSteps& steps, std::span<const double> series,
                                std::uint32_t realizations) {
  const std::uint64_t n_taps = series.size() / realizations;
  std::vector<double> values;
  for (const StepTaps& window : steps.windows) {
    if (window.last >= n_taps) {
      values.insert(values.end(), realizations, std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    const std::vector<double> means =
        means_over_rows(series.subspan(window.first * realizations,
                                       (window.last + 1 - window.first) * realizations),
                        realizations);
    values.insert(values.end(), means.begin(), means.end());
  }
  return values;
}

Table hysteresis_table(std::string name, const Column& observable, const ProtocolSteps& steps,
                       std::span<const double> values, std::uint32_t realizations) {
  Table table{.name = std::move(name)};
  add_steps(steps, table);
  add_values(observable, values, steps.strengths.size(), realizations, table);
  const std::vector<Loop> found = loops(steps.strengths, values, realizations);
  if (!found.empty()) {
    const std::string product = observable.units + " * " + steps.units;
    add_loops(found, steps.units,
              steps.units == "1"        ? observable.units
              : observable.units == "1" ? steps.units
                                        : product,
              table);
  }
  table.notes = {{"observable", observable.name},
                 {"control", steps.control},
                 {"branches", found.empty() ? "one: the strength does not turn, so there is no loop"
                                            : std::to_string(found.size() + 1)}};
  return table;
}

}  // namespace jostle::inline ensemble
