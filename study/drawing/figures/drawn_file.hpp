#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/drawing/drawn/drawn_results.hpp"
#include "study/drawing/drawn/printed_names.hpp"
#include "study/drawing/figures/figure.hpp"
#include "study/drawing/figures/table_view.hpp"

namespace jostle::inline study {

/// A sweep point in a figure with several.
struct ShownPoint {
  std::uint32_t number;
  std::string label;    // empty where the file has but one
  FigureColour colour;  // equal in every figure
};

inline constexpr std::size_t most_shown = 8;  // sweep points in one figure on paper

/// Sweep points that are drawn: of more than most_shown so many, evenly spread; or all, which a
/// page switches on and off.
enum class DrawnPoints { few, all };

/// One results file, as far as it is drawn: a chapter of the page.
class DrawnFile {
 public:
  /// `points`: the requested sweep points; empty: all that fit the room.
  DrawnFile(const ResultsFile& file, const DrawnRoom& room,
            const std::vector<std::uint32_t>& points, DrawnPoints drawn);
  /// Tables that no results file holds, as fits of a measured curve.
  explicit DrawnFile(std::vector<DrawnTable> tables);
  DrawnFile(const DrawnFile&) = delete;  // its tables look into it
  DrawnFile& operator=(const DrawnFile&) = delete;

  const std::vector<DrawnCurve>& curves() const { return curves_; }
  const std::vector<DrawnSnapshots>& snapshots() const { return snapshots_; }
  const std::vector<TableView>& tables() const { return tables_; }
  /// Tables of a kind, as "ageing" of "analysis", but for refused ones; in the order of the file.
  std::vector<TableView> made_of(const std::string& group, const std::string& kind) const;
  /// Tables of "fits", whose first word is an observable.
  std::vector<TableView> made_of(const std::string& group) const;

  /// The sweep points whose curves share one figure.
  std::vector<ShownPoint> shown_points() const;
  /// Those of the numbers that get a figure each, ascending.
  std::vector<std::uint32_t> chosen(std::vector<std::uint32_t> numbers) const;
  const DrawnCurve* curve(std::uint32_t point) const;
  /// The first curve's column of this name.
  const DrawnColumn* column(const std::string& name) const;

  std::uint32_t n_realizations() const { return n_realizations_; }
  /// True if there are more sweep points than figures show.
  bool has_other_points() const {
    return drawn_points_ == DrawnPoints::few && curves_.size() > most_shown;
  }
  std::size_t n_points() const { return labels_.size(); }
  /// The name of a sweep point: its swept values, or in a study of cost its setting.
  std::string label(std::uint32_t point) const;
  FigureAxis tap_axis() const;
  /// One sentence per omission.
  const std::vector<std::string>& left_out() const { return left_out_; }

 private:
  std::vector<std::string> left_out_;
  std::vector<DrawnCurve> curves_;
  std::vector<DrawnSnapshots> snapshots_;
  std::vector<DrawnTable> kept_;
  std::vector<std::string> labels_;
  std::vector<TableView> tables_;
  std::uint32_t n_realizations_ = 0;
  DrawnPoints drawn_points_ = DrawnPoints::few;
  bool changes_strength_ = false;
};

/// The text with a capital first letter; "Values" for an empty text.
std::string sentence(std::string text);
/// "mean height <Z> (diameter)".
std::string axis_label(const std::string& name, const std::string& units);
/// The symbol of a strength of taps: "√ε" for "sqrt_epsilon"; other quantities in words.
std::string control_symbol(const std::string& name);
/// "strength of the taps γ (diameter)".
std::string control_label(const std::string& name, const std::string& units,
                          const std::string& meaning = "strength of the taps");
/// The strength that a table has as a quantity, or an empty text.
std::string control_of(const TableView& table);
/// " (diameter)"; nothing where there is no unit.
std::string unit_text(const std::string& units);
/// One row a place; `errors` may be empty.
std::vector<FigureRow> rows_of(const std::vector<double>& xs, const std::vector<double>& ys,
                               const std::vector<double>& errors = {});
std::vector<double> as_numbers(const std::vector<std::uint64_t>& values);

}  // namespace jostle::inline study
