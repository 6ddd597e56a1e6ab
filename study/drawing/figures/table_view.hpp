#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/drawing/drawn/drawn_results.hpp"

namespace jostle::inline study {

/// A derived table as figures read it: numbers as doubles, NaN or nothing where there are none.
class TableView {
 public:
  explicit TableView(const DrawnTable& drawn);

  bool is_in(const std::string& group, const std::string& kind) const {
    return drawn_->group == group && path_.front() == kind;
  }
  bool is_refused() const { return !note("refused").empty(); }
  /// For "point_0003/ageing/mean_height"; nothing for a table of all points.
  std::optional<std::uint32_t> point() const { return point_; }
  const std::vector<std::string>& path() const { return path_; }  // {"ageing", "mean_height"}
  const std::string& name() const { return drawn_->table.name; }
  const std::string& group() const { return drawn_->group; }
  /// The requested quantity, or else the last word of its path.
  std::string observable() const;

  std::vector<std::string> quantities() const;  // their names
  bool has(const std::string& quantity) const { return found(quantity) != nullptr; }
  bool has_axis(const std::string& name) const;
  std::vector<double> axis(const std::string& name) const;
  std::vector<std::string> axis_texts(const std::string& name) const;
  std::vector<double> values(const std::string& quantity) const;
  std::vector<std::string> texts(const std::string& quantity) const;
  double value(const std::string& quantity, std::size_t i = 0) const;
  /// Values along the last axis, at one place of the first.
  std::vector<double> row(const std::string& quantity, std::size_t i) const;
  /// Halves of the 68 % intervals of a quantity's values: of the intervals that the table has, else
  /// by its standard errors and their degrees of freedom; empty where it has neither.
  std::vector<double> half_widths(const std::string& quantity) const;
  double half_width(const std::string& quantity, std::size_t i = 0) const;
  /// Half widths along the last axis, at one place of the first.
  std::vector<double> half_width_row(const std::string& quantity, std::size_t i) const;

  std::string units(const std::string& name) const;      // units of a quantity or an axis
  std::string long_name(const std::string& name) const;  // long name of a quantity or an axis
  std::string source(const std::string& quantity) const;
  std::string note(const std::string& key) const;

 private:
  const Quantity* found(const std::string& quantity) const;
  const Quantity* found_axis(const std::string& name) const;
  const Quantity* either(const std::string& name) const;
  std::vector<double> row_of(const Quantity* quantity, std::vector<double> all,
                             std::size_t i) const;

  const DrawnTable* drawn_;
  std::optional<std::uint32_t> point_;
  std::vector<std::string> path_;
};

/// True if two tables of structure have the same settings and region. A table that does not name
/// its settings may have those of any other.
bool measured_alike(const TableView& a, const TableView& b);

}  // namespace jostle::inline study
