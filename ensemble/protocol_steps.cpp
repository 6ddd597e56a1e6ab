#include "ensemble/protocol_steps.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "ensemble/moments.hpp"

namespace jostle::inline ensemble {

std::variant<ProtocolSteps, std::string> protocol_steps(std::span<const Stage> protocol,
                                                        std::uint64_t last_taps) {
  assert(last_taps >= 1);
  ProtocolSteps steps;
  std::uint64_t last = 0;
  for (const Stage& stage : protocol) {
    if (stage.count == 0) continue;
    const Control current = control(stage.tap);
    if (!steps.control.empty() && steps.control != current.name) {
      return "The protocol taps in different ways (" + steps.control + ", " + current.name +
             "), whose strengths cannot be compared: use one kind of tap.";
    }
    steps.control = current.name;
    steps.units = current.units;
    steps.strengths.push_back(current.value);
    last += stage.count;
    steps.windows.push_back({last + 1 - std::min(last_taps, stage.count), last});
  }
  const auto is_same = [&](double strength) { return strength == steps.strengths.front(); };
  if (std::ranges::all_of(steps.strengths, is_same)) {
    return std::string(
        "The protocol has taps of one strength only, so there is no branch: hysteresis "
        "needs a ramp, and a loop one up and one down.");
  }
  return steps;
}

std::vector<double> means_over_rows(std::span<const double> rows, std::uint32_t realizations) {
  assert(realizations > 0 && rows.size() % realizations == 0);
  std::vector<double> means;
  for (std::uint32_t r = 0; r < realizations; ++r) {
    Moments moments;
    bool complete = true;
    for (std::size_t i = r; i < rows.size(); i += realizations) {
      complete = complete && !std::isnan(rows[i]);
      moments.add(rows[i]);
    }
    means.push_back(complete ? moments.mean() : std::nan(""));
  }
  return means;
}

}  // namespace jostle::inline ensemble
