#include "config/grids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/number_reading.hpp"

namespace jostle::inline config {

namespace {

/// x^(1/n) of 10 by Newton's method from above, in the same bits on every machine.
double root_of_ten(std::uint32_t n) {
  double root = 10;
  for (;;) {
    double power = 1;  // root^(n - 1)
    for (std::uint32_t i = 1; i < n; ++i) power *= root;
    const double next = root - (root * power - 10) / (n * power);
    if (!(next < root)) return root;
    root = next;
  }
}

/// The tap with another strength.
Tap with_strength(Tap tap, double strength) {
  jostle::strength(tap) = strength;
  return tap;
}

std::vector<std::uint64_t> logarithmic(const LogarithmicTaps& grid) {
  const double root = root_of_ten(grid.per_decade);
  std::vector<std::uint64_t> taps = grid.also;
  double decade = static_cast<double>(grid.first);
  while (decade <= static_cast<double>(grid.last)) {
    double value = decade;
    for (std::uint32_t i = 0; i < grid.per_decade; ++i, value *= root) {
      const double tap = std::floor(value + 0.5);
      if (tap <= static_cast<double>(grid.last)) taps.push_back(static_cast<std::uint64_t>(tap));
    }
    decade *= 10;
  }
  return taps;
}

}  // namespace

double rounded_to_15_digits(double value) {
  const std::string text = fmt::format("{:.15g}", value);
  double rounded = value;
  read_decimal(text.data(), text.data() + text.size(), rounded);
  return rounded;
}

std::optional<std::uint64_t> whole_steps(const Ramp& ramp) {
  const double steps = std::abs(ramp.end - ramp.start) / ramp.step;
  const double whole = std::floor(steps + 0.5);
  if (!(std::abs(steps - whole) <= 1e-6) || !(whole < 1e15)) return std::nullopt;
  return static_cast<std::uint64_t>(whole);
}

std::vector<double> strengths(const Ramp& ramp) {
  const std::uint64_t steps = whole_steps(ramp).value_or(0);
  std::vector<double> values;
  for (std::uint64_t k = 0; k <= steps; ++k) {
    const double weight = static_cast<double>(k), rest = static_cast<double>(steps - k);
    double value = ramp.start;
    if (k == steps && steps > 0) {
      value = ramp.end;
    } else if (k > 0) {
      value = rounded_to_15_digits((ramp.start * rest + ramp.end * weight) / (rest + weight));
    }
    values.push_back(ramp.scale == RampScale::square_root ? value * value : value);
  }
  return values;
}

std::vector<Stage> stages(const std::vector<ProtocolLine>& protocol) {
  std::vector<Stage> stages;
  for (const ProtocolLine& line : protocol) {
    if (line.count == 0) continue;
    if (!line.ramp) {
      stages.push_back({line.tap, line.count});
      continue;
    }
    for (const double strength : strengths(*line.ramp)) {
      stages.push_back({with_strength(line.tap, strength), line.count});
    }
  }
  return stages;
}

std::uint64_t total_taps(const std::vector<ProtocolLine>& protocol) {
  std::uint64_t taps = 0;
  for (const ProtocolLine& line : protocol) {
    taps += line.count * (line.ramp ? whole_steps(*line.ramp).value_or(0) + 1 : 1);
  }
  return taps;
}

std::vector<std::uint64_t> chosen_taps(const TapChoice& choice) {
  const auto* grid = std::get_if<LogarithmicTaps>(&choice);
  std::vector<std::uint64_t> taps =
      grid ? logarithmic(*grid) : std::get<std::vector<std::uint64_t>>(choice);
  std::sort(taps.begin(), taps.end());
  taps.erase(std::unique(taps.begin(), taps.end()), taps.end());
  return taps;
}

std::vector<std::uint64_t> snapshot_taps(const SnapshotChoice& choice, std::uint64_t taps) {
  std::vector<std::uint64_t> chosen = chosen_taps(choice.taps);
  if (!choice.every) return chosen;
  std::uint64_t n = 0;
  for (std::uint64_t tap = 0; tap <= taps && n <= most_snapshots_by_rule; ++n, tap += *choice.every)
    chosen.push_back(tap);
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

}  // namespace jostle::inline config
