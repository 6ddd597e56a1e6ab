#include "cli/reports/curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "cli/tables/wrapped.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "fitting/value_text.hpp"
#include "study/tables/points/half_widths.hpp"
#include "study/tables/repeated_series.hpp"

namespace jostle::inline cli {
namespace {

constexpr std::size_t drawn_rows = 8, widest = 72;  // drawn rows of a drawing, in characters
constexpr std::size_t narrowest_drawing = 24;

/// A braille character has two by four dots.
constexpr std::size_t dots_across = 2, dots_down = 4;

std::string utf8(std::uint32_t character) {
  return {static_cast<char>(0xe0 | (character >> 12)),
          static_cast<char>(0x80 | ((character >> 6) & 0x3f)),
          static_cast<char>(0x80 | (character & 0x3f))};
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double value) {
    if (std::isnan(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// Position of a tap on the axis, from 0 to 1: tap 1 at 0, the last at 1.
double place_of(double tap, double last) {
  return last > 1 ? std::log(tap) / std::log(last) : 1;
}

/// Dots, `columns` by `lines` characters of so many dots each.
class Drawing {
 public:
  Drawing(std::size_t columns, std::size_t lines, Glyphs glyphs)
      : columns_(columns), lines_(lines), glyphs_(glyphs) {
    if (glyphs == Glyphs::ascii) across_ = dots_per_line_ = 1;
    dots_.resize(across() * dot_rows());
  }

  std::size_t across() const { return columns_ * across_; }
  std::size_t dot_rows() const { return lines_ * dots_per_line_; }
  std::size_t dots_a_column() const { return across_; }

  /// A dot in a column of dots, at a height from 0 to 1.
  void set(std::size_t x, double height) {
    const auto y = static_cast<std::size_t>(
        std::lround((1 - std::clamp(height, 0.0, 1.0)) * static_cast<double>(dot_rows() - 1)));
    dots_[y * across() + x] = 1;
  }

  std::string line(std::size_t number) const {
    std::string text;
    for (std::size_t column = 0; column < columns_; ++column) text += character(column, number);
    return text.erase(text.find_last_not_of(' ') + 1);
  }

 private:
  std::string character(std::size_t column, std::size_t line) const {
    static constexpr std::uint32_t bits[dots_down][dots_across] = {
        {0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
    std::uint32_t set = 0;
    for (std::size_t y = 0; y < dots_per_line_; ++y) {
      for (std::size_t x = 0; x < across_; ++x) {
        if (dots_[(line * dots_per_line_ + y) * across() + column * across_ + x] != 0)
          set |= bits[y][x];
      }
    }
    if (set == 0) return " ";
    return glyphs_ == Glyphs::ascii ? "*" : utf8(0x2800 + set);
  }

  std::size_t columns_, lines_;
  Glyphs glyphs_;
  std::size_t across_ = dots_across, dots_per_line_ = dots_down;
  std::vector<char> dots_;
};

/// The curve as straight lines between its taps, in columns of dots from `first` on.
void draw(Drawing& drawing, std::span<const double> values, const Range& range, std::size_t first) {
  const double height = range.high > range.low ? range.high - range.low : 1;
  const auto height_of = [&](double value) { return (value - range.low) / height; };
  const auto span = static_cast<double>(drawing.across() - 1 - first);
  const auto last = static_cast<double>(values.size() - 1);
  if (!std::isnan(values[0])) drawing.set(0, height_of(values[0]));
  double x_before = -1, y_before = 0;
  for (std::size_t tap = 1; tap < values.size(); ++tap) {
    if (std::isnan(values[tap])) continue;
    const double x = place_of(static_cast<double>(tap), last) * span, y = height_of(values[tap]);
    if (x_before >= 0) {
      for (double column = std::ceil(x_before); column < x; ++column) {
        const double share = x > x_before ? (column - x_before) / (x - x_before) : 0;
        drawing.set(first + static_cast<std::size_t>(column), y_before + share * (y - y_before));
      }
    }
    drawing.set(first + static_cast<std::size_t>(std::lround(x)), y);
    x_before = x;
    y_before = y;
  }
}

/// "0  1      10      100 ...  1000": the last tap at the end, decades where there is room.
std::string axis_of_taps(std::size_t columns, std::size_t first, std::size_t last) {
  std::string axis(columns, ' ');
  const auto put = [&](std::size_t centre, const std::string& text) {
    const std::size_t half = text.size() / 2;
    const std::size_t start = std::min(centre > half ? centre - half : 0, columns - text.size());
    const std::size_t begin = start > 0 ? start - 1 : 0;
    const std::size_t end = std::min(start + text.size() + 1, columns);
    if (axis.substr(begin, end - begin).find_first_not_of(' ') != std::string::npos) return;
    axis.replace(start, text.size(), text);
  };
  put(0, "0");
  put(columns - 1, fmt::to_string(last));
  for (std::size_t tap = 1; tap < last; tap *= 10) {
    const double place = place_of(static_cast<double>(tap), static_cast<double>(last));
    const auto span = static_cast<double>(columns - 1 - first);
    put(first + static_cast<std::size_t>(std::lround(place * span)), fmt::to_string(tap));
  }
  return axis;
}

std::size_t chosen_column(const std::vector<EnsembleSeries>& columns) {
  const auto is_fraction = [](const EnsembleSeries& series) {
    return series.label.shown == Shown::spread && series.label.name.ends_with("fraction");
  };
  const auto found = std::ranges::find_if(columns, is_fraction);
  return found == columns.end() ? 0 : static_cast<std::size_t>(found - columns.begin());
}

/// Up to the last tap that has a value.
std::vector<double> curve_of(const EnsembleSeries& series) {
  std::vector<double> values = series.mean;
  while (!values.empty() && std::isnan(values.back())) values.pop_back();
  return values;
}

/// A line a sweep point.
std::string lines_of_points(const ResultsFile& file, std::size_t width, Glyphs glyphs) {
  constexpr std::size_t most_points = 40, longest_line = 24;
  const std::size_t n_points = std::min(file.study().points.size(), most_points);
  std::vector<std::vector<double>> curves;
  std::vector<std::string> labels, ends;
  std::string name;
  Range range;
  std::size_t longest = 0;
  for (std::uint32_t point = 0; point < n_points; ++point) {
    const std::vector<EnsembleSeries> columns =
        distinct_ensemble(file, point, repetitions(file, point));
    if (columns.empty()) continue;  // not begun
    const EnsembleSeries& series = columns[chosen_column(columns)];
    name = series.label.name;
    curves.push_back(curve_of(series));
    for (const double value : curves.back()) range.add(value);
    const std::size_t n = curves.back().size();
    ends.push_back(n == 0 ? "-" : mean_text(series, n - 1));
    labels.push_back(file.study().points[point].label);
    longest = std::max(longest, width_of(labels.back()));
  }
  if (!(range.low < range.high)) return "";
  longest = std::min(longest, width / 2);
  std::string text =
      wrapped(finite_text("{} over log tap, from {:.4g} to {:.4g}, and its last value:\n", name,
                          range.low, range.high),
              width);
  for (std::size_t point = 0; point < curves.size(); ++point) {
    const std::string line = sparkline(curves[point], range.low, range.high, longest_line, glyphs);
    std::string label(first_characters(labels[point], longest));
    label.append(longest - width_of(label), ' ');
    const std::string blanks(longest_line - width_of(line), ' ');
    text += fmt::format("  {}  {}{}  {}\n", label, line, blanks, ends[point]);
  }
  if (n_points < file.study().points.size())
    text += fmt::format("  ... and {} more\n", file.study().points.size() - n_points);
  return text;
}

}  // namespace

std::string curve_text(const std::string& name, std::span<const double> values, std::size_t width,
                       Glyphs glyphs) {
  Range range;
  for (const double value : values) range.add(value);
  const auto n = std::ranges::count_if(values, [](double value) { return !std::isnan(value); });
  const std::string top = number_text(range.high, 4), bottom = number_text(range.low, 4);
  const std::size_t margin = std::max(top.size(), bottom.size()) + 1;
  width = std::min(width, widest);
  if (n < 3 || width < margin + narrowest_drawing) return "";
  const std::size_t columns = width - margin, first = 3;  // columns of tap 1
  Drawing drawing(columns, drawn_rows, glyphs);
  draw(drawing, values, range, first * drawing.dots_a_column());
  std::string text = name + " over taps\n";
  for (std::size_t line = 0; line < drawn_rows; ++line) {
    const std::string label = line == 0 ? top : line + 1 == drawn_rows ? bottom : "";
    text += fmt::format("{:>{}} {}\n", label, margin - 1, drawing.line(line));
  }
  return text + fmt::format("{:>{}} {}\n", "", margin - 1,
                            axis_of_taps(columns, first, values.size() - 1));
}

std::string sparkline(std::span<const double> values, double low, double high, std::size_t width,
                      Glyphs glyphs) {
  constexpr std::string_view plain = "_.-=+*#%";  // one per block
  constexpr std::uint32_t lowest_block = 0x2581;
  if (values.empty()) return "";
  const auto last = static_cast<double>(values.size() - 1);
  std::string text;
  for (std::size_t column = 0; column < width; ++column) {
    const double share = static_cast<double>(column) / static_cast<double>(width - 1);
    // Tap 0, then from tap 1 on logarithmically.
    const double tap =
        column == 0 ? 0 : std::min(std::round(std::pow(std::max(last, 1.0), share)), last);
    const double value = values[static_cast<std::size_t>(tap)];
    if (std::isnan(value)) {
      text += ' ';
      continue;
    }
    const double height = std::clamp((value - low) / (high - low), 0.0, 1.0);
    const auto level = static_cast<std::uint32_t>(std::lround(height * 7));
    text += glyphs == Glyphs::ascii ? std::string(1, plain[level]) : utf8(lowest_block + level);
  }
  return text;
}

std::string compaction_curves(const ResultsFile& file, std::size_t width, Glyphs glyphs) {
  if (file.study().points.size() > 1) return lines_of_points(file, width, glyphs);
  const std::vector<EnsembleSeries> columns = distinct_ensemble(file, 0, repetitions(file, 0));
  if (columns.empty()) return "";
  const EnsembleSeries& series = columns[chosen_column(columns)];
  return curve_text(series.label.name, curve_of(series), width, glyphs);
}

}  // namespace jostle::inline cli
