#pragma once

#include <optional>
#include <string>

#include "cli/tables/layout.hpp"
#include "study/planning/cost_study.hpp"

namespace jostle::inline cli {

/// For people: with a target the cheapest way to it, the result of the scene's own setting, and a
/// line per setting for one observable. An error is printed in the last digits of its value:
/// +0.0012(5).
std::string cost_text(const CostStudy& study, const CostOfObservable& cost,
                      std::uint32_t scene_realizations, std::optional<double> target,
                      const Layout& layout);

}  // namespace jostle::inline cli
