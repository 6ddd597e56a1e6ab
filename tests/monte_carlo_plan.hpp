#pragma once

#include <algorithm>
#include <string_view>

#include "ensemble/plan.hpp"
#include "ensemble/sink.hpp"

namespace jostle {

/// The engine's settings of a plan of Monte Carlo.
inline MonteCarlo& monte_carlo(Plan& plan) {
  return std::get<MonteCarlo>(plan.engine);
}
inline const MonteCarlo& monte_carlo(const Plan& plan) {
  return std::get<MonteCarlo>(plan.engine);
}

/// Monte Carlo's record of a tap in the column of that name.
inline double diagnostic(const TapRow& row, std::string_view name) {
  const std::vector<Column> all = columns(MonteCarlo{});
  const auto found = std::ranges::find(all, name, &Column::name);
  return row.diagnostics.at(static_cast<std::size_t>(found - all.begin()));
}

}  // namespace jostle
