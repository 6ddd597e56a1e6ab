#include <cmath>
#include <limits>

#include "ensemble/analysis/memory/memory.hpp"
#include "ensemble/moments.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr const char* josserand = "Josserand et al. 2000, doi:10.1103/PhysRevLett.85.3632";

/// A mean over realizations, its error and degrees of freedom, in columns.
struct Columns {
  std::vector<double> mean{}, error{}, dof{};
  void add(std::span<const double> values) {
    Moments moments;
    for (const double value : values) moments.add(value);
    mean.push_back(moments.mean());
    error.push_back(moments.standard_error());
    dof.push_back(moments.count() > 1 ? static_cast<double>(moments.count() - 1) : 0);
  }
};

class TableOf {
 public:
  explicit TableOf(Table& table) : table_(table) {}

  void add(std::string name, std::vector<std::string> axes, auto values, std::string units,
           std::string meaning, const char* source = "") {
    table_.quantities.push_back({std::move(name), std::move(axes), std::move(values),
                                 std::move(units), std::move(meaning), source});
  }
  void add(const std::string& name, const std::vector<std::string>& axes, Columns columns,
           const std::string& units, const std::string& meaning, const char* source = "") {
    add(name, axes, std::move(columns.mean), units, meaning, source);
    add(name + "_error", axes, std::move(columns.error), units, "standard error over realizations");
    add(name + "_dof", axes, std::move(columns.dof), "1", "its degrees of freedom");
  }

 private:
  Table& table_;
};

void add_histories(const Column& observable, const std::string& control, const std::string& units,
                   std::span<const History> histories, const MemoryTest& test, Table& table) {
  TableOf columns(table);
  std::vector<std::uint64_t> index, taps;
  std::vector<double> strengths;
  Columns at_switch, response;
  for (const History& history : histories) {
    index.push_back(index.size());
    taps.push_back(history.switch_tap);
    strengths.push_back(history.strength);
    at_switch.add(history.at_switch);
    const std::size_t n = history.at_switch.size();
    for (std::size_t w = 0; w < test.windows.size(); ++w) {
      std::vector<double> change(
          history.responses.begin() + static_cast<std::ptrdiff_t>(w * n),
          history.responses.begin() + static_cast<std::ptrdiff_t>((w + 1) * n));
      for (std::size_t r = 0; r < n; ++r) change[r] -= history.at_switch[r];
      response.add(change);
    }
  }
  table.axes.push_back({"history", {"history"}, index, "1", "way of reaching the value", ""});
  columns.add(control, {"history"}, strengths, units, "strength of the taps before the switch");
  columns.add("switch_tap", {"history"}, taps, "taps", "last tap before the switch");
  columns.add("at_switch", {"history"}, at_switch, observable.units,
              observable.long_name + " there");
  columns.add("response", {"history", "lag_window"}, response, observable.units,
              "mean over the lags less the value at the switch", josserand);
}

void add_differences(const Column& observable, const std::string& control, const std::string& units,
                     const MemoryTest& test, Table& table) {
  TableOf columns(table);
  std::vector<std::uint64_t> pair, first, second;
  std::vector<double> value, error, dof, p, corrected, detectable, first_strength, second_strength;
  for (const AlignedDifference& found : test.differences) {
    if (found.window == 0) {
      pair.push_back(pair.size());
      first.push_back(found.first);
      second.push_back(found.second);
      first_strength.push_back(test.strengths[found.first]);
      second_strength.push_back(test.strengths[found.second]);
    }
    value.push_back(found.value);
    error.push_back(error_or_nan(found.error));
    dof.push_back(found.error.dof);
    p.push_back(found.p);
    corrected.push_back(found.corrected);
    detectable.push_back(std::isfinite(found.detectable)
                             ? found.detectable
                             : std::numeric_limits<double>::quiet_NaN());
  }
  const std::vector<std::string> axes = {"pair", "lag_window"};
  table.axes.push_back({"pair", {"pair"}, pair, "1", "pair of histories", ""});
  columns.add("first_history", {"pair"}, first, "1", "of the pair");
  columns.add("second_history", {"pair"}, second, "1", "of the pair");
  columns.add("first_" + control, {"pair"}, first_strength, units,
              "strength of the taps of the first");
  columns.add("second_" + control, {"pair"}, second_strength, units, "of the second");
  columns.add("difference", axes, value, observable.units,
              "response of the second less that of the first, at equal value at the switch",
              josserand);
  columns.add("difference_error", axes, error, observable.units,
              "standard error over realizations");
  columns.add("difference_dof", axes, dof, "1", "its degrees of freedom");
  columns.add("difference_p", axes, p, "1",
              "p-value of no difference, this one alone, Student's t");
  columns.add("difference_p_corrected", axes, corrected, "1",
              "the same for all together, Holm 1979, Scand. J. Statist. 6, 65");
  columns.add("difference_detectable", axes, detectable, observable.units,
              "smallest difference detected with 80 % power");
}

}  // namespace

Table memory_table(std::string name, const Column& observable, const std::string& control,
                   const std::string& units, std::span<const History> histories,
                   const MemoryTest& test) {
  Table table{.name = std::move(name)};
  std::vector<std::uint64_t> ends, first;
  for (const LagWindow& window : test.windows) {
    ends.push_back(window.last);
    first.push_back(window.first);
  }
  table.axes.push_back(
      {"lag_window", {"lag_window"}, ends, "taps", "last lag of a window after the switch", ""});
  table.quantities.push_back(
      {"first_lag", {"lag_window"}, first, "taps", "first lag of the window", ""});
  add_histories(observable, control, units, histories, test, table);
  add_differences(observable, control, units, test, table);
  table.notes = {{"observable", observable.name},
                 {"realizations", std::to_string(test.realizations)},
                 {"verdict", test.statement(observable.name, observable.units, control)}};
  return table;
}

}  // namespace jostle::inline ensemble
