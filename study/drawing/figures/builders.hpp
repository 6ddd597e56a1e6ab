#pragma once

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "study/drawing/figures/drawn_file.hpp"
#include "study/drawing/figures/figure.hpp"

// The figures of each section of the page, in its order. Where a section shows one sweep point at
// a time, a figure each.
namespace jostle::inline study {

using Figures = std::vector<Figure>;

void add_compaction(const DrawnFile& file, Figures& figures);
void add_spread(const DrawnFile& file, Figures& figures);
void add_fits(const DrawnFile& file, Figures& figures);
void add_steady(const DrawnFile& file, Figures& figures);
void add_ageing(const DrawnFile& file, Figures& figures);
void add_spectra(const DrawnFile& file, Figures& figures);
void add_hysteresis(const DrawnFile& file, Figures& figures);
void add_sweeps(const DrawnFile& file, Figures& figures);
void add_ordering(const DrawnFile& file, Figures& figures);
void add_motion(const DrawnFile& file, Figures& figures);
void add_volumes(const DrawnFile& file, Figures& figures);
void add_memory(const DrawnFile& file, Figures& figures);
void add_snapshots(const DrawnFile& file, Figures& figures);
void add_structure(const DrawnFile& file, Figures& figures);
void add_engine(const DrawnFile& file, Figures& figures);
void add_cost(const DrawnFile& file, Figures& figures);

/// Adds the figure of one panel; its name contains the sweep point where the file has several and
/// it shows one. `subject`: the table that it draws, or the observable of several.
void add_panel(const DrawnFile& file, std::optional<std::uint32_t> point, FigurePanel panel,
               Figures& figures, const std::string& subject = "");

/// "stretched exponential" of "kww".
std::string law_name(const std::string& model);
std::string law_name(const TableView& table);

/// The laws fitted to one curve, without those that draw the curve of another under another name.
struct FittedLaws {
  std::string observable;
  std::vector<TableView> laws;
};
std::vector<FittedLaws> fitted_laws(const std::vector<TableView>& made, std::uint32_t point);

/// One of the values, or none.
inline double value_at(const std::vector<double>& values, std::size_t i) {
  return i < values.size() ? values[i] : no_value;
}

/// A curve of every waiting time, of the rows that have a value: make_row(waiting time, lag, value
/// of the lag), both by their numbers.
template <class MakeRow>
std::vector<FigureSeries> by_waiting_time(const TableView& table, MakeRow make_row) {
  const std::vector<double> ages = table.axis("waiting_time"), lags = table.axis("lag");
  std::vector<FigureSeries> series;
  for (std::size_t k = 0; k < ages.size(); ++k) {
    FigureSeries age_series{.name = fmt::format("t_W = {}", ages[k]),
                            .colour = colour_of(k, ages.size()),
                            .drawn = Drawn::joined_points,
                            .symbol = series.size()};
    for (std::size_t j = 0; j < lags.size(); ++j) {
      FigureRow row = make_row(k, j, lags[j]);
      if (std::isfinite(row.y)) age_series.rows.push_back(std::move(row));
    }
    if (!age_series.rows.empty()) series.push_back(std::move(age_series));
  }
  return series;
}

/// The points of the tables, each once and ascending: those that get figures of their own.
std::vector<std::uint32_t> points_of(const DrawnFile& file, const std::vector<TableView>& tables);

}  // namespace jostle::inline study
