#include "study/tables/points/derived_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "config/json/json_text.hpp"
#include "config/json/suggestion.hpp"
#include "engine/numbers.hpp"
#include "ensemble/analysis/analyses.hpp"
#include "fitting/fit.hpp"
#include "fitting/intervals/distributions.hpp"
#include "results/groups/layout.hpp"
#include "study/bad_input.hpp"

namespace jostle::inline study {

namespace {

const Quantity* quantity_named(const Table& table, const std::string& name) {
  for (const Quantity& quantity : table.quantities) {
    if (quantity.name == name) return &quantity;
  }
  return nullptr;
}

double number_at(const Quantity* quantity, std::size_t place) {
  const auto* numbers = quantity ? std::get_if<std::vector<double>>(&quantity->values) : nullptr;
  return numbers && place < numbers->size() ? (*numbers)[place] : not_a_number;
}

/// An error as tables hold it; where they do not give its degrees of freedom it is taken for known.
ErrorOf error_of(double error, double dof) {
  if (std::isnan(error)) return {};
  return {error, std::isnan(dof) ? std::numeric_limits<double>::infinity() : dof};
}

/// A single value of an analysis with its error.
std::optional<DerivedValue> single_value(const Table& table, const std::string& name) {
  const Quantity* const found = quantity_named(table, name);
  if (!found || !found->axes.empty()) return std::nullopt;
  if (found->long_name.starts_with(lower_bound))
    return DerivedValue{.value = not_a_number,
                        .error = {},
                        .label = {name, found->units, found->long_name, found->source},
                        .no_value = found->long_name,
                        .error_is_no_basis = false};
  return DerivedValue{.value = number_at(found, 0),
                      .error = error_of(number_at(quantity_named(table, name + "_error"), 0),
                                        number_at(quantity_named(table, name + "_dof"), 0)),
                      .label = {name, found->units, found->long_name, found->source},
                      .no_value = "",
                      .error_is_no_basis = false};
}

std::string text_at(const Quantity* quantity, std::size_t place) {
  const auto* texts = quantity ? std::get_if<std::vector<std::string>>(&quantity->values) : nullptr;
  return texts && place < texts->size() ? (*texts)[place] : "";
}

/// For three realizations and fewer too many points have no closed interval, and those that have
/// one scatter less than they should: their errors are no basis of a curve's.
constexpr double fewest_dof_of_a_point = 3;

/// The error of which Student's t makes the longer side of the 68 % interval of the fit.
ErrorOf error_of_interval(const Table& table, std::size_t place, const std::string& prefix) {
  const double dof = number_at(quantity_named(table, "error_dof"), 0);
  const double value = number_at(quantity_named(table, prefix + "value"), place);
  const std::size_t end = 2 * place;  // [parameter, level], 68 % first
  const double side =
      std::max(number_at(quantity_named(table, prefix + "interval_upper"), end) - value,
               value - number_at(quantity_named(table, prefix + "interval_lower"), end));
  if (!(side > 0 && dof >= fewest_dof_of_a_point)) return {};
  return {side / two_sided(interval_levels[0], dof), dof};
}

const std::string restated_prefix = "restated_";  // parameters of the law that draws this curve

std::optional<ParameterPoint> point_along(const Table& fit, const std::string& name,
                                          const std::string& prefix) {
  for (const Quantity& axis : fit.axes) {
    const auto* names = std::get_if<std::vector<std::string>>(&axis.values);
    if (axis.name != prefix + "parameter" || !names) continue;
    const auto place = static_cast<std::size_t>(std::ranges::find(*names, name) - names->begin());
    if (place == names->size()) return std::nullopt;
    const std::string found = text_at(quantity_named(fit, prefix + "identifiability"), place);
    const std::string units = text_at(quantity_named(fit, prefix + "units"), place);
    if (found == name_of(Identifiability::identified) || found == name_of(Identifiability::wide))
      return ParameterPoint{number_at(quantity_named(fit, prefix + "value"), place),
                            error_of_interval(fit, place, prefix), "", units};
    return ParameterPoint{not_a_number,
                          {},
                          found.empty() ? "fitted by an earlier version: fit it again"
                                        : text_at(quantity_named(fit, prefix + "statement"), place),
                          units};
  }
  return std::nullopt;
}

bool is_restated_as(const Table& fit, const std::string& law) {
  return std::ranges::any_of(fit.notes, [&](const auto& note) {
    return note.first == restated_prefix + "model" && note.second == law;
  });
}

std::string note_of(const Table& table, const char* key) {
  const auto found =
      std::ranges::find(table.notes, key, [](const auto& entry) { return entry.first; });
  return found == table.notes.end() ? "" : found->second;
}

std::string without_blanks(std::string text) {
  std::erase(text, ' ');
  return text;
}

std::string conditions_of(const Table& fit) {
  std::string text = note_of(fit, "range");
  for (const Quantity& axis : fit.axes) {
    const auto* names = std::get_if<std::vector<std::string>>(&axis.values);
    if (axis.name != "parameter" || !names) continue;
    for (std::size_t j = 0; j < names->size(); ++j)
      if (text_at(quantity_named(fit, "identifiability"), j) == name_of(Identifiability::fixed))
        text += fmt::format(", {} = {}", (*names)[j], number_at(quantity_named(fit, "value"), j));
  }
  return text;
}

std::optional<DerivedValue> parameter(const Table& table, const std::string& name,
                                      const std::string& prefix) {
  const auto point = point_along(table, name, prefix);
  if (!point) return std::nullopt;
  return DerivedValue{.value = point->value,
                      .error = point->error,
                      .label = {name, point->units, parameter_of_a_fit, ""},
                      .no_value = point->no_value,
                      .error_is_no_basis = point->no_value.empty() && !point->error.known(),
                      .law = prefix.empty() ? without_blanks(note_of(table, "law")) : "",
                      .conditions = conditions_of(table)};
}

void set_steadiness(const Table& table, DerivedValue& value) {
  value.taps = note_of(table, "taps");
  const std::string verdict = note_of(table, "verdict");
  value.steady = verdict.starts_with("reached")       ? Verdict::reached
                 : verdict.starts_with("not reached") ? Verdict::not_reached
                                                      : Verdict::cannot_decide;
}

void add_parameters(const Table& fit, const std::string& prefix, const std::string& law,
                    std::vector<std::string>& names) {
  for (const Quantity& axis : fit.axes) {
    const auto* parameters = std::get_if<std::vector<std::string>>(&axis.values);
    if (axis.name != prefix + "parameter" || !parameters) continue;
    for (const std::string& parameter : *parameters) names.push_back(law + "/" + parameter);
  }
}

/// All quantities that derived_value() finds: "steady/sigma", "kww/rho_inf".
std::vector<std::string> quantities_of(const MadeTables& tables, std::uint32_t point,
                                       const std::string& observable) {
  const auto is_beside_a_value = [](const std::string& name) {
    return name.ends_with("_error") || name.ends_with("_dof");
  };
  std::vector<std::string> names;
  for (const Table& table : tables.analyses) {
    const std::string first = point_name(point) + "/", last = "/" + observable;
    if (!table.name.starts_with(first) || !table.name.ends_with(last)) continue;
    const std::string kind =
        table.name.substr(first.size(), table.name.size() - first.size() - last.size());
    for (const Quantity& quantity : table.quantities)
      if (quantity.axes.empty() && !is_beside_a_value(quantity.name) &&
          std::holds_alternative<std::vector<double>>(quantity.values))
        names.push_back(kind + "/" + quantity.name);
  }
  for (const Table& table : tables.fits) {
    const std::string first = fmt::format("{}/{}/", point_name(point), observable);
    if (!table.name.starts_with(first)) continue;
    add_parameters(table, "", table.name.substr(first.size()), names);
    add_parameters(table, restated_prefix, note_of(table, "restated_model"), names);
  }
  std::ranges::sort(names);
  const auto repeated = std::ranges::unique(names);
  names.erase(repeated.begin(), repeated.end());
  return names;
}

/// The error for a quantity that no table has, with those of its analysis or law that there are.
BadInput not_kept(const MadeTables& tables, std::uint32_t point, const std::string& observable,
                  const std::string& quantity) {
  const std::vector<std::string> kept = quantities_of(tables, point, observable);
  std::vector<std::string> of_kind = kept;
  std::erase_if(of_kind, [&](const std::string& name) {
    return !name.starts_with(quantity.substr(0, quantity.find('/') + 1));
  });
  const std::string fault =
      fmt::format("{} of {} is not kept for sweep point {}", quantity, observable, point);
  if (kept.empty()) return BadInput(fault + ": make the analysis or the fit first");
  return BadInput(fmt::format(
      "{}; it has {}{}.{}", fault, joined(of_kind.empty() ? kept : of_kind, ", "),
      of_kind.empty() ? ": make the analysis or the fit first" : "", did_you_mean(quantity, kept)));
}

/// Why a table has no results; empty where it has some.
std::string refusal_of(const Table& table) {
  const auto note =
      std::ranges::find_if(table.notes, [](const auto& text) { return text.first == "refused"; });
  return note == table.notes.end() ? "" : note->second;
}

}  // namespace

std::optional<ParameterPoint> parameter_point(const Table& fit, const std::string& name) {
  return point_along(fit, name, "");
}

DerivedValue derived_value(const MadeTables& tables, std::uint32_t point,
                           const std::string& observable, const std::string& quantity) {
  const std::size_t slash = quantity.find('/');
  if (slash == std::string::npos) {
    throw BadInput(
        fmt::format("{}: expected value, or analysis/quantity or law/parameter", quantity));
  }
  const std::string kind = quantity.substr(0, slash), name = quantity.substr(slash + 1);
  std::string refused;  // why there is none, where another point may have one
  for (const Table& table : tables.analyses) {
    if (table.name != fmt::format("{}/{}/{}", point_name(point), kind, observable)) continue;
    if (refused.empty()) refused = refusal_of(table);
    auto found = single_value(table, name);
    if (!found) continue;
    if (kind == "steady") set_steadiness(table, *found);
    return *std::move(found);
  }
  for (const Table& table : tables.fits) {
    if (table.name != fmt::format("{}/{}/{}", point_name(point), observable, kind)) continue;
    if (refused.empty()) refused = refusal_of(table);
    if (auto found = parameter(table, name, "")) return *std::move(found);
  }
  for (const Table& table : tables.fits) {
    if (!table.name.starts_with(fmt::format("{}/{}/", point_name(point), observable))) continue;
    if (!is_restated_as(table, kind)) continue;
    if (auto found = parameter(table, name, restated_prefix)) return *std::move(found);
  }
  if (!refused.empty()) {
    DerivedValue none;
    none.no_value = std::move(refused);
    return none;
  }
  throw not_kept(tables, point, observable, quantity);
}

}  // namespace jostle::inline study
