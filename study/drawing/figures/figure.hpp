#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

// The contents of a figure, independent of the program that draws it.
namespace jostle::inline study {

inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

enum class AxisKind {
  linear,
  logarithmic,
  taps,  // logarithmic with tap 0 apart; linear where there are few taps
  names
};

struct FigureAxis {
  std::string label{};  // with units; "N_c" has a subscript
  AxisKind kind = AxisKind::linear;
  bool from_zero = false;
  std::vector<std::string> names{};  // AxisKind::names: labels at 0, 1, 2, ...
  // Ends of the axis, where the data do not decide; what is drawn beyond is clipped.
  std::optional<double> low{}, high{};
};

/// A value with half its 68 % interval, or the ends of an interval; NaN where there is none.
struct FigureRow {
  double x = no_value, y = no_value;
  double error = no_value;
  double low = no_value, high = no_value;
  std::string label{};
};

/// `stepped_points`: each value holds up to the next.
enum class Drawn { line, points, joined_points, stepped_points };

/// A colour on white paper and the one that replaces it on a dark page, both "#rrggbb". People with
/// any colour vision can distinguish the colours: Okabe & Ito's for the i-th of several kinds,
/// viridis for the i-th of n that have an order.
struct FigureColour {
  std::string light{}, dark{};
};
FigureColour ink_colour();
FigureColour kind_colour(std::size_t i);
FigureColour order_colour(std::size_t i, std::size_t n);
/// Few that have an order get the colours of kinds.
FigureColour colour_of(std::size_t i, std::size_t n);

struct FigureSeries {
  std::string name{};  // empty: not in the key
  FigureColour colour{};
  Drawn drawn = Drawn::line;
  std::vector<FigureRow> rows{};
  std::size_t dash = 0;  // 0: solid
  std::size_t symbol = 0;
  bool hollow = false;
  bool has_band = true;   // a line with a band of its errors
  bool is_guide = false;  // a line for the eye: no value of the file
  bool is_thin = false;   // one realization beside the mean: a thin line, not in the key
  bool has_labels = false;
  std::optional<std::uint32_t> point{};  // the sweep point, where a figure has several
};

/// A dashed line at a place of one axis.
struct FigureRule {
  std::optional<double> x{}, y{};
};

struct FigurePanel {
  std::string title{}, caption{};
  std::string source{};  // paper and equation
  FigureAxis x{}, y{};
  std::vector<FigureRule> rules{};
  std::vector<FigureSeries> series{};
};

/// The subject of figures that show sweep points beside each other.
inline constexpr const char* comparison_subject = "comparison";

/// One panel, or several over one x axis.
struct Figure {
  std::string name;  // names its files: lower-case letters, digits and '-'
  std::vector<FigurePanel> panels{};
  std::string section{};                 // section of the page: "compaction", "ageing", ...
  std::optional<std::uint32_t> point{};  // where it shows one sweep point
  std::string subject{};                 // the table that it draws, or the observable of several
};

}  // namespace jostle::inline study
