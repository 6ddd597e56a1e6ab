#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "ensemble/analysis/ordering/ordering_table.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr const char* hsu = "multiple comparisons with the best, Hsu 1996";

std::vector<std::string> words(const std::vector<bool>& flags) {
  std::vector<std::string> result;
  for (const bool flag : flags) result.emplace_back(flag ? "yes" : "no");
  return result;
}

std::string labels_of(const std::vector<OrderingPoint>& points, const std::vector<bool>& chosen) {
  std::string text;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (chosen[k]) text.append(text.empty() ? "" : ", ").append(points[k].label);
  }
  return text;
}

std::size_t largest_of(const std::vector<RealizationMean>& means) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < means.size(); ++k) {
    if (means[k].value > means[best].value || std::isnan(means[best].value)) best = k;
  }
  return best;
}

std::string steady_word(const OrderingPoint& point) {
  if (!point.steady) return "too few taps";
  if (*point.steady == Verdict::reached) return "reached";
  return *point.steady == Verdict::not_reached ? "not reached" : "cannot decide";
}

// True if realizations order at equal taps, in any order of realizations.
bool same_times(std::vector<OrderingTime> a, std::vector<OrderingTime> b) {
  const auto earlier = [](const OrderingTime& first, const OrderingTime& second) {
    return std::pair(first.tap, first.ordered) < std::pair(second.tap, second.ordered);
  };
  std::ranges::sort(a, earlier);
  std::ranges::sort(b, earlier);
  const auto share = [](const std::vector<OrderingTime>& times, std::size_t i, std::size_t n) {
    const OrderingTime& time = times[i * times.size() / n];
    return std::pair(time.tap, time.ordered);
  };
  if (a.empty() || b.empty()) return a.empty() == b.empty();
  const std::size_t n = std::lcm(a.size(), b.size());
  for (std::size_t i = 0; i < n; ++i)
    if (share(a, i, n) != share(b, i, n)) return false;
  return true;
}

std::string first_statement(const std::vector<OrderingPoint>& points, std::size_t best,
                            const Candidates& found, bool any) {
  if (!any) return "cannot decide: no realization ordered";
  if (!found.could_decide) {
    return fmt::format(
        "cannot decide: {} first in these realizations, but they are too few for a permutation "
        "test of {} points to exclude any; add realizations",
        points[best].label, points.size());
  }
  // Points with equal times have no order.
  std::vector<bool> earliest(points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    earliest[k] = same_times(points[k].times.known(), points[best].times.known());
  const bool tie = std::ranges::count(earliest, true) > 1;
  return fmt::format("{}{}; may be first: {} (97.5 %, permutation log-rank tests of all pairs)",
                     tie ? "exact tie of " : "", labels_of(points, earliest),
                     labels_of(points, found.may_be));
}

std::string largest_statement(const std::vector<OrderingPoint>& points, std::size_t best,
                              const Candidates& found, const ComparedValue& value,
                              const std::vector<bool>& open) {
  if (!found.could_decide) return "cannot decide: it needs two realizations of a point";
  std::string text = fmt::format(
      "{}; may be largest: {} (97.5 %, t-tests of all pairs of {}, taps {})", points[best].label,
      labels_of(points, found.may_be), value.observable, value.taps);
  if (const std::string moving = labels_of(points, open); !moving.empty()) {
    text.append("; not steady, so never excluded: ").append(moving);
  }
  return text;
}

std::string verdict(const std::vector<OrderingPoint>& points, bool any, const Candidates& first,
                    const Candidates& largest) {
  if (!any || !first.could_decide || !largest.could_decide)
    return "cannot decide whether the points that order first and that end highest are one";
  std::vector<bool> ordered(points.size());
  bool any_ordered = false;
  for (std::size_t k = 0; k < points.size(); ++k) {
    ordered[k] = first.may_be[k] && largest.may_be[k];
    any_ordered = any_ordered || ordered[k];
  }
  std::vector<bool> unshown(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) unshown[k] = points[k].steady != Verdict::reached;
  const std::string not_shown = labels_of(points, unshown);
  if (!any_ordered) {
    return fmt::format(
        "the point that orders first is not the one with the largest value over the last taps "
        "(p < 0.05){}",
        not_shown.empty() ? "" : "; that these are steady is not shown at " + not_shown);
  }
  const auto only = [](const std::vector<bool>& flags) {
    return std::ranges::count(flags, true) == 1;
  };
  if (only(first.may_be) && only(largest.may_be)) {
    return labels_of(points, ordered) +
           " orders first and has the largest value over the last taps (no other point may)";
  }
  return fmt::format(
      "undecided whether one point orders first and has the largest value over the last taps: {} "
      "{}",
      only(ordered) ? "only this point may," : "these points may,", labels_of(points, ordered));
}

struct Comparison {
  std::vector<RealizationMean> means;
  std::vector<bool> open;
  Candidates first, largest;
};

void add_columns(Table& table, const std::vector<OrderingPoint>& points, const ComparedValue& value,
                 const Comparison& found) {
  const std::vector<std::string> axes = {"point"};
  std::vector<std::string> labels, steady;
  std::vector<std::uint64_t> realizations, ordered;
  std::vector<double> median, low, high, mean, error, dof;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::vector<OrderingTime> times = points[k].times.known();
    const Limits limits = median_limits(times, 0.6827);
    labels.push_back(points[k].label);
    realizations.push_back(times.size());
    ordered.push_back(0);
    for (const OrderingTime& time : times) ordered.back() += time.ordered ? 1 : 0;
    median.push_back(median_time(times));
    low.push_back(limits.low);
    high.push_back(limits.high);
    mean.push_back(found.means[k].value);
    error.push_back(error_or_nan(found.means[k].error));
    dof.push_back(found.means[k].error.dof);
    steady.push_back(steady_word(points[k]));
  }
  table.axes = {{"point", axes, labels, "1", "sweep point", ""}};
  table.quantities = {
      {"realizations", axes, realizations, "1", "realizations", ""},
      {"ordered", axes, ordered, "1", "of them ordered", ""},
      {"median_time", axes, median, "taps", "by which half have ordered; - where fewer have", ""},
      {"median_time_low_68", axes, low, "taps", "lower end of the 68 % interval", ""},
      {"median_time_high_68", axes, high, "taps", "upper end of the 68 % interval", ""},
      {"later_p", axes, found.first.p, "1",
       "that chance alone lets another point order so much earlier, all pairs together",
       "log-rank, Peto & Peto 1972, doi:10.2307/2344317"},
      {"may_order_first", axes, words(found.first.may_be), "1", "at 97.5 %", hsu},
      {"last_value", axes, mean, value.units, value.observable + ", mean of the last taps", ""},
      {"last_value_error", axes, error, value.units, "standard error over realizations", ""},
      {"last_value_dof", axes, dof, "1", "its degrees of freedom", ""},
      {"smaller_p", axes, found.largest.p, "1",
       "that chance alone lets another point end so much higher, all pairs together", ""},
      {"may_be_largest", axes, words(found.largest.may_be), "1", "at 97.5 %", hsu},
      {"steady", axes, steady, "1", "whether these taps are steady, as jostle analyse steady", ""}};
}

}  // namespace

Table ordering_comparison(const std::string& observable, const OrderingSettings& settings,
                          const ComparedValue& value, const std::vector<OrderingPoint>& points,
                          Streams streams) {
  std::vector<OrderingTimes> times;
  std::vector<std::vector<double>> values;
  Comparison found;
  bool any = false;
  for (const OrderingPoint& point : points) {
    times.push_back(point.times);
    values.push_back(point.last_values);
    found.means.push_back(mean_of(point.last_values));
    found.open.push_back(point.steady == Verdict::not_reached);
    for (const OrderingTime& time : point.times.known()) any = any || time.ordered;
  }
  found.first = may_order_first(times, streams);
  found.largest = may_be_largest(values, streams, found.open);
  Table table{.name = "ordering/" + observable};
  add_columns(table, points, value, found);
  table.notes = {
      {"observable", observable},
      {"rule", finite_text("at or above {} for {} tap{} running", settings.threshold, settings.hold,
                           settings.hold == 1 ? "" : "s")},
      {"streams", streams == Streams::matched ? "matched: realizations are paired" : "independent"},
      {"orders_first", first_statement(points, orders_first(times), found.first, any)},
      {"largest_value",
       largest_statement(points, largest_of(found.means), found.largest, value, found.open)},
      {"verdict", verdict(points, any, found.first, found.largest)}};
  return table;
}

}  // namespace jostle::inline ensemble
