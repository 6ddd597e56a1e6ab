#include "study/drawing/figures/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "study/drawing/drawn/thinning.hpp"
#include "study/drawing/figures/builders.hpp"

namespace jostle::inline study {
namespace {

bool has_values(const FigurePanel& panel) {
  return std::ranges::any_of(panel.series, [](const FigureSeries& series) {
    return std::ranges::any_of(series.rows, [](const FigureRow& row) {
      return std::isfinite(row.x) && std::isfinite(row.y);
    });
  });
}

/// Two texts may give one word: the second gets a number.
void name_apart(Figures& figures) {
  std::set<std::string> taken;
  for (Figure& figure : figures) {
    std::string name = figure.name;
    for (int n = 2; !taken.insert(name).second; ++n) name = fmt::format("{}-{}", figure.name, n);
    figure.name = name;
  }
}

}  // namespace

std::string file_word(const std::string& text) {
  constexpr std::size_t longest = 80;
  std::string word;
  for (char c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    const bool is_kept = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (is_kept) {
      word += c;
    } else if (!word.empty() && word.back() != '-') {
      word += '-';
    }
  }
  word.resize(std::min(word.size(), longest));
  while (word.ends_with('-')) word.pop_back();
  return word.empty() ? "figure" : word;
}

void add_panel(const DrawnFile& file, std::optional<std::uint32_t> point, FigurePanel panel,
               Figures& figures, const std::string& subject) {
  if (!has_values(panel)) return;
  const std::string number =
      point && file.n_points() > 1 ? fmt::format("-point-{:04}", *point) : "";
  const std::string name = file_word(panel.title) + number;
  if (!number.empty()) panel.caption += fmt::format(" Sweep point {}.", file.label(*point));
  panel.caption = in_print(panel.caption);
  figures.push_back({.name = name, .point = point, .subject = subject});
  figures.back().panels.push_back(std::move(panel));
}

std::vector<std::uint32_t> points_of(const DrawnFile& file, const std::vector<TableView>& tables) {
  std::vector<std::uint32_t> points;
  for (const TableView& table : tables) {
    if (table.point()) points.push_back(*table.point());
  }
  return file.chosen(std::move(points));
}

DrawnFigures figures_of(const ResultsFile& file, const std::vector<std::uint32_t>& points,
                        std::size_t n_files) {
  const DrawnFile drawn(file, DrawnRoom::of_one_in(n_files), points, DrawnPoints::few);
  return {figures_of(drawn), drawn.left_out(), drawn.has_other_points()};
}

std::vector<Figure> figures_of(const DrawnFile& file) {
  struct Section {
    const char* name;
    void (*add)(const DrawnFile&, Figures&);
  };
  constexpr Section sections[] = {{"compaction", add_compaction},
                                  {"spread", add_spread},
                                  {"fits", add_fits},
                                  {"steady", add_steady},
                                  {"ageing", add_ageing},
                                  {"spectra", add_spectra},
                                  {"hysteresis", add_hysteresis},
                                  {"sweep", add_sweeps},
                                  {"ordering", add_ordering},
                                  {"motion", add_motion},
                                  {"volumes", add_volumes},
                                  {"memory", add_memory},
                                  {"snapshots", add_snapshots},
                                  {"structure", add_structure},
                                  {"engine", add_engine},
                                  {"cost", add_cost}};
  Figures figures;
  for (const Section& section : sections) {
    const std::size_t n_before = figures.size();
    section.add(file, figures);
    for (std::size_t i = n_before; i < figures.size(); ++i) {
      if (figures[i].section.empty()) figures[i].section = section.name;
    }
  }
  name_apart(figures);
  return figures;
}

DrawnFigures figures_of(const FittedCurve& measured) {
  constexpr TableThinning thinning{.whole = 400};
  FittedCurve named = measured;
  named.source.observable = "X";
  std::vector<DrawnTable> tables;
  for (Table& table : fit_tables(named, {})) {
    const bool is_mean = measured.source.curve.n_realizations > 0;
    const bool has_errors = !measured.source.curve.sigma.empty();
    table.notes.emplace_back("measured", is_mean      ? "realizations"
                                         : has_errors ? "errors"
                                                      : "values");
    table.notes.emplace_back("t_unit", measured.source.units.t);
    table.notes.emplace_back("x_unit", measured.source.units.x);
    tables.push_back({"fits", thinned(table, thinning)});
  }
  return {figures_of(DrawnFile(std::move(tables))), {}, false};
}

}  // namespace jostle::inline study
