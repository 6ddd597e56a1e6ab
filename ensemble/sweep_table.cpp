#include "ensemble/sweep_curve.hpp"

namespace jostle {

namespace {

void add_maximum(const SweepMaximum& top, const SweptValue& swept, const ObservableLabel& quantity,
                 Table& table) {
  const auto add = [&](const char* name, double value, const std::string& units,
                       const std::string& meaning) {
    table.quantities.push_back({name, {}, std::vector{value}, units, meaning, ""});
  };
  add("maximum_at", top.x, swept.units, swept.long_name + " of the maximum, from a parabola");
  add("maximum_at_error", top.x_error, swept.units, "standard error of maximum_at");
  add("maximum", top.y, quantity.units, quantity.long_name + " at the maximum");
  add("maximum_error", top.y_error, quantity.units, "standard error of maximum");
  add("maximum_resolved", top.resolved, "1",
      "share of curves drawn from the errors that have a maximum there");
  table.quantities.push_back({"maximum_points",
                              {},
                              std::vector{std::uint64_t{top.points}},
                              "1",
                              "points of the parabola",
                              ""});
  table.notes.emplace_back("maximum", top.verdict);
}

void add_line(const StraightLine& line, const std::string& slope_units,
              const ObservableLabel& quantity, Table& table) {
  const auto add = [&](const char* name, double value, const std::string& units,
                       const char* meaning) {
    table.quantities.push_back({name, {}, std::vector{value}, units, meaning, ""});
  };
  add("line_intercept", line.intercept, quantity.units, "of a straight line");
  add("line_intercept_error", line.intercept_error, quantity.units, "its standard error");
  add("line_slope", line.slope, slope_units, "of a straight line");
  add("line_slope_error", line.slope_error, slope_units, "its standard error");
  add("line_reduced_chi2", line.reduced_chi2, "1", "chi2 per degree of freedom of the line");
}

}  // namespace

Table sweep_table(std::string name, const SweptValue& swept, const ObservableLabel& quantity,
                  const SweepCurve& curve) {
  Table table{.name = std::move(name)};
  table.axes = {{swept.name, {swept.name}, curve.x(), swept.units, swept.long_name, ""}};
  table.notes = {{"observable", quantity.name}, {"against", swept.name}};
  const auto add = [&](const std::string& suffix, auto values, const std::string& units,
                       const std::string& meaning) {
    table.quantities.push_back(
        {quantity.name + suffix, {swept.name}, std::move(values), units, meaning, quantity.source});
  };
  add("", curve.y(), quantity.units, quantity.long_name);
  add("_error", curve.error(), quantity.units, "standard error");
  if (curve.has_realizations()) add("_count", curve.count(), "1", "realizations of the point");
  add_maximum(maximum(curve), swept, quantity, table);
  const std::string slope_units =
      swept.units == "1" ? quantity.units : quantity.units + " / " + swept.units;
  add_line(straight_line(curve), slope_units, quantity, table);
  return table;
}

}  // namespace jostle
