#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "study/drawing/figures/builders.hpp"

// Plots of each part of the structure: curves at some taps, numbers against taps.
namespace jostle::inline study {

enum class Over { the_axis, its_cube };

/// A curve of a part at several taps: what is drawn, over what, on which axes.
struct PartPlot {
  const char *y, *x, *title, *x_label, *y_label;
  AxisKind y_kind = AxisKind::linear;
  bool from_zero = false;
  Drawn drawn = Drawn::line;
  AxisKind x_kind = AxisKind::linear;
  Over abscissa = Over::the_axis;
  const char* companion = nullptr;  // another curve of the same table
  const char* beside_name = "";
  std::optional<double> rule{};
  bool pooled = false;   // a ratio of sums over packings
  bool trimmed = false;  // places at both ends, where every curve is 0, are left out
  std::optional<double> x_low{};
  /// Places from which on the greatest value sets the axis: a peak before them, as of contacts, is
  /// clipped where it is much higher.
  std::optional<double> clipped_before{};
};

/// Numbers of a packing against the tap, in one figure.
struct NumberTrend {
  std::vector<const char*> names;
};

/// The plots of a part of the structure.
struct DrawnPart {
  const char* name;
  std::vector<PartPlot> plots;
  std::vector<NumberTrend> trends;  // the first two that there are
};

const std::vector<DrawnPart>& drawn_parts();

/// A curve of a part at one of its taps; the places that the plot leaves out are left out.
std::vector<FigureRow> rows_at(const TableView& table, const PartPlot& plot,
                               const std::string& quantity, bool with_errors, std::size_t place);

/// The empty panel of a plot: title, axes, source.
FigurePanel panel_of(const TableView& table, const PartPlot& plot);

/// Limits the axes of a panel: leaves out ends where every curve is 0, and clips a peak.
void finish_panel(const PartPlot& plot, FigurePanel& panel);

/// Adds, for each part that several sweep points have, its first curve at the last tap that they
/// have in common and its first number against taps, one curve for each of at most eight points.
void add_structure_of_points(const DrawnFile& file, Figures& figures);

}  // namespace jostle::inline study
