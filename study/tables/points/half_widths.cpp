#include "study/tables/points/half_widths.hpp"

#include <algorithm>
#include <cmath>

#include "engine/numbers.hpp"
#include "fitting/fit.hpp"
#include "fitting/value_text.hpp"

namespace jostle::inline study {

namespace {

const std::string error_suffix = "_error", dof_suffix = "_dof", half_width_suffix = "_half_width";

Quantity* named(Table& table, const std::string& name) {
  const auto found = std::ranges::find(table.quantities, name, &Quantity::name);
  return found == table.quantities.end() ? nullptr : &*found;
}

}  // namespace

double HalfWidths::operator()(double error, double dof) {
  if (!(dof > 0)) return not_a_number;
  const auto [place, is_new] = factors_.try_emplace(dof, 0);
  if (is_new) place->second = half_width(1, dof);
  return error * place->second;
}

std::vector<double> half_widths(const EnsembleSeries& series) {
  HalfWidths half;
  std::vector<double> widths;
  for (std::size_t tap = 0; tap < series.error.size(); ++tap) {
    widths.push_back(half(series.error[tap], static_cast<double>(series.count[tap]) - 1));
  }
  return widths;
}

std::string mean_text(const EnsembleSeries& series, std::size_t tap) {
  double scale = 0;
  for (const double mean : series.mean) {
    if (std::isfinite(mean)) scale = std::max(scale, std::abs(mean));
  }
  const double half = half_width(series.error[tap], static_cast<double>(series.count[tap]) - 1);
  return value_with_error(series.mean[tap], half, scale);
}

Table with_half_widths(Table table) {
  HalfWidths half;
  std::vector<std::string> used;
  std::string bare;  // quantities with standard errors alone
  for (Quantity& quantity : table.quantities) {
    if (!quantity.name.ends_with(error_suffix)) continue;
    const std::string stem = quantity.name.substr(0, quantity.name.size() - error_suffix.size());
    const Quantity* const dof = named(table, stem + dof_suffix);
    auto* const errors = std::get_if<std::vector<double>>(&quantity.values);
    const auto* const freedom = dof ? std::get_if<std::vector<double>>(&dof->values) : nullptr;
    if (!errors) continue;
    if (!freedom || freedom->empty()) {
      if (!named(table, stem)) continue;
      if (!named(table, stem + "_low_95")) {
        bare.append(bare.empty() ? "" : ", ").append(quantity.name);
      }
      continue;
    }
    for (std::size_t i = 0; i < errors->size(); ++i) {
      (*errors)[i] = half((*errors)[i], (*freedom)[freedom->size() == errors->size() ? i : 0]);
    }
    quantity.name = stem + half_width_suffix;
    const std::string standard = "standard error";
    const bool has_error = !named(table, stem) && quantity.long_name.starts_with(standard);
    quantity.long_name =
        "half the 68 % interval" + (has_error ? quantity.long_name.substr(standard.size()) : "");
    used.push_back(dof->name);
  }
  std::erase_if(table.quantities, [&](const Quantity& quantity) {
    return std::ranges::find(used, quantity.name) != used.end();
  });
  const bool has_intervals = std::ranges::any_of(table.quantities, [](const Quantity& quantity) {
    return quantity.name.ends_with("_low_95");
  });
  std::string legend;
  const auto add = [&](const std::string& text) {
    legend.append(legend.empty() ? "" : "; ").append(text);
  };
  if (!used.empty()) {
    add("b, in the last digits of a, is half the 68 % interval by Student's t; the file holds "
        "standard errors and their degrees of freedom");
  }
  if (!bare.empty()) add(bare + ": standard errors");
  if (has_intervals) add("a (x to y): the 95 % interval");
  if (!legend.empty()) table.notes.emplace_back("a(b)", legend);
  return table;
}

}  // namespace jostle::inline study
