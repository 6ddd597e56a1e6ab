#include "study/cost/cost_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ensemble/moments.hpp"

namespace jostle {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

double deviation(std::span<const double> values) {
  Moments moments;
  for (const double value : values) moments.add(value);
  return moments.standard_error() * std::sqrt(static_cast<double>(moments.count()));
}

std::string part_name(Rung::Part part) {
  switch (part) {
    case Rung::Part::scene:
      return "scene";
    case Rung::Part::stop:
      return "stop";
    case Rung::Part::interval:
      return "interval";
    case Rung::Part::step:
      return "step";
    case Rung::Part::adaptation:
      return "adaptation";
    case Rung::Part::spheres:
      return "spheres";
    case Rung::Part::start:
      return "start";
  }
  return "";
}

void add_windows(const CostOfObservable& cost, Table& table) {
  if (cost.windows.empty()) return;
  std::vector<std::string> names;
  std::vector<double> differences, errors;
  for (const WindowEffect& one : cost.windows) {
    names.push_back(one.name);
    differences.push_back(one.difference.bias);
    errors.push_back(one.difference.error);
  }
  const std::vector<std::string> window = {"window"};
  const std::string& units = cost.label.units;
  table.axes.push_back({"window", window, names, "1", "another window", ""});
  table.quantities.insert(
      table.quantities.end(),
      {{"window_difference", window, differences, units, "less the scene's window", ""},
       {"window_difference_error", window, errors, units, "standard error over rounds", ""}});
}

std::string window_name(const Window& window) {
  if (const auto* heights = std::get_if<HeightWindow>(&window)) {
    return fmt::format("heights {:g} to {:g}", heights->low, heights->high);
  }
  const auto& quantiles = std::get<QuantileWindow>(window);
  return fmt::format("quantiles {:g} to {:g}", quantiles.low, quantiles.high);
}

}  // namespace

CostStudy::CostStudy(const ResultsFile& file, std::vector<Rung> rungs,
                     std::vector<OtherWindow> windows, std::uint64_t taps)
    : rungs_(std::move(rungs)),
      windows_(std::move(windows)),
      taps_(taps),
      pilot_taps_(file.study().points.front().taps),
      rounds_(file.study().realizations) {
  read_times(file);
  for (const Column& label : file.study().points.front().observables) {
    observables_.push_back(read_observable(file, label));
  }
}

void CostStudy::read_times(const ResultsFile& file) {
  std::vector<Work> work(rungs_.size());  // of all realizations that did not fail
  std::vector<double> done(rungs_.size());
  for (const RealizationSummary& one : file.realizations()) {
    if (one.status == RealizationStatus::failed) {
      failed_.push_back(one);
      continue;
    }
    work[one.id.point] += one.work;
    ++done[one.id.point];
  }
  const std::uint64_t first = pilot_taps_ / 2 + 1;  // of the second half
  for (std::uint32_t p = 0; p < rungs_.size(); ++p) {
    const std::vector<double> sweeps =
        file.block(p, sweeps_column, {1, pilot_taps_ + 1}, {0, file.study().realizations});
    Moments all, late;
    for (std::size_t i = 0; i < sweeps.size(); ++i) {
      all.add(sweeps[i]);
      if (1 + i / rounds_ >= first) late.add(sweeps[i]);
    }
    const double of_a_tap =
        (work[p].seconds - work[p].start_seconds) / (static_cast<double>(pilot_taps_) * done[p]);
    times_.push_back({.start_seconds = work[p].start_seconds / done[p],
                      .tap_seconds = of_a_tap * late.mean() / all.mean(),
                      .sweeps = late.mean()});
  }
}

double CostStudy::realization_seconds(std::size_t rung) const {
  return times_[rung].start_seconds + times_[rung].tap_seconds * static_cast<double>(taps_);
}

CostOfObservable CostStudy::read_observable(const ResultsFile& file, const Column& label) const {
  CostOfObservable cost;
  cost.label = label;
  std::vector<std::vector<double>> values;  // [n_rungs][n_taps, n_rounds]
  for (std::uint32_t p = 0; p < rungs_.size(); ++p) {
    values.push_back(file.block(p, label.name, {1, pilot_taps_ + 1}, {0, rounds_}));
  }
  const auto at = [&](std::size_t rung, std::uint64_t tap) {
    return std::span(values[rung]).subspan((tap - 1) * rounds_, rounds_);
  };
  const MostComplete best = most_complete(rungs_);
  for (std::size_t p = 0; p < rungs_.size(); ++p) {
    for (std::uint64_t tap = 1; tap <= pilot_taps_; ++tap) {
      const PairedBias bias = paired_bias(at(p, tap), at(best.last, tap));
      cost.bias_by_tap.push_back(bias.bias);
      cost.bias_error_by_tap.push_back(bias.error);
      if (tap == pilot_taps_) cost.biases.push_back(bias);
    }
    // Another start is another bed, not another accuracy: never recommended.
    const bool is_choice = rungs_[p].part != Rung::Part::start;
    cost.settings.push_back({.bias = is_choice ? cost.biases.back().bias : not_a_number,
                             .bias_error = cost.biases.back().error,
                             .sigma = deviation(at(p, pilot_taps_)),
                             .realization_seconds = realization_seconds(p)});
  }
  for (std::size_t p = 0; p < rungs_.size() && middle_tap() > 0; ++p) {
    cost.growths.push_back(bias_growth(at(p, middle_tap()), at(best.last, middle_tap()),
                                       at(p, pilot_taps_), at(best.last, pilot_taps_)));
  }
  cost.windows = read_windows(file, label.name);
  cost.last_step = paired_bias(at(best.last, pilot_taps_), at(best.before, pilot_taps_));
  cost.remainder =
      is_seen(cost.last_step)
          ? remainder(at(0, pilot_taps_), at(best.before, pilot_taps_), at(best.last, pilot_taps_))
          : Remainder{not_a_number, not_a_number};
  return cost;
}

std::vector<WindowEffect> CostStudy::read_windows(const ResultsFile& file,
                                                  const std::string& of) const {
  std::vector<WindowEffect> effects;
  const TapRange last{pilot_taps_, pilot_taps_ + 1};
  for (const OtherWindow& other : windows_) {
    if (other.of != of) continue;
    const std::vector<double> own = file.block(0, of, last, {0, rounds_});
    effects.push_back({window_name(other.observable.window),
                       paired_bias(file.block(0, other.observable.name, last, {0, rounds_}), own)});
  }
  return effects;
}

std::vector<Table> CostStudy::tables(std::uint32_t scene_realizations) const {
  std::vector<std::string> names, parts;
  std::vector<std::uint64_t> taps(pilot_taps_);
  for (std::uint64_t t = 0; t < pilot_taps_; ++t) taps[t] = t + 1;
  std::vector<double> tap_seconds, start_seconds, sweeps, core_hours;
  for (std::size_t p = 0; p < rungs_.size(); ++p) {
    names.push_back(rungs_[p].name);
    parts.push_back(part_name(rungs_[p].part));
    tap_seconds.push_back(times_[p].tap_seconds);
    start_seconds.push_back(times_[p].start_seconds);
    sweeps.push_back(times_[p].sweeps);
    core_hours.push_back(realization_seconds(p) * scene_realizations / 3600);
  }
  std::vector<Table> tables;
  const std::vector<std::string> rung = {"rung"}, by_tap = {"rung", "tap"};
  for (const CostOfObservable& cost : observables_) {
    std::vector<double> bias, error, reduction, sigma, statistical;
    for (std::size_t p = 0; p < rungs_.size(); ++p) {
      bias.push_back(cost.biases[p].bias);
      error.push_back(cost.biases[p].error);
      reduction.push_back(cost.biases[p].variance_reduction);
      sigma.push_back(cost.settings[p].sigma);
      statistical.push_back(sigma.back() / std::sqrt(static_cast<double>(scene_realizations)));
    }
    std::vector<double> growth, growth_error, growth_tails;
    for (const Growth& one : cost.growths) {
      growth.push_back(one.change.bias);
      growth_error.push_back(one.change.error);
      growth_tails.push_back(one.tails);
    }
    const std::string& units = cost.label.units;
    Table table{.name = "cost/" + cost.label.name};
    table.axes = {{"rung", rung, names, "1", "setting", ""},
                  {"tap", {"tap"}, taps, "taps", "tap of the pilot", ""}};
    table.quantities = {
        {"part", rung, parts, "1", "what differs from the scene", ""},
        {"bias", rung, bias, units, "less the most complete rung, paired", ""},
        {"bias_error", rung, error, units, "standard error over rounds", ""},
        {"variance_reduction", rung, reduction, "1", "by pairing, of the difference", ""},
        {"sigma", rung, sigma, units, "deviation between realizations", ""},
        {"statistical_error", rung, statistical, units, "with the scene's realizations", ""},
        {"sweeps_per_tap", rung, sweeps, "1", "sweeps of a late tap of the pilot", ""},
        {"tap_seconds", rung, tap_seconds, "s", "core time of such a tap", ""},
        {"start_seconds", rung, start_seconds, "s", "core time of a start", ""},
        {"core_hours", rung, core_hours, "h", "of the scene's realizations, all taps", ""},
        {"pareto", rung, pareto_front(cost.settings), "1", "1: no rung is better and faster", ""},
        {"bias_by_tap", by_tap, cost.bias_by_tap, units, "likewise, after each tap", ""},
        {"bias_by_tap_error", by_tap, cost.bias_error_by_tap, units, "standard error", ""},
        {"last_step",
         {},
         std::vector{cost.last_step.bias},
         units,
         "the most complete rung less the one before",
         ""},
        {"last_step_error", {}, std::vector{cost.last_step.error}, units, "standard error", ""},
        {"remainder",
         {},
         std::vector{cost.remainder.value},
         units,
         "that the most complete rung still lacks, extrapolated where the last step is seen",
         ""},
        {"remainder_error",
         {},
         std::vector{cost.remainder.error},
         units,
         "jackknife over rounds",
         ""}};
    if (!cost.growths.empty()) {
      table.quantities.insert(
          table.quantities.end(),
          {{"growth", rung, growth, units, "of the bias, from the middle tap to the last", ""},
           {"growth_error", rung, growth_error, units, "standard error over rounds", ""},
           {"growth_tails", rung, growth_tails, "1", "probability by chance, Student's t", ""}});
    }
    add_windows(cost, table);
    table.notes = {{"observable", cost.label.name},
                   {"reference", rungs_[most_complete(rungs_).last].name},
                   {"rounds", fmt::to_string(rounds_)},
                   {"middle_tap", fmt::to_string(middle_tap())},
                   {"scene_realizations", fmt::to_string(scene_realizations)},
                   {"scene_taps", fmt::to_string(taps_)}};
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace jostle
