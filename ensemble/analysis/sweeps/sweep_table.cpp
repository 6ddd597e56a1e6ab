#include <fmt/format.h>

#include "ensemble/analysis/sweeps/sweep_curve.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline ensemble {

namespace {

void add_value(const std::string& name, double value, const std::string& units,
               const std::string& meaning, Table& table, const char* source = "") {
  table.quantities.push_back({name, {}, std::vector{value}, units, meaning, source});
}

/// A value, its standard error and the error's degrees of freedom.
void add_with_error(const std::string& name, double value, const ErrorOf& error,
                    const std::string& units, const std::string& meaning, Table& table) {
  add_value(name, value, units, meaning, table);
  add_value(name + "_error", error_or_nan(error), units, "standard error of " + name, table);
  add_value(name + "_dof", error.dof, "1", "degrees of freedom of " + name + "_error", table);
}

void add_extremum(const std::string& name, const char* place, const SweepExtremum& found,
                  const SweptValue& swept, const Column& quantity, Table& table) {
  constexpr const char* source = "multiple comparisons with the best: Hsu 1996";
  add_value(name + "_at", found.x, swept.units,
            fmt::format("{}, at the {} point of a parabola", swept.long_name, place), table);
  add_value(name + "_at_low", found.x_low, swept.units,
            fmt::format("lower end of the 95 % interval of the {0}'s place, of any shape with one "
                        "{0}",
                        name),
            table, source);
  add_value(name + "_at_high", found.x_high, swept.units, "its upper end", table, source);
  add_value(name, found.y, quantity.units,
            fmt::format("{}, at the {} point of the parabola: a description, without an error",
                        quantity.long_name, place),
            table);
  add_value(name + "_p", found.p, "1", fmt::format("p-value of no {} inside the sweep", name),
            table, "two lines: Simonsohn 2018, doi:10.1177/2515245918805755");
  table.quantities.push_back({name + "_points",
                              {},
                              std::vector{std::uint64_t{found.points}},
                              "1",
                              "points of the parabola",
                              ""});
  table.notes.emplace_back(name, found.verdict);
}

void add_line(const StraightLine& line, const std::string& slope_units, const Column& quantity,
              Table& table) {
  add_with_error("line_intercept", line.intercept, line.intercept_error, quantity.units,
                 "intercept of a straight line", table);
  add_with_error("line_slope", line.slope, line.slope_error, slope_units,
                 "slope of a straight line", table);
  add_value("line_reduced_chi2", line.reduced_chi2, "1", "chi2 per degree of freedom of the line",
            table);
  add_value("line_p", line.p, "1", "p-value of points on a straight line scattering as much", table,
            "F-test, Box 1954, doi:10.1214/aoms/1177728786");
}

void add_differences(const SweepCurve& curve, std::optional<std::size_t> reference,
                     const SweptValue& swept, const Column& quantity, Table& table) {
  const std::vector<SweepDifference> all = differences(curve, reference);
  if (all.empty()) return;
  std::vector<std::uint64_t> index;
  std::vector<double> start, end, value, error, dof, p, corrected;
  for (const SweepDifference& difference : all) {
    index.push_back(index.size());
    start.push_back(curve.x()[difference.start]);
    end.push_back(curve.x()[difference.end]);
    value.push_back(difference.value);
    error.push_back(error_or_nan(difference.error));
    dof.push_back(difference.error.dof);
    p.push_back(difference.p);
    corrected.push_back(difference.corrected);
  }
  table.axes.push_back({"pair", {"pair"}, std::move(index), "1", "pair of points", ""});
  const auto add = [&](const char* name, std::vector<double> values, const std::string& units,
                       const char* meaning, const char* source = "") {
    table.quantities.push_back({name, {"pair"}, std::move(values), units, meaning, source});
  };
  const bool paired = curve.streams() == Streams::matched;
  add("from", std::move(start), swept.units, "point that the other is compared with");
  add("to", std::move(end), swept.units, "the other point");
  add("difference", std::move(value), quantity.units,
      paired ? "mean of `to` less `from`, of the realizations that both have"
             : "value at `to` less that at `from`");
  add("difference_error", std::move(error), quantity.units,
      paired ? "standard error over realizations of their differences"
             : "standard error of two independent means");
  add("difference_dof", std::move(dof), "1", "degrees of freedom of difference_error",
      paired ? "" : "Welch 1947, doi:10.1093/biomet/34.1-2.28");
  add("difference_p", std::move(p), "1", "p-value of no difference, this pair alone, Student's t");
  add("difference_p_corrected", std::move(corrected), "1", "the same for all pairs together",
      "Holm 1979, Scand. J. Statist. 6, 65");
  table.notes.emplace_back("differences",
                           paired ? "realization by realization: the streams are matched"
                                  : "of independent means (Welch): the streams are not matched");
}

// Like error_of(), for each point by itself, [n_points].
std::vector<ErrorOf> errors_of_points(const SweepCurve& curve) {
  std::vector<ErrorOf> errors;
  for (std::size_t i = 0; i < curve.n_points(); ++i) {
    std::vector<double> only(curve.n_points());
    only[i] = 1;
    errors.push_back(curve.error_of(only));
  }
  return errors;
}

struct Errors {
  std::vector<double> error, dof;
};

Errors numbers(const std::vector<ErrorOf>& errors) {
  Errors all;
  for (const ErrorOf& error : errors) {
    all.error.push_back(error_or_nan(error));
    all.dof.push_back(error.dof);
  }
  return all;
}

// The assumption of pooling.
void add_scatter(const SweepCurve& curve, Table& table) {
  const double p = curve.p_of_equal_scatter();
  const bool has_realizations = curve.has_realizations();
  add_value("pooled_sigma_p", p, "1",
            has_realizations ? "p-value of realizations scattering alike at all points"
                             : "p-value of equal errors at all points",
            table, "Bartlett 1937, doi:10.1098/rspa.1937.0109");
  if (!(p < significance_level) || !curve.pools()) return;
  table.notes.emplace_back(
      "scatter", finite_text("{} ({}): errors from the pooled variance are too small where {} most",
                             has_realizations ? "realizations do not scatter alike at all points"
                                              : "the errors of the points differ",
                             p_text(p), has_realizations ? "they scatter" : "values scatter"));
}

}  // namespace

Table sweep_table(std::string name, const SweptValue& swept, const Column& quantity,
                  const SweepCurve& curve, std::optional<std::size_t> reference) {
  Table table{.name = std::move(name)};
  table.axes = {{swept.name, {swept.name}, curve.x(), swept.units, swept.long_name, ""}};
  table.notes = {{"observable", quantity.name}, {"against", swept.name}};
  const auto add = [&](const std::string& suffix, auto values, const std::string& units,
                       const std::string& meaning) {
    table.quantities.push_back(
        {quantity.name + suffix, {swept.name}, std::move(values), units, meaning, quantity.source});
  };
  add("", curve.y(), quantity.units, quantity.long_name);
  Errors own = numbers(curve.error());
  add("_error", std::move(own.error), quantity.units, "standard error");
  add("_dof", std::move(own.dof), "1", "degrees of freedom of the error");
  if (curve.pools() && curve.pooled().known()) {
    Errors pooled = numbers(errors_of_points(curve));
    add("_pooled_error", std::move(pooled.error), quantity.units,
        curve.streams() == Streams::matched
            ? "standard error by the pooled variance of points and levels of realizations"
            : "standard error by the variance pooled over points, as of lines and maxima");
    add("_pooled_dof", std::move(pooled.dof), "1", "its degrees of freedom");
  }
  if (curve.has_realizations()) add("_count", curve.count(), "1", "realizations of the point");
  add_value("pooled_sigma", error_or_nan(curve.pooled()), quantity.units,
            !curve.has_realizations() ? "standard error of a point, pooled over points"
            : curve.streams() == Streams::matched
                ? "deviation of one realization about its own level, pooled over points"
                : "deviation of one realization, pooled over points",
            table);
  add_value("pooled_sigma_dof", curve.pooled().dof, "1", "its degrees of freedom", table);
  add_scatter(curve, table);
  add_extremum("maximum", "highest", maximum(curve), swept, quantity, table);
  add_extremum("minimum", "lowest", minimum(curve), swept, quantity, table);
  const std::string slope_units =
      swept.units == "1" ? quantity.units : quantity.units + " / " + swept.units;
  add_line(straight_line(curve), slope_units, quantity, table);
  add_differences(curve, reference, swept, quantity, table);
  return table;
}

}  // namespace jostle::inline ensemble
