#include "study/drawing/figures/drawn_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/taps.hpp"
#include "structure/observables.hpp"
#include "study/drawing/drawn/point_labels.hpp"
#include "study/drawing/drawn/thinning.hpp"

namespace jostle::inline study {
namespace {

constexpr std::array<std::array<int, 3>, 10> viridis_stops{{{68, 1, 84},
                                                            {72, 40, 120},
                                                            {62, 74, 137},
                                                            {49, 104, 142},
                                                            {38, 130, 142},
                                                            {31, 158, 137},
                                                            {53, 183, 121},
                                                            {110, 206, 88},
                                                            {181, 222, 43},
                                                            {253, 231, 37}}};

std::string viridis(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * (viridis_stops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(place), viridis_stops.size() - 2);
  std::string text = "#";
  for (std::size_t k = 0; k < 3; ++k) {
    const double low = viridis_stops[i][k], high = viridis_stops[i + 1][k];
    text += fmt::format("{:02x}", std::lround(low + (high - low) * (place - double(i))));
  }
  return text;
}

}  // namespace

FigureColour ink_colour() {
  return {"#222222", "#dedede"};
}

FigureColour kind_colour(std::size_t i) {
  static constexpr std::array<std::array<const char*, 2>, 8> kinds{{{"#0072b2", "#56b4e9"},
                                                                    {"#d55e00", "#f0803c"},
                                                                    {"#009e73", "#2cc295"},
                                                                    {"#b0578d", "#e29ac4"},
                                                                    {"#b07800", "#e6b23c"},
                                                                    {"#3a93c4", "#9ad4f5"},
                                                                    {"#555555", "#b8b8b8"},
                                                                    {"#7a5195", "#b79be0"}}};
  return {kinds[i % kinds.size()][0], kinds[i % kinds.size()][1]};
}

FigureColour order_colour(std::size_t i, std::size_t n) {
  const double share = n < 2 ? 0.5 : static_cast<double>(i) / static_cast<double>(n - 1);
  // Without the lightest on paper and the darkest on a dark page: they would not be visible.
  return {viridis(0.02 + 0.78 * share), viridis(0.28 + 0.68 * share)};
}

FigureColour colour_of(std::size_t i, std::size_t n) {
  return n <= 4 ? kind_colour(i) : order_colour(i, n);
}

DrawnFile::DrawnFile(const ResultsFile& file, const DrawnRoom& room,
                     const std::vector<std::uint32_t>& points, DrawnPoints drawn)
    : curves_(drawn_curves(file, room, points, left_out_)),
      snapshots_(drawn_snapshots(file, points, left_out_)),
      kept_(study::drawn_tables(file, room, points, left_out_)),
      labels_(shown_labels(file.study())),
      n_realizations_(file.study().realizations),
      drawn_points_(drawn),
      changes_strength_(changes_strength(file)) {
  for (const DrawnTable& table : kept_) tables_.emplace_back(table);
  for (const TableView& table : tables_) {  // in a study of cost, the points are settings
    if (table.is_in("analysis", "cost") && table.axis_texts("setting").size() == labels_.size()) {
      labels_ = table.axis_texts("setting");
      break;
    }
  }
  if (has_other_points()) {
    left_out_.push_back(
        fmt::format("{} of {} sweep points are drawn, evenly spread", most_shown, labels_.size()));
  }
}

DrawnFile::DrawnFile(std::vector<DrawnTable> tables) : kept_(std::move(tables)), labels_{""} {
  for (const DrawnTable& table : kept_) tables_.emplace_back(table);
}

std::vector<TableView> DrawnFile::made_of(const std::string& group, const std::string& kind) const {
  std::vector<TableView> made;
  for (const TableView& table : tables_) {
    if (table.is_in(group, kind) && !table.is_refused()) made.push_back(table);
  }
  return made;
}

std::vector<TableView> DrawnFile::made_of(const std::string& group) const {
  std::vector<TableView> made;
  for (const TableView& table : tables_) {
    if (table.group() == group && !table.is_refused()) made.push_back(table);
  }
  return made;
}

std::string DrawnFile::label(std::uint32_t point) const {
  if (point < labels_.size() && !labels_[point].empty()) return labels_[point];
  return fmt::format("point {}", point);
}

std::vector<ShownPoint> DrawnFile::shown_points() const {
  std::vector<ShownPoint> shown;
  const std::size_t most = drawn_points_ == DrawnPoints::few ? most_shown : curves_.size();
  for (const std::size_t i : evenly_spread(curves_.size(), std::max<std::size_t>(1, most))) {
    const std::uint32_t point = curves_[i].point;
    shown.push_back({point, labels_.size() > 1 ? label(point) : "", colour_of(i, curves_.size())});
  }
  return shown;
}

std::vector<std::uint32_t> DrawnFile::chosen(std::vector<std::uint32_t> numbers) const {
  std::ranges::sort(numbers);
  const auto repeated = std::ranges::unique(numbers);
  numbers.erase(repeated.begin(), repeated.end());
  return drawn_points_ == DrawnPoints::few ? spread(numbers, most_shown) : numbers;
}

const DrawnCurve* DrawnFile::curve(std::uint32_t point) const {
  const auto found = std::ranges::find(curves_, point, &DrawnCurve::point);
  return found == curves_.end() ? nullptr : &*found;
}

const DrawnColumn* DrawnFile::column(const std::string& name) const {
  for (const DrawnCurve& curve : curves_) {
    for (const DrawnColumn& column : curve.columns) {
      if (column.label.name == name) return &column;
    }
  }
  return nullptr;
}

FigureAxis DrawnFile::tap_axis() const {
  return {"taps t", changes_strength_ ? AxisKind::linear : AxisKind::taps};
}

std::string sentence(std::string text) {
  if (text.empty()) return "Values";
  if (text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string unit_text(const std::string& units) {
  if (units.empty() || units == "1") return "";
  std::string text = units;
  if (const std::size_t end = text.find(")^"); text.starts_with('(') && end != std::string::npos) {
    text = text.substr(1, end - 1) + text.substr(end + 1);  // "(diameter)^2"
  }
  for (const auto& [power, sign] : {std::pair{"^2", "²"}, std::pair{"^3", "³"}}) {
    for (std::size_t index = 0; (index = text.find(power)) != std::string::npos;) {
      text.replace(index, 2, sign);
    }
  }
  return " (" + text + ")";
}

std::string axis_label(const std::string& name, const std::string& units) {
  const std::string_view symbol = observable_symbol(name);
  return fmt::format("{}{}{}{}", words(name), symbol.empty() ? "" : " ", symbol, unit_text(units));
}

namespace {

std::string_view symbol_of_control(const std::string& name) {
  for (const ControlSymbol& control : control_symbols())
    if (control.name == name) return control.symbol;
  return {};
}

}  // namespace

std::string control_symbol(const std::string& name) {
  const std::string_view symbol = symbol_of_control(name);
  return symbol.empty() ? words(name) : std::string(symbol);
}

std::string control_label(const std::string& name, const std::string& units,
                          const std::string& meaning) {
  const std::string_view symbol = symbol_of_control(name);
  return (symbol.empty() ? words(name) : fmt::format("{} {}", meaning, symbol)) + unit_text(units);
}

std::string control_of(const TableView& table) {
  for (const ControlSymbol& control : control_symbols()) {
    if (table.has(std::string(control.name))) return std::string(control.name);
  }
  return "";
}

std::vector<FigureRow> rows_of(const std::vector<double>& xs, const std::vector<double>& ys,
                               const std::vector<double>& errors) {
  std::vector<FigureRow> rows;
  for (std::size_t i = 0; i < std::min(xs.size(), ys.size()); ++i) {
    rows.push_back({.x = xs[i], .y = ys[i], .error = i < errors.size() ? errors[i] : no_value});
  }
  return rows;
}

std::vector<double> as_numbers(const std::vector<std::uint64_t>& values) {
  return {values.begin(), values.end()};
}

}  // namespace jostle::inline study
