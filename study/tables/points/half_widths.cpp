#include "study/tables/points/half_widths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "fitting/fit.hpp"
#include "fitting/intervals/distributions.hpp"

namespace jostle::inline study {

namespace {

const std::string error_suffix = "_error", dof_suffix = "_dof";

/// Student's factors, each computed once.
class Factors {
 public:
  double at(double dof) {
    if (!(dof > 0)) return std::numeric_limits<double>::quiet_NaN();
    const auto [place, is_new] = known_.try_emplace(dof, 0);
    if (is_new) place->second = two_sided(interval_levels[0], dof);
    return place->second;
  }

 private:
  std::map<double, double> known_;
};

Quantity* named(Table& table, const std::string& name) {
  const auto found = std::ranges::find(table.quantities, name, &Quantity::name);
  return found == table.quantities.end() ? nullptr : &*found;
}

}  // namespace

Table with_half_widths(Table table) {
  Factors factors;
  std::vector<std::string> used;
  std::string bare;  // of which there are standard errors alone
  for (Quantity& quantity : table.quantities) {
    if (!quantity.name.ends_with(error_suffix)) continue;
    const std::string stem = quantity.name.substr(0, quantity.name.size() - error_suffix.size());
    const Quantity* const dof = named(table, stem + dof_suffix);
    auto* const errors = std::get_if<std::vector<double>>(&quantity.values);
    const auto* const freedom = dof ? std::get_if<std::vector<double>>(&dof->values) : nullptr;
    if (!named(table, stem) || !errors) continue;
    if (!freedom || freedom->empty()) {
      if (!named(table, stem + "_low_95")) bare.append(bare.empty() ? "" : ", ").append(stem);
      continue;
    }
    for (std::size_t i = 0; i < errors->size(); ++i) {
      (*errors)[i] *= factors.at((*freedom)[freedom->size() == errors->size() ? i : 0]);
    }
    used.push_back(dof->name);
  }
  std::erase_if(table.quantities, [&](const Quantity& quantity) {
    return std::ranges::find(used, quantity.name) != used.end();
  });
  const bool has_intervals = std::ranges::any_of(table.quantities, [](const Quantity& quantity) {
    return quantity.name.ends_with("_low_95");
  });
  std::string legend;
  if (!used.empty()) {
    legend =
        "b, in the last digits of a, is half the 68 % interval by Student's t; the file holds "
        "errors and their degrees of freedom";
    if (!bare.empty()) legend += "; of " + bare + " the standard error";
  } else if (!bare.empty()) {
    legend = "b, in the last digits of a, is the standard error over realizations";
  }
  if (has_intervals) {
    legend.append(legend.empty() ? "" : "; ").append("a (x to y): the 95 % interval");
  }
  if (!legend.empty()) table.notes.emplace_back("a(b)", legend);
  return table;
}

}  // namespace jostle::inline study
