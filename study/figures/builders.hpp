#pragma once

#include <vector>

#include "study/figures/drawn_file.hpp"
#include "study/figures/figure.hpp"

// The figures of each section of the page, in its order. Where a section shows one sweep point at
// a time, a figure each.
namespace jostle::inline study {

using Figures = std::vector<Figure>;

void add_compaction(const DrawnFile& file, Figures& into);
void add_spread(const DrawnFile& file, Figures& into);
void add_fits(const DrawnFile& file, Figures& into);
void add_steady(const DrawnFile& file, Figures& into);
void add_ageing(const DrawnFile& file, Figures& into);
void add_spectra(const DrawnFile& file, Figures& into);
void add_hysteresis(const DrawnFile& file, Figures& into);
void add_sweeps(const DrawnFile& file, Figures& into);
void add_snapshots(const DrawnFile& file, Figures& into);
void add_structure(const DrawnFile& file, Figures& into);
void add_engine(const DrawnFile& file, Figures& into);
void add_cost(const DrawnFile& file, Figures& into);

/// The figure of one panel; its name says the sweep point where the file has several and it shows
/// one.
void add_panel(const DrawnFile& file, std::optional<std::uint32_t> point, FigurePanel panel,
               Figures& into);

/// The points of the tables, each once and ascending: those that get figures of their own.
std::vector<std::uint32_t> points_of(const DrawnFile& file, const std::vector<TableView>& tables);

}  // namespace jostle::inline study
