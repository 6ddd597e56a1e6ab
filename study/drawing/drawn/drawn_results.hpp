#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ensemble/analysis/table.hpp"
#include "results/file/results_file.hpp"

// The part of a results file that the page and the figures draw.
namespace jostle::inline study {

/// Numbers that are drawn of one file.
struct DrawnRoom {
  std::size_t curve_values = 220'000;
  std::size_t table_values = 220'000;  // and texts

  /// Several files share it.
  static DrawnRoom of_one_in(std::size_t n_files);
};

/// A column of one realization at the taps of a curve.
struct DrawnRealization {
  std::uint32_t number = 0;
  std::vector<double> values;
};

/// A column of the ensemble at the taps of its curve.
struct DrawnColumn {
  Column label;
  bool is_observable = false;                   // else a diagnostic of the engine
  std::vector<double> mean, half_width, sigma;  // half_width: of the mean's 68 % interval
  std::vector<std::uint32_t> count;
  std::vector<DrawnRealization> realizations;  // some of them, where few curves are drawn
};

struct DrawnCurve {
  std::uint32_t point = 0;
  std::vector<std::size_t> taps;  // ascending, the first and the last among them
  std::vector<DrawnColumn> columns;
};

/// n(z) at a tap: fractions of all centres in bins of height, means over realizations.
struct DrawnHeights {
  std::uint64_t tap = 0;
  std::vector<double> n;
};

/// Quantities of the snapshots of a sweep point beside positions, as means over realizations.
struct DrawnSnapshots {
  std::uint32_t point = 0;
  std::vector<std::uint64_t> taps;
  std::vector<double> coordination, coordination_half_width;  // [taps]
  double bin_width = 0;  // diameters; a multiple of the stored one where those were many
  std::vector<DrawnHeights> heights;
};

/// A derived table, and the group that it is kept in.
struct DrawnTable {
  std::string group;
  Table table;
};

/// Realizations of a sweep point that have taps and did not fail, ascending: of a share or an
/// unfinished run not all that were planned.
std::vector<std::uint32_t> realizations_with_taps(const ResultsFile& file, std::uint32_t point);

/// Requested sweep points; empty: all.
using WantedPoints = std::vector<std::uint32_t>;

/// Curves of the sweep points that have values. To fit the room, curves are first thinned, then
/// omitted at some points, evenly spread. `left_out` receives a sentence per omission.
std::vector<DrawnCurve> drawn_curves(const ResultsFile& file, const DrawnRoom& room,
                                     const WantedPoints& wanted,
                                     std::vector<std::string>& left_out);

/// Snapshots of at most 24 sweep points and 64 realizations each, with at most 6 histograms.
std::vector<DrawnSnapshots> drawn_snapshots(const ResultsFile& file, const WantedPoints& wanted,
                                            std::vector<std::string>& left_out);

/// The derived tables, with at most about `room` numbers and texts. To fit, they are first thinned
/// along their axes, then omitted at some sweep points, evenly spread. `left_out` receives a
/// sentence per omission.
std::vector<DrawnTable> drawn_tables(const ResultsFile& file, const DrawnRoom& room,
                                     const WantedPoints& wanted,
                                     std::vector<std::string>& left_out);

/// True if the strength of the taps changes during the protocol: later taps then count as much as
/// early ones.
bool changes_strength(const ResultsFile& file);

}  // namespace jostle::inline study
