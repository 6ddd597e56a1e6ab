#include "cli/tables/table_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "cli/tables/table_blocks.hpp"
#include "cli/tables/text_table.hpp"
#include "cli/tables/wrapped.hpp"
#include "config/json/json_text.hpp"
#include "ensemble/statistics/counted.hpp"
#include "fitting/value_text.hpp"
#include "study/tables/points/half_widths.hpp"

namespace jostle::inline cli {
namespace {

constexpr std::size_t most_rows = 24, most_rows_of_many_axes = 12;
constexpr std::size_t most_words = 1500;  // characters of a column of sentences
constexpr std::size_t longest_cell = 24;

constexpr const char* interval_endings[] = {"_error", "_low_68", "_high_68", "_low_95", "_high_95"};

bool is_probability(const std::string& name) {
  return name.ends_with("_p") || name.ends_with("_p_corrected");
}

/// Values without an error have four digits; whole numbers have all.
std::string plain_number(double number, const std::string& name) {
  const bool whole = number == std::trunc(number) && std::abs(number) < 1e7;
  if (is_probability(name) && (!whole || number == 0)) return probability_text(number);
  return number_text(number, whole ? 7 : 4);
}

std::string shown_cell(const Quantity& quantity, std::size_t index) {
  if (const auto* numbers = std::get_if<std::vector<double>>(&quantity.values)) {
    return plain_number(numbers->at(index), quantity.name);
  }
  if (const auto* counts = std::get_if<std::vector<std::uint64_t>>(&quantity.values)) {
    return fmt::to_string(counts->at(index));
  }
  return std::get<std::vector<std::string>>(quantity.values).at(index);
}

double largest_of(const Quantity& quantity) {
  const auto* numbers = std::get_if<std::vector<double>>(&quantity.values);
  double largest = 0;
  if (numbers == nullptr) return largest;
  for (const double number : *numbers) {
    if (std::isfinite(number)) largest = std::max(largest, std::abs(number));
  }
  return largest;
}

/// The size of what a quantity measures, beside which its rounding noise is 0: its largest number,
/// that of the table's value of the same unit, and, unless it has no unit, that of every quantity
/// of the unit.
double scale_of(const Quantity& quantity, const Block& block) {
  double scale = largest_of(quantity);
  for (const Quantity* column : block.columns) {
    if (column->units != quantity.units) continue;
    const bool is_measured =
        column->name == "value" || (quantity.units != "1" && !quantity.units.empty());
    if (is_measured) scale = std::max(scale, largest_of(*column));
  }
  return scale;
}

double number_at(const Quantity* quantity, std::size_t index) {
  const auto* numbers = quantity ? std::get_if<std::vector<double>>(&quantity->values) : nullptr;
  return numbers ? numbers->at(index) : std::nan("");
}

const Quantity* companion(const Quantity& quantity, const Block& block, const char* ending) {
  for (const Quantity* column : block.columns) {
    if (column->name == quantity.name + ending) return column;
  }
  return nullptr;
}

bool has_interval(const Quantity& quantity, const Block& block) {
  return companion(quantity, block, "_low_95") != nullptr &&
         companion(quantity, block, "_high_95") != nullptr;
}

bool is_shown_beside(const Quantity& quantity, const Block& block) {
  return std::ranges::any_of(block.columns, [&](const Quantity* column) {
    if (companion(*column, block, "_half_width") == &quantity) return true;
    return has_interval(*column, block) &&
           std::ranges::any_of(interval_endings, [&](const char* ending) {
             return companion(*column, block, ending) == &quantity;
           });
  });
}

/// A value with its error or interval: "2.1 (1.3 to 3.4)" or "2.1 (> 1.3)" where there is a 95 %
/// interval, else "2.10(40)".
std::string shown(const Quantity& quantity, const Block& block, std::size_t index) {
  if (has_interval(quantity, block)) {
    const double low = number_at(companion(quantity, block, "_low_95"), index);
    const double high = number_at(companion(quantity, block, "_high_95"), index);
    const double value = number_at(&quantity, index);
    const bool is_open = !std::isfinite(low) && !std::isfinite(high);
    if (is_open || !std::isfinite(value)) return shown_cell(quantity, index);
    return fmt::format("{} ({})", number_text(value, 4), limits_text(low, high, 4));
  }
  const auto* numbers = std::get_if<std::vector<double>>(&quantity.values);
  const double width = number_at(companion(quantity, block, "_half_width"), index);
  if (!numbers || !(width > 0)) return shown_cell(quantity, index);
  return value_with_error(numbers->at(index), width, scale_of(quantity, block));
}

/// No row has a number.
bool is_empty(const Quantity& quantity) {
  const auto* numbers = std::get_if<std::vector<double>>(&quantity.values);
  return numbers && std::ranges::all_of(*numbers, [](double x) { return std::isnan(x); });
}

/// "  --wide shows also     a, b".
std::string named(const char* label, const std::vector<std::string>& names) {
  return names.empty() ? "" : fmt::format("  {:<22} {}\n", label, joined(names, ", "));
}

bool has_units(const Quantity& quantity) {
  return !quantity.units.empty() && quantity.units != "1";
}

/// Numbers that a verdict's sentence has in it.
bool is_said_by_verdicts(const Quantity& quantity, const Table& table) {
  const bool of_a_test = is_probability(quantity.name) || quantity.name.ends_with("_detectable");
  return of_a_test && std::ranges::any_of(table.notes, [](const auto& note) {
           return note.first.ends_with("_verdict");
         });
}

std::string single_values(const Table& table, const Block& block, const Layout& layout) {
  std::string text;
  std::vector<std::string> hidden, empty;
  for (const Quantity* quantity : block.columns) {
    if (is_shown_beside(*quantity, block)) continue;
    if (layout.columns == Columns::few) {
      auto* unshown = is_said_by_verdicts(*quantity, table) ? &hidden
                      : is_empty(*quantity)                 ? &empty
                                                            : nullptr;
      if (unshown) {
        unshown->push_back(quantity->name);
        continue;
      }
    }
    text += fmt::format("  {:<22} {}{}", quantity->name, shown(*quantity, block, 0),
                        has_units(*quantity) ? " " + quantity->units : "");
    text += quantity->long_name.empty() ? "\n" : fmt::format("   ({})\n", quantity->long_name);
  }
  return text + named("without a value", empty) + named("--wide shows also", hidden);
}

/// Sentences have no place among numbers.
bool holds_sentences(const Quantity& quantity) {
  const auto* texts = std::get_if<std::vector<std::string>>(&quantity.values);
  return texts != nullptr && std::ranges::any_of(*texts, [](const std::string& text) {
           return text.size() > longest_cell;
         });
}

/// "waiting_time 0, 1: ...", one line for all rows with equal texts.
std::string sentences(const Table& table, const Block& block, const Quantity& quantity) {
  const auto& texts = std::get<std::vector<std::string>>(quantity.values);
  std::vector<std::string> order;
  std::map<std::string, std::string> rows;
  for (std::size_t row = 0; row < texts.size(); ++row) {
    std::string coordinates;
    for (std::size_t i = 0; const std::size_t index : place(table, block, row)) {
      coordinates.append(coordinates.empty() ? "" : "/")
          .append(shown_cell(axis_named(table, block.axes[i++]), index));
    }
    std::string& listed = rows[texts[row]];
    if (listed.empty()) order.push_back(texts[row]);
    listed.append(listed.empty() ? "" : ", ").append(coordinates);
  }
  std::string text = fmt::format("  {} by {}\n", quantity.name, joined(block.axes, "/"));
  for (const std::string& said : order) {
    if (!said.empty()) text += fmt::format("    {}: {}\n", rows[said], said);
  }
  return text;
}

std::size_t characters(const Quantity& quantity) {
  std::size_t n = 0;
  for (const std::string& text : std::get<std::vector<std::string>>(quantity.values))
    n += text.size();
  return n;
}

/// Names the omitted columns, and where to find them.
std::string left_out(const Block& block, const char* place_text,
                     const std::vector<std::string>& names) {
  return fmt::format("  {:<22} {}{}\n",
                     counted(block.n_rows(), "row") + " of " + joined(block.axes, ", "), place_text,
                     joined(names, ", "));
}

/// The columns of a block as they are shown, and the names of those that are not.
class BlockText {
 public:
  BlockText(const Table& table, const Block& block, const Layout& layout)
      : table_(table), block_(block), layout_(layout), keys_(block.axes.size()) {
    for (const Quantity* quantity : block.columns) {
      if (is_shown_beside(*quantity, block)) continue;
      if (layout.columns == Columns::few && is_empty(*quantity)) {
        empty_.push_back(quantity->name);
      } else {
        (holds_sentences(*quantity) ? said_ : numbers_).push_back(quantity);
      }
    }
  }

  std::string text() {
    if (layout_.columns == Columns::few && counts_alone()) return "";
    if (block_.n_rows() == 0) return wrapped(left_out(block_, "none: ", all_names()), width());
    const bool brief = layout_.columns == Columns::few;
    if (brief && block_.n_rows() > (keys_ > 1 ? most_rows_of_many_axes : most_rows)) {
      return wrapped(left_out(block_, "in --wide, --csv FILE and --json: ", all_names()), width());
    }
    std::string text = "\n";
    std::vector<std::string> hidden;
    for (const Quantity* quantity : said_) {
      if (brief && characters(*quantity) > most_words) {
        hidden.push_back(quantity->name);
      } else {
        text += wrapped(sentences(table_, block_, *quantity), width());
      }
    }
    if (!numbers_.empty() && text.size() > 1) text += '\n';
    if (!numbers_.empty() || (said_.empty() && empty_.empty())) text += columns(hidden);
    return text +
           wrapped(units() + named("without a value", empty_) + named("--wide shows also", hidden),
                   width());
  }

 private:
  std::size_t width() const { return layout_.width; }

  /// Numbers of realizations and of nothing else.
  bool counts_alone() const {
    return said_.empty() && empty_.empty() && numbers_.size() == 1 &&
           numbers_.front()->name == "realizations";
  }

  std::vector<std::string> all_names() const {
    std::vector<std::string> names = empty_;
    for (const auto* list : {&numbers_, &said_}) {
      for (const Quantity* quantity : *list) names.push_back(quantity->name);
    }
    return names;
  }

  /// "  in diameter            height, eq7_z_star", a line for each of the units of what is shown.
  std::string units() const {
    std::map<std::string, std::vector<std::string>> names;
    const auto add = [&](const Quantity& quantity) {
      const bool says_them = quantity.units.starts_with(quantity.name);  // a tap's are taps
      if (has_units(quantity) && !says_them) names["in " + quantity.units].push_back(quantity.name);
    };
    for (const std::string& axis : block_.axes) add(axis_named(table_, axis));
    for (const Quantity* quantity : numbers_) add(*quantity);
    std::string text;
    for (const auto& [unit, quantity_names] : names) text += named(unit.c_str(), quantity_names);
    return text;
  }

  /// Prints the first columns that fit; below one another where rows are few.
  std::string columns(std::vector<std::string>& hidden) {
    const TextTable whole = table_of(numbers_);
    std::size_t width_of_keys = 0;
    for (std::size_t key = 0; key < keys_; ++key) width_of_keys += whole.width_of_column(key) + 2;
    std::size_t blocks_left = std::max<std::size_t>(1, most_rows / (block_.n_rows() + 2));
    std::size_t n = 0, used = width_of_keys;
    for (; n < numbers_.size(); ++n) {
      const std::size_t width = whole.width_of_column(keys_ + n);
      if (used > width_of_keys && used + width > layout_.table_width()) {
        if (--blocks_left == 0) break;
        used = width_of_keys;
      }
      used += width + 2;
    }
    for (std::size_t i = n; i < numbers_.size(); ++i) hidden.push_back(numbers_[i]->name);
    numbers_.resize(n);
    return table_of(numbers_).text(layout_.table_width());
  }

  TextTable table_of(const std::vector<const Quantity*>& quantities) const {
    std::vector<std::string> headers = block_.axes;
    for (const Quantity* quantity : quantities) headers.push_back(quantity->name);
    TextTable text(headers, keys_);
    for (std::size_t row = 0; row < block_.n_rows(); ++row) {
      std::vector<std::string> cells;
      for (std::size_t i = 0; const std::size_t index : place(table_, block_, row)) {
        cells.push_back(shown_cell(axis_named(table_, block_.axes[i++]), index));
      }
      for (const Quantity* quantity : quantities) cells.push_back(shown(*quantity, block_, row));
      text.add(std::move(cells));
    }
    return text;
  }

  const Table& table_;
  const Block& block_;
  const Layout& layout_;
  std::size_t keys_;
  std::vector<const Quantity*> numbers_, said_;
  std::vector<std::string> empty_;  // names of columns without a number
};

/// Results come first.
bool is_verdict(const std::string& note) {
  return note.ends_with("verdict") || note == "refused" || note == "maximum" || note == "minimum";
}

std::string notes(const Table& table) {
  std::string text;
  for (const bool verdicts : {true, false}) {
    for (const auto& [name, note] : table.notes) {
      if (is_verdict(name) == verdicts) text += fmt::format("  {:<22} {}\n", name, note);
    }
  }
  return text;
}

}  // namespace

std::string table_text(const Table& stored, const Layout& layout) {
  const Table table = with_half_widths(stored);
  std::string text = wrapped(fmt::format("{}\n", table.name) + notes(table), layout.width);
  for (const Block& block : blocks_of(table)) {
    text += block.axes.empty() ? wrapped(single_values(table, block, layout), layout.width)
                               : BlockText(table, block, layout).text();
  }
  return text;
}

}  // namespace jostle::inline cli
