#include "cli/reports/cost_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "cli/tables/durations.hpp"
#include "cli/tables/text_table.hpp"
#include "cli/tables/wrapped.hpp"
#include "ensemble/statistics/counted.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "ensemble/statistics/jackknife.hpp"
#include "fitting/value_text.hpp"

namespace jostle::inline cli {

namespace {

std::string with_error(double value, double error) {
  const std::string text = value_with_error(value, error);
  return value > 0 && text != "0" ? "+" + text : text;
}

/// With half the 68 % interval by Student's t over so many replicates, as all that is printed.
std::string over_replicates(double value, double error, std::size_t replicates) {
  return with_error(value, student_half_width(error, replicates));
}

std::string over_replicates(const PairedBias& bias) {
  return over_replicates(bias.bias, bias.error, bias.pairs);
}

std::string core_time(double seconds) {
  if (!(seconds >= 3600)) return format_duration(Seconds(seconds)) + " of core time";
  return finite_text("{:.3g} core-hours", seconds / 3600);
}

/// Sweeps are whole numbers by the thousand, simulated seconds are few.
std::string work_text(const CostStudy& study, std::size_t setting) {
  const double work = study.times()[setting].work;
  return work >= 100 && std::isfinite(work) ? finite_text("{:.0f}", work) : number_text(work, 3);
}

std::string rows(const CostStudy& study, const CostOfObservable& cost, const Layout& layout) {
  const bool all = layout.columns == Columns::all;
  std::vector<std::string> headers{"setting", "bias", "s/tap", "realization", ""};
  if (all) headers.insert(headers.begin() + 2, {"pairing gains", study.work_name() + "/tap"});
  TextTable table(headers);
  const auto front = pareto_front(cost.setting_costs);
  for (std::size_t p = 0; p < study.settings().size(); ++p) {
    const PairedBias& bias = cost.biases[p];
    const bool reference = p == study.reference().last;
    const double gain = bias.variance_reduction;
    std::vector<std::string> cells{
        study.settings()[p].name, reference ? "0, the reference" : over_replicates(bias),
        number_text(study.times()[p].tap_seconds, 3),
        format_duration(Seconds(study.realization_seconds(p))), front[p] != 0 ? "front" : ""};
    if (all) {
      cells.insert(cells.begin() + 2,
                   {reference || !std::isfinite(gain) ? "-" : finite_text("{:.2g} x", gain),
                    work_text(study, p)});
    }
    table.add(std::move(cells));
  }
  return table.text(layout.table_width());
}

/// Failures, with the first reason of each setting, and the settings with this reason.
std::string failures(const CostStudy& study) {
  std::map<std::string, std::string> settings;
  for (std::size_t p = 0; p < study.settings().size(); ++p) {
    const auto is_here = [p](const RealizationSummary& realization) {
      return realization.id.point == p;
    };
    const auto n = std::ranges::count_if(study.failed(), is_here);
    if (n == 0) continue;
    std::string& names = settings[fmt::format(
        "{} of {} replicates failed, and are not in the numbers: {}", n, study.replicates(),
        std::ranges::find_if(study.failed(), is_here)->reason)];
    names.append(names.empty() ? "" : ", ").append(study.settings()[p].name);
  }
  std::string text;
  for (const auto& [heading, names] : settings) text += heading + "\n  (" + names + ")\n";
  return text;
}

/// A reference that ends its relaxations before a rougher setting does is none.
std::string doubt_of_the_reference(const CostStudy& study) {
  const std::size_t reference = study.reference().last;
  for (std::size_t p = 0; p < study.settings().size(); ++p) {
    const PilotSetting& setting = study.settings()[p];
    if (setting.part != PilotSetting::Part::scene && setting.part != PilotSetting::Part::stop)
      continue;
    if (!(study.times()[p].work > 1.1 * study.times()[reference].work)) continue;
    const bool grains = std::holds_alternative<DiscreteElement>(setting.engine);
    return fmt::format(
        "DOUBTFUL: the reference takes {} {} per tap, and \"{}\" takes {}. It does not relax more "
        "completely, and biases against it mean little: {}\n",
        work_text(study, reference), study.work_name(), setting.name, work_text(study, p),
        grains ? "are taps capped (\"most_seconds\")?"
               : "does its step die away (\"reset_each_tap\": false), or are relaxations capped "
                 "(\"max_sweeps\")?");
  }
  return "";
}

std::string shortfall_of_the_reference(const CostOfObservable& cost) {
  const PairedBias& step = cost.last_step;
  if (step.pairs < 2) {
    return fmt::format(
        "The bias of the most complete setting itself is not known: {} finished both it and the "
        "setting before it.\n",
        step.pairs == 0 ? "no replicate" : "one replicate alone");
  }
  const std::string text =
      fmt::format("The step to the most complete setting: {}; ", over_replicates(step));
  if (!is_seen(step)) return text + "its own bias is too small for these replicates to detect.\n";
  if (!std::isfinite(cost.remainder.error)) {
    return text +
           "steps are not seen to shrink, so that it may itself be short by more than this step.\n";
  }
  return text + fmt::format("if steps go on to shrink, it is itself short by {}.\n",
                            over_replicates(cost.remainder.value, cost.remainder.error,
                                            cost.remainder.realizations));
}

/// True if more taps would change the bias of the scene's own setting.
std::string growth_of_the_bias(const CostStudy& study, const CostOfObservable& cost) {
  const std::string taps = fmt::format("tap {} of {}", study.pilot_taps(), study.taps());
  if (cost.growths.empty() || !std::isfinite(cost.growths.front().detectable) ||
      study.reference().last == 0) {
    return study.pilot_taps() < study.taps()
               ? fmt::format("Biases are those after {}: they may grow with further taps.\n", taps)
               : "";
  }
  const Growth& growth = cost.growths.front();
  const double now = cost.biases.front().bias, previous = now - growth.change.bias;
  const std::string text =
      fmt::format("Biases are those after {}. Since tap {} the scene's changed by {}: ", taps,
                  study.middle_tap(), over_replicates(growth.change));
  if (!growth.is_seen()) {
    return text + finite_text("no change is seen; one of {:.2g} would have been with 80 %.\n",
                              growth.detectable);
  }
  return text + finite_text("it {} with taps ({}, {} replicates); --taps takes more.\n",
                            std::abs(now) > std::abs(previous) ? "still grows" : "shrinks",
                            plain_p_text(growth.tails), growth.change.pairs);
}

std::string other_windows_line(const CostOfObservable& cost) {
  std::string text;
  for (const WindowEffect& effect : cost.windows) {
    text += text.empty() ? "Read through other windows, the same beds differ by " : "; ";
    text += fmt::format("{} ({})", over_replicates(effect.difference), effect.name);
  }
  return text.empty() ? "" : text + ".\n";
}

std::string meaning_of_half(const CostStudy& study) {
  const bool is_there = std::ranges::any_of(study.settings(), [](const PilotSetting& setting) {
    return setting.part == PilotSetting::Part::spheres;
  });
  return is_there ? "half the footprint: half the spheres on half the area of the floor.\n" : "";
}

std::string advice(const CostStudy& study, const CostOfObservable& cost, double target) {
  const std::string wanted = finite_text("For an error of {:g} in {}", target, cost.label.name);
  const auto choice = cheapest(cost.limits, target);
  if (choice) {
    const SettingCost& limit = cost.limits[choice->setting];
    return finite_text(
        "{}: {}, {}, about {} for {} taps.\nUpper limits at 80 % confidence ({}): bias {:.2g}, "
        "spread of realizations {:.2g} after tap {}. They assume that every stop rule stricter "
        "than \"{}\" changes the result {}.\n",
        wanted, study.settings()[choice->setting].name,
        counted(choice->realizations, "realization"), core_time(choice->core_seconds), study.taps(),
        counted(limit.pairs, "pilot replicate"), limit.bias, limit.sigma, study.pilot_taps(),
        study.settings()[study.reference().last].name,
        is_seen(cost.last_step) ? "less than the rule before it, as for the last two rules"
                                : "at most half as much as the rule before it");
  }
  double least = std::numeric_limits<double>::infinity();
  for (const SettingCost& setting : cost.limits) least = std::fmin(least, setting.bias);
  if (std::isinf(least)) {
    return wanted +
           ": nothing can be recommended. Stricter stop rules are not known to change the result "
           "less and less, so the bias of the most complete setting has no limit. Use more "
           "replicates, or a scene whose own stop is more complete.\n";
  }
  return finite_text(
      "{} no setting suffices: the least limit of a bias, that of the most complete setting "
      "included, is {:.2g}.\nMore replicates make errors of biases smaller.\n",
      wanted, least);
}

}  // namespace

std::string cost_text(const CostStudy& study, const CostOfObservable& cost,
                      std::uint32_t scene_realizations, std::optional<double> target,
                      const Layout& layout) {
  const SettingCost& own = cost.setting_costs.front();
  if (std::isnan(own.realization_seconds))
    return wrapped(failures(study), layout.width);  // every replicate of the scene's own
  std::string head = target ? advice(study, cost, *target) : "";
  head += finite_text(
      "The scene's own settings: bias {}, statistical error {} with {} realization{}, {} for "
      "{} taps.\n",
      over_replicates(own.bias, own.bias_error, cost.biases.front().pairs),
      std::isfinite(own.sigma)
          ? number_text(own.sigma / std::sqrt(static_cast<double>(scene_realizations)), 2)
          : "not known",
      scene_realizations, scene_realizations == 1 ? "" : "s",
      core_time(own.realization_seconds * scene_realizations), study.taps());
  head += fmt::format("\n{}: pilots after {}, {}, against {}; a(b): b is half the 68 % interval\n",
                      cost.label.name, counted(study.pilot_taps(), "tap"),
                      counted(study.replicates(), "replicate"),
                      study.settings()[study.reference().last].name);
  const std::string footer =
      "front: no other setting has both a smaller |bias| + error and a smaller time.\n" +
      meaning_of_half(study) + shortfall_of_the_reference(cost) + doubt_of_the_reference(study) +
      failures(study) + growth_of_the_bias(study, cost) + other_windows_line(cost);
  return wrapped(head, layout.width) + rows(study, cost, layout) + wrapped(footer, layout.width);
}

}  // namespace jostle::inline cli
