#include "ensemble/analysis/memory/memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "engine/numbers.hpp"
#include "ensemble/moments.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "ensemble/statistics/jackknife.hpp"

namespace jostle::inline ensemble {

namespace {

/// The intercept at 0 of a straight line through (x, y), with its error by the scatter about it;
/// the mean where x is 0 throughout. None where x is one other value.
void fit_intercept(std::span<const double> x, std::span<const double> y,
                   AlignedDifference& target) {
  Moments x_all, y_all;
  for (const double value : x) x_all.add(value);
  for (const double value : y) y_all.add(value);
  const auto n = static_cast<double>(x.size());
  const double s_xx = n * x_all.sigma() * x_all.sigma();
  const bool varies = s_xx > 0;
  double s_xy = 0, squares = 0;
  for (std::size_t r = 0; r < x.size(); ++r) s_xy += (x[r] - x_all.mean()) * (y[r] - y_all.mean());
  const double slope = varies ? s_xy / s_xx : 0;
  target.value = y_all.mean() - slope * x_all.mean();
  if (!varies && x_all.mean() != 0) target.value = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t r = 0; r < x.size(); ++r) {
    const double left = y[r] - y_all.mean() - slope * (x[r] - x_all.mean());
    squares += left * left;
  }
  const double dof = n - (varies ? 2 : 1);
  if (!(dof >= 1)) return;
  const double leverage = 1 / n + (varies ? x_all.mean() * x_all.mean() / s_xx : 0);
  target.error = {std::sqrt(squares / dof * leverage), dof};
}

}  // namespace

std::vector<LagWindow> lag_windows(std::uint64_t last) {
  std::vector<std::uint64_t> ends;
  for (std::uint64_t decade = 1; decade < last; decade *= 10) {
    ends.push_back(decade);
    if (3 * decade < last) ends.push_back(3 * decade);
  }
  ends.push_back(last);
  return lag_windows(ends);
}

std::vector<LagWindow> lag_windows(std::span<const std::uint64_t> ends) {
  std::vector<LagWindow> windows;
  for (const std::uint64_t end : ends)
    windows.push_back({windows.empty() ? 1 : windows.back().last + 1, end});
  return windows;
}

MemoryTest memory_test(std::span<const History> histories, std::vector<LagWindow> windows) {
  assert(histories.size() >= 2);
  const std::size_t realizations = histories.front().at_switch.size();
  MemoryTest test;
  test.windows = std::move(windows);
  test.realizations = realizations;
  const auto response = [&](const History& history, std::size_t w, std::size_t r) {
    return history.responses[w * realizations + r] - history.at_switch[r];
  };
  for (const History& history : histories) test.strengths.push_back(history.strength);
  for (std::size_t i = 0; i < histories.size(); ++i) {
    for (std::size_t w = 0; w < test.windows.size(); ++w) {
      Moments mean;
      for (std::size_t r = 0; r < realizations; ++r) mean.add(response(histories[i], w, r));
      test.response = std::max(test.response, std::abs(mean.mean()));
    }
    for (std::size_t j = i + 1; j < histories.size(); ++j) {
      std::vector<double> x(realizations), y(realizations);
      for (std::size_t w = 0; w < test.windows.size(); ++w) {
        for (std::size_t r = 0; r < realizations; ++r) {
          x[r] = histories[j].at_switch[r] - histories[i].at_switch[r];
          y[r] = response(histories[j], w, r) - response(histories[i], w, r);
        }
        AlignedDifference& found =
            test.differences.emplace_back(AlignedDifference{.first = i, .second = j, .window = w});
        fit_intercept(x, y, found);
        found.p = p_value(found.value, found.error);
      }
    }
  }
  std::vector<double> p;
  for (const AlignedDifference& found : test.differences) p.push_back(found.p);
  p = corrected_for_number(p);
  const double level = MemoryTest::level / static_cast<double>(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    AlignedDifference& found = test.differences[i];
    found.corrected = p[i];
    found.detectable = !std::isnan(found.p)
                           ? found.error.error * smallest_effect_found(level, found.error.dof)
                           : infinite;
  }
  return test;
}

double MemoryTest::detectable() const {
  return std::ranges::max(differences, {}, &AlignedDifference::detectable).detectable;
}

std::string MemoryTest::name_of(std::size_t history) const {
  const double strength = strengths[history];
  std::string name = finite_text("{:.4g}", strength);
  if (std::ranges::count(strengths, strength) > 1) name += fmt::format(" (number {})", history);
  return name;
}

std::string MemoryTest::statement(const std::string& observable, const std::string& units,
                                  const std::string& control) const {
  const std::string unit = units == "1" || units.empty() ? "" : " " + units;
  if (realizations < 3)
    return fmt::format("cannot decide with {} realization{}: errors need three", realizations,
                       realizations == 1 ? "" : "s");
  if (response == 0)
    return fmt::format("cannot decide: {} does not change after the switch of {}", observable,
                       control);
  const auto key = [](const AlignedDifference& d) {
    return std::isnan(d.corrected) ? 2 : d.corrected;
  };
  const AlignedDifference& found = *std::ranges::min_element(differences, {}, key);
  if (found.corrected < level) {
    const LagWindow& window = windows[found.window];
    return finite_text(
        "{} alone is not the state: after {} {} and {} responses differ by {:+.3g} +- {:.2g}{} "
        "(68 %) at lags {} to {} taps ({}, {} tests together, {} realizations)",
        observable, control, name_of(found.first), name_of(found.second), found.value,
        student_half_width(found.error.error, static_cast<std::size_t>(found.error.dof) + 1), unit,
        window.first, window.last, plain_p_text(found.corrected), differences.size(), realizations);
  }
  const AlignedDifference& unseen =
      *std::ranges::max_element(differences, {}, &AlignedDifference::detectable);
  if (!std::isfinite(unseen.detectable)) {
    return fmt::format(
        "cannot decide: {} {} by the same amount in every realization between {} {} and {}, so "
        "that the difference at equal value has no error",
        observable, std::isnan(unseen.value) ? "at the switch differs" : "after the switch differs",
        control, name_of(unseen.first), name_of(unseen.second));
  }
  const double seen = unseen.detectable;
  if (!(seen <= response)) {
    return finite_text(
        "cannot decide with {} realizations: {}, but only a difference of {:.2g}{} "
        "would have been found with 80 % at all lags, and the whole response is {:.2g}{}",
        realizations, plain_p_text(found.corrected), seen, unit, response, unit);
  }
  return finite_text(
      "no memory found: {} ({} tests together, {} realizations); a difference of {:.2g}{} "
      "would have been found with 80 % at any lag, the whole response is {:.2g}{}",
      plain_p_text(found.corrected), differences.size(), realizations, seen, unit, response, unit);
}

}  // namespace jostle::inline ensemble
