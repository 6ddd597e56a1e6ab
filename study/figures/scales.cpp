#include "study/figures/scales.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace jostle::inline study {
namespace {

constexpr double most_taps_of_an_even_axis = 30;

/// 1, 2 or 5 times a power of ten, so that about n of them make the length.
double even_step(double length, std::size_t n) {
  const double rough = length / static_cast<double>(n);
  const double power = std::pow(10, std::floor(std::log10(rough)));
  const double rest = rough / power;
  return power * (rest >= std::sqrt(50)   ? 10
                  : rest >= std::sqrt(10) ? 5
                  : rest >= std::sqrt(2)  ? 2
                                          : 1);
}

/// "10^{-5}" in gnuplot's notation, or "0.01" where all of an axis are handy.
std::string power_label(double value, int exponent, bool all_are_handy) {
  return all_are_handy ? fmt::format("{:g}", value) : fmt::format("10^{{{}}}", exponent);
}

std::size_t n_characters(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return c != '^' && c != '{' && c != '}'; }));
}

Scale even_scale(std::vector<double> values, bool from_zero, std::size_t most_ticks) {
  double low = values.empty() ? 0 : std::ranges::min(values);
  double high = values.empty() ? 1 : std::ranges::max(values);
  if (from_zero) {
    low = std::min(low, 0.0);
    high = std::max(high, 0.0);
  }
  // Differences of the size of rounding are none.
  if (high - low <= 1e-12 * std::max(std::abs(low), std::abs(high))) {
    const double margin = low == 0 ? 1 : std::abs(low) * 0.1;
    low = from_zero ? std::min(0.0, low - margin) : low - margin;
    high += margin;
  }
  const double fine = even_step(high - low, 2 * most_ticks);
  Scale scale{.low = std::floor(low / fine + 1e-9) * fine,
              .high = std::ceil(high / fine - 1e-9) * fine};
  // What lies on an axis, but for zero, would be hidden by it.
  const double close = 0.02 * (scale.high - scale.low);
  if (low != 0 && low - scale.low < close) scale.low -= fine;
  if (high != 0 && scale.high - high < close) scale.high += fine;
  scale.step = even_step(scale.high - scale.low, most_ticks);
  for (double k = std::ceil(scale.low / scale.step - 1e-9);
       k * scale.step <= scale.high + 1e-9 * scale.step; ++k) {
    scale.longest_label =
        std::max(scale.longest_label, fmt::format("{:.6g}", k == 0 ? 0 : k * scale.step).size());
  }
  return scale;
}

/// Ticks of an axis that is too short for decades: 1, 2, 3, 5, or even steps.
void tick_a_short_axis(Scale& scale, std::vector<Tick> handy) {
  if (handy.size() < 3) {
    handy.clear();
    const double step = even_step(scale.high - scale.low, 4);
    for (double k = std::ceil(scale.low / step); k * step <= scale.high; ++k) {
      handy.push_back({k * step, fmt::format("{:.6g}", k * step)});
    }
  }
  scale.ticks = std::move(handy);
  std::erase_if(scale.minor, [&](double at) {
    return std::ranges::any_of(
        scale.ticks, [&](const Tick& tick) { return std::abs(tick.at - at) < 1e-9 * at; });
  });
}

Scale logarithmic_scale(std::vector<double> values) {
  std::erase_if(values, [](double value) { return value <= 0; });
  if (values.empty()) values = {1, 10};
  const double low = std::ranges::min(values), high = std::ranges::max(values);
  const double margin = std::max(std::pow(high / low, 0.04), 1.02);
  Scale scale{.low = low / margin, .high = high * margin, .is_logarithmic = true};
  const int first = static_cast<int>(std::floor(std::log10(scale.low)));
  const int last = static_cast<int>(std::floor(std::log10(scale.high) + 1e-9));
  const int every = std::max(1, (last - first + 6) / 7);
  const bool are_handy = first >= -4 && last <= 3;  // the first decade may have no tick
  std::vector<Tick> decades, handy;
  for (int k = first; k <= last; ++k) {
    for (int m = 1; m < 10; ++m) {
      const double at = m * std::pow(10, k);
      if (at < scale.low || at > scale.high) continue;
      if (m == 1 && k % every == 0) {
        decades.push_back({at, power_label(at, k, are_handy)});
      } else {
        scale.minor.push_back(at);
      }
      if (m == 1 || m == 2 || m == 3 || m == 5) {
        const bool is_handy = k >= -3 && k <= 3;
        handy.push_back({at, m == 1     ? power_label(at, k, is_handy)
                             : is_handy ? fmt::format("{:g}", at)
                                        : fmt::format("{}×10^{{{}}}", m, k)});
      }
    }
  }
  scale.ticks = decades;
  if (decades.size() < 2) tick_a_short_axis(scale, std::move(handy));
  for (const Tick& tick : scale.ticks) {
    scale.longest_label = std::max(scale.longest_label, n_characters(tick.label));
  }
  return scale;
}

Scale tap_scale(double most, bool has_zero) {
  Scale scale{.low = has_zero ? 0.2 : 0.9,
              .high = most * 1.1,
              .is_logarithmic = true,
              .has_break = has_zero};
  if (has_zero) scale.ticks.push_back({place_of_tap_zero, "0"});
  for (int k = 0; std::pow(10, k) <= most * 1.001; ++k) {
    const double decade = std::pow(10, k);
    scale.ticks.push_back({decade, power_label(decade, k, most < 1e4)});
    for (int m = 2; m < 10 && m * decade <= scale.high; ++m) scale.minor.push_back(m * decade);
  }
  return scale;
}

Scale scale_of(const FigureAxis& axis, std::vector<double> values, std::size_t most_ticks) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (axis.kind == AxisKind::logarithmic) return logarithmic_scale(std::move(values));
  if (axis.kind == AxisKind::names) {
    Scale scale{.low = -0.5, .high = static_cast<double>(axis.names.size()) - 0.5};
    for (std::size_t i = 0; i < axis.names.size(); ++i) {
      scale.ticks.push_back({static_cast<double>(i), axis.names[i]});
      scale.longest_label = std::max(scale.longest_label, axis.names[i].size());
    }
    return scale;
  }
  if (axis.kind == AxisKind::taps && !values.empty()) {
    const double most = std::ranges::max(values);
    if (most > most_taps_of_an_even_axis) {
      return tap_scale(most, std::ranges::any_of(values, [](double tap) { return tap < 1; }));
    }
  }
  Scale scale = even_scale(std::move(values), axis.from_zero, most_ticks);
  if (axis.kind == AxisKind::taps && scale.step <= 1) {
    scale.step = 1;
    scale.is_whole = true;
  }
  return scale;
}

}  // namespace

double lower_end(const FigureRow& row) {
  if (std::isfinite(row.low)) return row.low;
  return std::isfinite(row.error) ? row.y - row.error : row.y;
}

double upper_end(const FigureRow& row) {
  if (std::isfinite(row.high)) return row.high;
  return std::isfinite(row.error) ? row.y + row.error : row.y;
}

Scale scale_of_x(const FigurePanel& panel, std::size_t most_ticks) {
  std::vector<double> values;
  bool has_labels = false;
  for (const FigureSeries& series : panel.series) {
    has_labels = has_labels || series.has_labels;
    for (const FigureRow& row : series.rows) {
      if (std::isfinite(row.y)) values.push_back(row.x);
    }
  }
  for (const FigureRule& rule : panel.rules) {
    if (rule.x) values.push_back(*rule.x);
  }
  if (has_labels && !values.empty()) {  // room for those at the ends
    values.push_back(std::ranges::min(values) / 1.3);
    values.push_back(std::ranges::max(values) * 1.3);
  }
  return scale_of(panel.x, std::move(values), most_ticks);
}

Scale scale_of_y(const FigurePanel& panel, std::size_t most_ticks) {
  std::vector<double> values;
  const bool is_even = panel.y.kind != AxisKind::logarithmic;
  for (const FigureSeries& series : panel.series) {
    if (!is_even && !series.has_band) continue;  // a law beside the data, of any size
    for (const FigureRow& row : series.rows) {
      if (!std::isfinite(row.x) || !std::isfinite(row.y)) continue;
      values.push_back(row.y);
      // On a logarithmic axis an error as large as the value would reach down without end.
      if (is_even || lower_end(row) > row.y / 10) values.push_back(lower_end(row));
      values.push_back(upper_end(row));
    }
  }
  for (const FigureRule& rule : panel.rules) {
    if (rule.y) values.push_back(*rule.y);
  }
  return scale_of(panel.y, std::move(values), most_ticks);
}

}  // namespace jostle::inline study
