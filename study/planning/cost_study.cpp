#include "study/planning/cost_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/numbers.hpp"
#include "ensemble/moments.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline study {

namespace {

double degrees_of_freedom(std::size_t pairs) {
  return pairs > 0 ? static_cast<double>(pairs - 1) : 0;
}

double deviation(std::span<const double> values) {
  Moments moments;
  for (const double value : values) moments.add(value);
  return moments.standard_error() * std::sqrt(static_cast<double>(moments.count()));
}

std::size_t number_of(std::span<const double> values) {
  return static_cast<std::size_t>(
      std::ranges::count_if(values, [](double value) { return !std::isnan(value); }));
}

std::string part_name(PilotSetting::Part part) {
  switch (part) {
    case PilotSetting::Part::scene:
      return "scene";
    case PilotSetting::Part::stop:
      return "stop";
    case PilotSetting::Part::interval:
      return "interval";
    case PilotSetting::Part::step:
      return "step";
    case PilotSetting::Part::adaptation:
      return "adaptation";
    case PilotSetting::Part::stiffness:
      return "stiffness";
    case PilotSetting::Part::spheres:
      return "spheres";
    case PilotSetting::Part::start:
      return "start";
  }
  return "";
}

void add_windows(const CostOfObservable& cost, Table& table) {
  if (cost.windows.empty()) return;
  std::vector<std::string> names;
  std::vector<double> differences, errors, dof;
  for (const WindowEffect& effect : cost.windows) {
    names.push_back(effect.name);
    differences.push_back(effect.difference.bias);
    errors.push_back(effect.difference.error);
    dof.push_back(degrees_of_freedom(effect.difference.pairs));
  }
  const std::vector<std::string> window = {"window"};
  const std::string& units = cost.label.units;
  table.axes.push_back({"window", window, names, "1", "another window", ""});
  table.quantities.insert(
      table.quantities.end(),
      {{"window_difference", window, differences, units, "less the scene's window", ""},
       {"window_difference_error", window, errors, units, "standard error over replicates", ""},
       {"window_difference_dof", window, dof, "1", "its degrees of freedom", ""}});
}

std::string window_name(const BulkFraction& bulk) {
  const std::string taper = bulk.taper > 0 ? finite_text(", tapered over {:g}", bulk.taper) : "";
  if (const auto* heights = std::get_if<HeightWindow>(&bulk.window)) {
    return finite_text("heights {:g} to {:g}{}", heights->low, heights->high, taper);
  }
  const auto& quantiles = std::get<QuantileWindow>(bulk.window);
  return finite_text("quantiles {:g} to {:g}{}", quantiles.low, quantiles.high, taper);
}

/// Possible bias of the most complete setting.
double doubt_of_reference(const CostOfObservable& cost) {
  if (!is_seen(cost.last_step)) return cost.last_step.error;
  return std::isfinite(cost.remainder.error) ? std::abs(cost.remainder.value) + cost.remainder.error
                                             : std::abs(cost.last_step.bias) + cost.last_step.error;
}

}  // namespace

CostStudy::CostStudy(const ResultsFile& file, std::vector<PilotSetting> settings,
                     std::vector<OtherWindow> windows, std::uint64_t taps)
    : settings_(std::move(settings)),
      windows_(std::move(windows)),
      taps_(taps),
      pilot_taps_(file.study().points.front().taps),
      replicates_(file.study().realizations) {
  read_times(file);
  for (const Column& label : file.study().points.front().observables) {
    observables_.push_back(read_observable(file, label));
  }
}

void CostStudy::read_times(const ResultsFile& file) {
  std::vector<Work> work(settings_.size());  // time of all realizations that did not fail
  std::vector<double> done(settings_.size());
  for (const RealizationSummary& realization : file.realizations()) {
    if (realization.status == RealizationStatus::failed) {
      failed_.push_back(realization);
      continue;
    }
    work[realization.id.point] += realization.work;
    ++done[realization.id.point];
  }
  const std::uint64_t first = pilot_taps_ / 2 + 1;  // first tap of the second half
  for (std::uint32_t p = 0; p < settings_.size(); ++p) {
    const std::vector<double> work_by_tap = file.block(
        p, work_column(settings_[p].engine), {1, pilot_taps_ + 1}, {0, file.study().realizations});
    Moments all, late;
    for (std::size_t i = 0; i < work_by_tap.size(); ++i) {
      all.add(work_by_tap[i]);
      if (1 + i / replicates_ >= first) late.add(work_by_tap[i]);
    }
    const double of_a_tap =
        (work[p].seconds - work[p].start_seconds) / (static_cast<double>(pilot_taps_) * done[p]);
    times_.push_back({.start_seconds = work[p].start_seconds / done[p],
                      .tap_seconds = of_a_tap * late.mean() / all.mean(),
                      .work = late.mean()});
  }
}

std::string CostStudy::work_name() const {
  return jostle::work_name(settings_.front().engine);
}

double CostStudy::realization_seconds(std::size_t setting) const {
  return times_[setting].start_seconds + times_[setting].tap_seconds * static_cast<double>(taps_);
}

std::vector<std::uint64_t> CostStudy::has_beds() const {
  std::vector<std::uint64_t> has;
  for (const PilotSetting& setting : settings_) {
    has.push_back(setting.part != PilotSetting::Part::start &&
                  setting.part != PilotSetting::Part::spheres);
  }
  return has;
}

CostOfObservable CostStudy::read_observable(const ResultsFile& file, const Column& label) const {
  CostOfObservable cost;
  cost.label = label;
  std::vector<std::vector<double>> values;  // [n_settings][n_taps, n_replicates]
  for (std::uint32_t p = 0; p < settings_.size(); ++p) {
    values.push_back(file.block(p, label.name, {1, pilot_taps_ + 1}, {0, replicates_}));
  }
  const auto value_at = [&](std::size_t setting, std::uint64_t tap) {
    return std::span(values[setting]).subspan((tap - 1) * replicates_, replicates_);
  };
  const MostComplete best = most_complete(settings_);
  for (std::size_t p = 0; p < settings_.size(); ++p) {
    for (std::uint64_t tap = 1; tap <= pilot_taps_; ++tap) {
      const PairedBias bias = paired_bias(value_at(p, tap), value_at(best.last, tap));
      cost.bias_by_tap.push_back(bias.bias);
      cost.bias_error_by_tap.push_back(bias.error);
      if (tap == pilot_taps_) cost.biases.push_back(bias);
    }
    // Another start is another bed, not another accuracy: never recommended.
    const bool is_choice = settings_[p].part != PilotSetting::Part::start;
    cost.setting_costs.push_back({.bias = is_choice ? cost.biases.back().bias : not_a_number,
                                  .bias_error = cost.biases.back().error,
                                  .sigma = deviation(value_at(p, pilot_taps_)),
                                  .realization_seconds = realization_seconds(p),
                                  .values = number_of(value_at(p, pilot_taps_)),
                                  .pairs = cost.biases.back().pairs});
  }
  for (std::size_t p = 0; p < settings_.size() && middle_tap() > 0; ++p) {
    cost.growths.push_back(bias_growth(value_at(p, middle_tap()), value_at(best.last, middle_tap()),
                                       value_at(p, pilot_taps_), value_at(best.last, pilot_taps_)));
  }
  cost.windows = read_windows(file, label.name);
  cost.last_step =
      paired_bias(value_at(best.last, pilot_taps_), value_at(best.second_last, pilot_taps_));
  cost.remainder = is_seen(cost.last_step) ? remainder(value_at(0, pilot_taps_),
                                                       value_at(best.second_last, pilot_taps_),
                                                       value_at(best.last, pilot_taps_))
                                           : Remainder{0, not_a_number, not_a_number};
  const Pilot pilot{
      .reference = best.last,
      .last_step = cost.last_step,
      .step_before = paired_bias(value_at(best.second_last, pilot_taps_), value_at(0, pilot_taps_)),
      .has_beds = has_beds()};
  pool_sigma(cost.setting_costs, pilot);
  cost.limits = at_limits(cost.setting_costs, pilot);
  cost.setting_costs[best.last].bias_error = doubt_of_reference(cost);
  return cost;
}

std::vector<WindowEffect> CostStudy::read_windows(const ResultsFile& file,
                                                  const std::string& observable) const {
  std::vector<WindowEffect> effects;
  const TapRange last{pilot_taps_, pilot_taps_ + 1};
  for (const OtherWindow& window : windows_) {
    if (window.name != observable) continue;
    const std::vector<double> own = file.block(0, observable, last, {0, replicates_});
    effects.push_back(
        {window_name(window.observable),
         paired_bias(file.block(0, window.observable.name, last, {0, replicates_}), own)});
  }
  return effects;
}

std::vector<Table> CostStudy::tables(std::uint32_t scene_realizations) const {
  std::vector<std::string> names, parts;
  std::vector<std::uint64_t> taps(pilot_taps_);
  for (std::uint64_t t = 0; t < pilot_taps_; ++t) taps[t] = t + 1;
  std::vector<double> tap_seconds, start_seconds, work, core_hours;
  for (std::size_t p = 0; p < settings_.size(); ++p) {
    names.push_back(settings_[p].name);
    parts.push_back(part_name(settings_[p].part));
    tap_seconds.push_back(times_[p].tap_seconds);
    start_seconds.push_back(times_[p].start_seconds);
    work.push_back(times_[p].work);
    core_hours.push_back(realization_seconds(p) * scene_realizations / 3600);
  }
  std::string work_quantity = work_name() + "_per_tap";
  std::ranges::replace(work_quantity, ' ', '_');
  std::vector<Table> tables;
  const std::vector<std::string> setting = {"setting"}, by_tap = {"setting", "tap"};
  for (const CostOfObservable& cost : observables_) {
    std::vector<double> bias, error, dof, reduction, sigma, statistical;
    for (std::size_t p = 0; p < settings_.size(); ++p) {
      bias.push_back(cost.biases[p].bias);
      error.push_back(cost.biases[p].error);
      dof.push_back(degrees_of_freedom(cost.biases[p].pairs));
      reduction.push_back(cost.biases[p].variance_reduction);
      sigma.push_back(cost.setting_costs[p].sigma);
      statistical.push_back(sigma.back() / std::sqrt(static_cast<double>(scene_realizations)));
    }
    std::vector<double> growth, growth_error, growth_dof, growth_tails;
    for (const Growth& change : cost.growths) {
      growth.push_back(change.change.bias);
      growth_error.push_back(change.change.error);
      growth_dof.push_back(degrees_of_freedom(change.change.pairs));
      growth_tails.push_back(change.tails);
    }
    const std::string& units = cost.label.units;
    Table table{.name = "cost/" + cost.label.name};
    table.axes = {{"setting", setting, names, "1", "setting", ""},
                  {"tap", {"tap"}, taps, "taps", "tap of the pilot", ""}};
    table.quantities = {
        {"part", setting, parts, "1", "what differs from the scene", ""},
        {"bias", setting, bias, units, "less the most complete setting, paired", ""},
        {"bias_error", setting, error, units, "standard error over replicates", ""},
        {"bias_dof", setting, dof, "1", "degrees of freedom of bias_error", ""},
        {"variance_reduction", setting, reduction, "1", "by pairing, of the difference", ""},
        {"sigma", setting, sigma, units,
         "deviation between realizations, pooled over the settings that share their beds", ""},
        {"statistical_error", setting, statistical, units, "with the scene's realizations", ""},
        {work_quantity, setting, work, "1", work_name() + " of a late tap of the pilot", ""},
        {"tap_seconds", setting, tap_seconds, "s", "core time of such a tap", ""},
        {"start_seconds", setting, start_seconds, "s", "core time of a start", ""},
        {"core_hours", setting, core_hours, "h", "of the scene's realizations, all taps", ""},
        {"pareto", setting, pareto_front(cost.setting_costs), "1",
         "1: no setting is better and faster", ""},
        {"bias_by_tap", by_tap, cost.bias_by_tap, units, "likewise, after each tap", ""},
        {"bias_by_tap_error", by_tap, cost.bias_error_by_tap, units, "standard error", ""},
        {"last_step",
         {},
         std::vector{cost.last_step.bias},
         units,
         "the most complete setting less the one before",
         ""},
        {"last_step_error", {}, std::vector{cost.last_step.error}, units, "standard error", ""},
        {"last_step_dof",
         {},
         std::vector{degrees_of_freedom(cost.last_step.pairs)},
         "1",
         "its degrees of freedom",
         ""},
        {"remainder",
         {},
         std::vector{cost.remainder.value},
         units,
         "bias of the most complete setting, extrapolated where the last step is detected",
         ""},
        {"remainder_error",
         {},
         std::vector{cost.remainder.error},
         units,
         "jackknife over replicates",
         ""},
        {"remainder_dof",
         {},
         std::vector{degrees_of_freedom(cost.remainder.realizations)},
         "1",
         "its degrees of freedom",
         ""}};
    if (!cost.growths.empty()) {
      table.quantities.insert(
          table.quantities.end(),
          {{"growth", setting, growth, units, "of the bias, from the middle tap to the last", ""},
           {"growth_error", setting, growth_error, units, "standard error over replicates", ""},
           {"growth_dof", setting, growth_dof, "1", "its degrees of freedom", ""},
           {"growth_tails", setting, growth_tails, "1", "probability by chance, Student's t", ""}});
    }
    add_windows(cost, table);
    table.notes = {{"observable", cost.label.name},
                   {"reference", settings_[most_complete(settings_).last].name},
                   {"replicates", fmt::to_string(replicates_)},
                   {"middle_tap", fmt::to_string(middle_tap())},
                   {"scene_realizations", fmt::to_string(scene_realizations)},
                   {"scene_taps", fmt::to_string(taps_)}};
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace jostle::inline study
