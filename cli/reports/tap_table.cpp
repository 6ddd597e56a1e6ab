#include "cli/reports/tap_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cli/tables/text_table.hpp"
#include "cli/tables/wrapped.hpp"
#include "fitting/value_text.hpp"
#include "study/tables/points/half_widths.hpp"
#include "study/tables/repeated_series.hpp"

namespace jostle::inline cli {
namespace {

/// A column of the table; one that is not `needed` is left out where it has no room.
struct ShownColumn {
  std::string header;
  std::vector<std::string> cells;
  bool needed = true;
};

template <class CellOf>
ShownColumn shown_column(std::string header, std::span<const std::uint64_t> taps, CellOf cell) {
  ShownColumn column{std::move(header), {}};
  for (const std::uint64_t tap : taps) column.cells.push_back(cell(tap));
  return column;
}

std::string fixed(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

/// The columns of one series: its mean with its error, and with all columns sigma.
std::vector<ShownColumn> shown_columns(const EnsembleSeries& series,
                                       std::span<const std::uint64_t> taps, Columns wanted) {
  const Column& label = series.label;
  if (label.shown == Shown::mean) {
    ShownColumn mean = shown_column(label.name, taps, [&](std::uint64_t tap) {
      return fixed(series.mean[tap], label.decimals);
    });
    mean.needed = wanted == Columns::all;
    return {mean};
  }
  if (label.shown != Shown::spread) return {};
  std::vector<ShownColumn> columns{
      shown_column(label.name, taps, [&](std::uint64_t tap) { return mean_text(series, tap); })};
  if (wanted == Columns::all) {
    columns.push_back(shown_column("sigma", taps, [&](std::uint64_t tap) {
      return series.count[tap] > 1 ? number_text(series.sigma[tap], 3) : "-";
    }));
  }
  return columns;
}

std::size_t room_of(const ShownColumn& column) {
  std::size_t width = width_of(column.header);
  for (const std::string& cell : column.cells) width = std::max(width, width_of(cell));
  return width + 2;
}

/// Drops what is not needed where there is no room for all.
void make_room(std::vector<ShownColumn>& columns, std::size_t width) {
  std::size_t used = 0;
  for (const ShownColumn& column : columns) used += column.needed ? room_of(column) : 0;
  std::erase_if(columns, [&](const ShownColumn& column) {
    if (column.needed) return false;
    used += room_of(column);
    return used > width + 2;  // the first column has no gap before it
  });
}

}  // namespace

PointSeries point_series(const ResultsFile& file, std::uint32_t point,
                         std::span<const RealizationSummary> realizations) {
  const Repetitions copies = repetitions(file, point);
  PointSeries series{distinct_ensemble(file, point, copies), {}};
  series.copies = copies.text;
  for (const RealizationSummary& realization : realizations) {
    if (in_share(file.shard(), file.study(), realization.id)) ++series.planned;
    if (realization.rows == 0) continue;
    series.reached.resize(
        std::max(series.reached.size(), static_cast<std::size_t>(realization.rows)));
    ++series.reached[realization.rows - 1];  // for now, of those that end here
  }
  for (std::size_t tap = series.reached.size(); tap-- > 1;) {
    series.reached[tap - 1] += series.reached[tap];
  }
  return series;
}

std::string tap_table(const PointSeries& series, const Layout& layout) {
  const auto taps = reported_taps(series.reached.size() - 1);
  const std::vector<std::uint32_t>& reached = series.reached;
  const bool partial =
      std::ranges::any_of(taps, [&](std::uint64_t tap) { return reached[tap] != series.planned; });
  std::vector<ShownColumn> columns{
      shown_column("tap", taps, [](std::uint64_t tap) { return fmt::to_string(tap); })};
  if (partial) {
    columns.push_back(
        shown_column("M", taps, [&](std::uint64_t tap) { return fmt::to_string(reached[tap]); }));
  }
  const std::size_t keys = columns.size();
  for (const EnsembleSeries& ensemble_series : series.columns) {
    for (ShownColumn& column : shown_columns(ensemble_series, taps, layout.columns))
      columns.push_back(std::move(column));
  }
  make_room(columns, layout.table_width());
  std::vector<std::string> headers;
  for (const ShownColumn& column : columns) headers.push_back(column.header);
  TextTable table(headers, keys);
  for (std::size_t row = 0; row < taps.size(); ++row) {
    std::vector<std::string> cells;
    for (const ShownColumn& column : columns) cells.push_back(column.cells[row]);
    table.add(std::move(cells));
  }
  return table.text(layout.table_width());
}

std::vector<std::uint64_t> reported_taps(std::uint64_t last) {
  std::vector<std::uint64_t> taps{0};
  for (std::uint64_t decade = 1; decade < last; decade *= 10) {
    for (const std::uint64_t tap : {decade, 2 * decade, 5 * decade}) {
      if (tap < last) taps.push_back(tap);
    }
  }
  if (last > 0) taps.push_back(last);
  return taps;
}

}  // namespace jostle::inline cli
