#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "fitting/value_text.hpp"
#include "study/drawing/drawn/value_text.hpp"
#include "study/drawing/figures/builders.hpp"
#include "study/drawing/page/sections/sections.hpp"

// Laws fitted to curves: the figures, their comparison, and the parameters of each law.
namespace jostle::inline study {
namespace {

/// Quantities of a law, of its limit ("limit_") or of this curve as another law ("restated_").
struct Parameters {
  const TableView& table;
  std::string prefix{};

  std::vector<std::string> names() const { return table.axis_texts(prefix + "parameter"); }
  double value(std::size_t j) const { return table.value(prefix + "value", j); }
  /// level: 0 for 68 %, 1 for 95 %.
  double low(std::size_t j, std::size_t level) const {
    return value_at(table.row(prefix + "interval_lower", j), level);
  }
  double high(std::size_t j, std::size_t level) const {
    return value_at(table.row(prefix + "interval_upper", j), level);
  }
  bool is_limited(std::size_t j) const {
    return std::isfinite(value(j)) && std::isfinite(low(j, 1)) && std::isfinite(high(j, 1));
  }
};

std::string interval(double low, double high) {
  if (!std::isfinite(low) && !std::isfinite(high)) return "no limit";
  if (!std::isfinite(high)) return "above " + typeset_number(low);
  if (!std::isfinite(low)) return "below " + typeset_number(high);
  const int digits = distinguishing_digits(low, high, 4);
  return typeset_number(low, digits) + " to " + typeset_number(high, digits);
}

/// The value with half of its 68 % interval.
std::string estimate(const Parameters& parameters, std::size_t j) {
  const double value = parameters.value(j);
  if (!std::isfinite(value)) return "-";
  const double half = (parameters.high(j, 0) - parameters.low(j, 0)) / 2;
  if (!std::isfinite(half)) return typeset_number(value) + ", error unknown";
  if (is_lopsided(value, parameters.low(j, 0), parameters.high(j, 0), parameters.low(j, 1),
                  parameters.high(j, 1)))
    return value_with_limits(value, parameters.low(j, 0), parameters.high(j, 0));
  return typeset_with_error(value, half);
}

Json parameter_table(const Parameters& parameters, const std::string& law) {
  const std::vector<std::string> names = parameters.names(),
                                 statements =
                                     parameters.table.texts(parameters.prefix + "statement"),
                                 units = parameters.table.texts(parameters.prefix + "units");
  std::vector<PageRow> rows;
  for (std::size_t j = 0; j < names.size(); ++j) {
    rows.push_back({names[j], estimate(parameters, j),
                    j < units.size() && units[j] != "1" ? units[j] : "–",
                    interval(parameters.low(j, 1), parameters.high(j, 1)),
                    j < statements.size() ? statements[j] : ""});
  }
  return estimates_block(
      "Parameters of the " + law + ". Units: X, that of the curve's values; t, that of its axis",
      {"parameter", "estimate", "unit", "95 % interval", "statement"}, rows);
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// How many of the parameters the data determine.
std::string identified(const Parameters& parameters) {
  std::vector<std::string> known, unknown;
  const std::vector<std::string> names = parameters.names();
  for (std::size_t j = 0; j < names.size(); ++j) {
    (parameters.is_limited(j) ? known : unknown).push_back(names[j]);
  }
  if (unknown.empty()) return "All parameters are limited on both sides.";
  if (known.empty()) {
    return "No parameter is limited on both sides: the curve does not identify this law.";
  }
  return fmt::format("{} {} limited on both sides; {} {} not.", joined(known),
                     known.size() == 1 ? "is" : "are", joined(unknown),
                     unknown.size() == 1 ? "is" : "are");
}

/// Statement on the parameters of the law, or of its limit if that was fitted.
std::string what_is_identified(const TableView& law) {
  if (law.note("limit").empty()) return identified({law});
  return "Fitted as a limit of the law. Parameters of the limit: " + identified({law, "limit_"}) +
         " Parameters of the full law: " + identified({law});
}

Json comparison(const std::vector<TableView>& laws) {
  if (laws.size() < 2) return nullptr;
  std::vector<PageRow> rows;
  for (const TableView& law : laws) {
    const bool is_held_out = law.has("held_out_error");
    rows.push_back({law_name(law), law.note("law"), number_cell(law, "reduced_chi2", 0, 3),
                    number_cell(law, "r2", 0, 5),
                    is_held_out ? number_cell(law, "held_out_error", 0, 5) : "–",
                    is_held_out ? value_cell(law, "held_out_difference") : "–",
                    is_held_out ? p_cell(law, "held_out_p", 0) : "–",
                    number_cell(law, "points", 0, 6), number_cell(law, "effective_points", 0, 3)});
  }
  return estimates_block(
      "The laws compared. Held-out error: mean squared error of the prediction of a realization "
      "that the fit has not seen, in variances of one realization. Difference: from the leading "
      "law. p: of the hypothesis that the law is as close to the mean curve as the leading law",
      {"law", "formula", "reduced χ²", "R²", "held-out error", "difference", "p", "points",
       "independent points"},
      rows);
}

Blocks law_blocks(const TableView& law) {
  Blocks blocks{statement_block("", law.note("law"))};
  if (!law.note("limit").empty()) {
    blocks.add(statement_block("Limit", law.note("limit")));
    blocks.add(parameter_table({law, "limit_"}, "limit X = " + law.note("limit_law")));
  }
  blocks.add(parameter_table({law}, law_name(law)));
  if (const std::string candidate = law.note("restated_model"); !candidate.empty()) {
    blocks.add(statement_block("Another form of this curve", law.note("restated_law")));
    blocks.add(parameter_table({law, "restated_"}, law_name(candidate)));
  }
  blocks.add(statement_block("Combinations", law.note("combinations")));
  blocks.add(statement_block("Remarks", law.note("remarks")));
  return blocks;
}

Blocks curve_blocks(const PageContent& content, std::uint32_t point, const FittedLaws& fitted) {
  Blocks blocks{
      figures_block(content, {.section = "fits", .point = point, .subject = fitted.observable})};
  std::set<std::string> choices;  // one for each set of laws that were fitted together
  for (const TableView& law : fitted.laws) {
    if (choices.insert(law.note("choice")).second) {
      blocks.add(statement_block("Choice", law.note("choice")));
    }
  }
  blocks.add(comparison(fitted.laws));
  for (const TableView& law : fitted.laws) {
    blocks.add(details_block(law_name(law) + " – " + what_is_identified(law), law_blocks(law),
                             fitted.laws.size() == 1));
  }
  return blocks;
}

}  // namespace

Json fits_section(const PageContent& content) {
  std::vector<TableView> all;
  for (const TableView& table : content.file.tables()) {
    if (table.group() == "fits") all.push_back(table);
  }
  std::vector<TableView> made = not_refused(all);
  std::erase_if(made, [](const TableView& table) { return !table.has("fitted"); });
  return page_section(
      "fits", "Fitted laws",
      "Estimates are given as value(half of the 68 % interval), or with the distances to both of "
      "its "
      "ends where it is lopsided; “no limit” means that the data allow any value beyond.",
      {points_block(content.file, numbers_of(made),
                    [&](std::uint32_t point) {
                      Blocks blocks;
                      for (const FittedLaws& fitted : fitted_laws(made, point)) {
                        blocks.add(curve_blocks(content, point, fitted));
                      }
                      return blocks;
                    }),
       refusals_block(content.file, all)});
}

}  // namespace jostle::inline study
