#include "ensemble/analysis/ordering/ordering_table.hpp"

#include <fmt/format.h>

#include <cmath>

#include "engine/numbers.hpp"
#include "ensemble/analysis/ordering/weibull.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr const char* kaplan_meier = "Kaplan & Meier 1958, doi:10.2307/2281868";
constexpr const char* brookmeyer = "Brookmeyer & Crowley 1982, doi:10.2307/2530286";
constexpr const char* thoman = "Thoman, Bain & Antle 1969, Technometrics 11, 445";

Quantity single_value(std::string name, double value, std::string units, std::string long_name,
                      std::string source = "") {
  return {std::move(name),  {}, std::vector{value}, std::move(units), std::move(long_name),
          std::move(source)};
}

void put(Table& table, Quantity quantity) {
  table.quantities.push_back(std::move(quantity));
}

void add_limits(Table& table, const std::string& name, const Limits& limits, const char* level,
                const std::string& units, const char* source) {
  put(table, single_value(fmt::format("{}_low_{}", name, level), limits.low, units,
                          fmt::format("lower end of the {} % interval", level), source));
  put(table, single_value(fmt::format("{}_high_{}", name, level), limits.high, units,
                          fmt::format("upper end of the {} % interval", level), source));
}

void add_growth(Table& table, const std::string& name, const RealizationMean& growth,
                const std::string& units, const std::string& long_name) {
  put(table, single_value(name, growth.value, units, long_name));
  put(table, single_value(name + "_error", error_or_nan(growth.error), units,
                          "standard error over realizations"));
  put(table, single_value(name + "_dof", growth.error.dof, "1", "its degrees of freedom"));
}

void add_survival(Table& table, const Survival& curve) {
  const std::vector<std::string> axes = {"tap"};
  std::vector<double> low, high;
  for (const Limits& limits : curve.limits) {
    low.push_back(limits.low);
    high.push_back(limits.high);
  }
  table.axes.push_back({"tap", axes, curve.taps, "taps",
                        "0, taps at which a realization ordered, the last that could show it", ""});
  const char* const clopper_pearson = "Clopper & Pearson 1934, doi:10.1093/biomet/26.4.404";
  put(table, {"ordered", axes, curve.ordered, "1", "realizations that have ordered", ""});
  put(table, {"survival", axes, curve.share, "1", "share that has not ordered", kaplan_meier});
  put(table, {"survival_error", axes, curve.error, "1", "Greenwood's error", kaplan_meier});
  put(table,
      {"survival_low_95", axes, low, "1", "lower end of the 95 % interval", clopper_pearson});
  put(table,
      {"survival_high_95", axes, high, "1", "upper end of the 95 % interval", clopper_pearson});
}

std::string limits_text(const Limits& limits) {
  const auto end = [](double tap) {
    return std::isnan(tap) ? std::string("no limit") : finite_text("{:.0f}", tap);
  };
  if (std::isnan(limits.low) && std::isnan(limits.high)) return "no interval";
  return fmt::format("{} to {}", end(limits.low), end(limits.high));
}

std::string rule(const OrderingSettings& settings) {
  return finite_text("at or above {} for {} tap{} running", settings.threshold, settings.hold,
                     settings.hold == 1 ? "" : "s");
}

}  // namespace

OrderingAnalysis::OrderingAnalysis(const AnalysedSeries& series, const OrderingSettings& settings)
    : series_(series), settings_(settings), last_(series.last_tap + 1 - settings.hold) {}

void OrderingAnalysis::add(std::uint32_t realization, std::span<const double> values) {
  realizations_.push_back(realization);
  times_.push_back(time_to_order(values, settings_.threshold, settings_.hold));
  if (values.size() >= 4) growth_.add(values);
}

OrderingTimes OrderingAnalysis::times(std::size_t n_realizations) const {
  OrderingTimes times{.of_realization = {}, .last = last_};
  times.of_realization.resize(n_realizations);
  for (std::size_t i = 0; i < times_.size(); ++i)
    times.of_realization[realizations_[i]] = times_[i];
  return times;
}

void OrderingAnalysis::add_times(Table& table) const {
  std::vector<double> taps;
  for (const OrderingTime& time : times_) {
    taps.push_back(time.ordered ? static_cast<double>(time.tap) : not_a_number);
  }
  const std::vector<std::string> axes = {"realization"};
  table.axes.push_back({"realization", axes, realizations_, "1", "number of the realization", ""});
  put(table, {"time_to_order", axes, taps, "taps",
              "first tap from which it is ordered; - where it is not", ""});
}

void OrderingAnalysis::add_law(Table& table) const {
  const auto fit = weibull(times_, last_);
  const WeibullFit law = fit.value_or(WeibullFit{not_a_number,
                                                 not_a_number,
                                                 {not_a_number, not_a_number},
                                                 {not_a_number, not_a_number},
                                                 not_a_number});
  put(table,
      single_value("weibull_shape", law.shape, "1",
                   "of S = exp(-(t/scale)^shape), tap n being t = n - 1/2; 1: memoryless", thoman));
  add_limits(table, "weibull_shape", law.shape_68, "68", "1", thoman);
  add_limits(table, "weibull_shape", law.shape_95, "95", "1", thoman);
  put(table, single_value("weibull_scale", law.scale, "taps",
                          "t by which 63 % have ordered, tap n being t = n - 1/2", thoman));
  put(table, single_value("memoryless_p", law.memoryless_p, "1", "p-value of shape = 1, two-sided",
                          thoman));
  const GrowthRates growth = growth_.result();
  add_growth(table, "growth_per_decade", growth.per_decade, series_.units + "/decade",
             "slope on log10 t from tap 1 on, decades weighing alike");
  add_growth(table, "growth_per_tap", growth.per_tap, series_.units + "/tap",
             "slope on t from tap 1 on");
  if (!fit) {
    table.notes.emplace_back(
        "law", "none fitted: it needs five that ordered, at three different taps, none at tap 0");
    return;
  }
  table.notes.emplace_back(
      "law",
      finite_text("{} ({} of shape 1): shape {:.2g}, 95 % {:.2g} to {:.2g}",
                  law.memoryless_p >= significance_level
                      ? "memoryless, or not distinguishable from it"
                  : law.shape > 1 ? "not memoryless, order gets likelier with time"
                                  : "not memoryless, order gets rarer with time",
                  plain_p_text(law.memoryless_p), law.shape, law.shape_95.low, law.shape_95.high));
}

Table OrderingAnalysis::table() const {
  Table table{.name = "ordering/" + series_.observable};
  add_times(table);
  const Survival curve = survival(times_, last_);
  add_survival(table, curve);
  const double median = median_time(times_);
  const Limits limits_68 = median_limits(times_, 0.6827), limits_95 = median_limits(times_, 0.95);
  put(table, single_value("median_time", median, "taps",
                          "by which half of the realizations have ordered", kaplan_meier));
  add_limits(table, "median_time", limits_68, "68", "taps", brookmeyer);
  add_limits(table, "median_time", limits_95, "95", "taps", brookmeyer);
  add_law(table);
  const std::string so_far =
      fmt::format("{} of {} ordered by tap {}", curve.ordered.back(), times_.size(), last_);
  table.notes.insert(
      table.notes.begin(),
      {{"observable", series_.observable},
       {"taps", fmt::format("{} to {}", series_.first_tap, series_.last_tap)},
       {"rule", rule(settings_)},
       {"realizations", fmt::to_string(times_.size())},
       {"verdict", std::isnan(median)
                       ? so_far + ": the median is not reached"
                       : finite_text("{}; half by tap {:.0f} (68 %: {}; 95 %: {})", so_far, median,
                                     limits_text(limits_68), limits_text(limits_95))}});
  return table;
}

}  // namespace jostle::inline ensemble
