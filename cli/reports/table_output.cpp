#include "cli/reports/table_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/reports/text_table.hpp"
#include "config/json/json_text.hpp"
#include "ensemble/statistics/counted.hpp"
#include "study/tables/half_widths.hpp"

namespace jostle::inline cli {

namespace {

constexpr std::size_t most_brief_rows = 12;

std::size_t n_values(const Quantity& quantity) {
  return std::visit([](const auto& values) { return values.size(); }, quantity.values);
}

const Quantity& axis_named(const Table& table, const std::string& name) {
  return *std::ranges::find_if(table.axes, [&](const Quantity& axis) { return axis.name == name; });
}

/// Quantities along the same axes, in the order of the table.
struct Block {
  std::vector<std::string> axes;
  std::vector<const Quantity*> columns;
};

std::vector<Block> blocks_of(const Table& table) {
  std::vector<Block> blocks;
  for (const Quantity& quantity : table.quantities) {
    const auto same = [&](const Block& block) { return block.axes == quantity.axes; };
    const auto found = std::ranges::find_if(blocks, same);
    if (found == blocks.end()) {
      blocks.push_back({quantity.axes, {&quantity}});
    } else {
      found->columns.push_back(&quantity);
    }
  }
  return blocks;
}

std::size_t n_rows(const Block& block) {
  return n_values(*block.columns.front());
}

enum class Digits { few, all };

std::string cell(const Quantity& quantity, std::size_t index, Digits digits) {
  if (const auto* numbers = std::get_if<std::vector<double>>(&quantity.values)) {
    const double number = numbers->at(index);
    if (std::isnan(number)) return digits == Digits::few ? "-" : "nan";
    return digits == Digits::few ? fmt::format("{:.6g}", number) : fmt::format("{}", number);
  }
  if (const auto* counts = std::get_if<std::vector<std::uint64_t>>(&quantity.values)) {
    return fmt::to_string(counts->at(index));
  }
  return std::get<std::vector<std::string>>(quantity.values).at(index);
}

constexpr const char* interval_endings[] = {"_low_68", "_high_68", "_low_95", "_high_95"};

/// The size of what a quantity measures: its largest value, and at least 1, the size of a sphere.
double scale_of(const std::vector<double>& numbers) {
  double scale = 1;
  for (const double number : numbers) {
    if (std::isfinite(number)) scale = std::max(scale, std::abs(number));
  }
  return scale;
}

std::string with_error(const Quantity& value, const Quantity& error, std::size_t index) {
  const auto* numbers = std::get_if<std::vector<double>>(&value.values);
  const auto* errors = std::get_if<std::vector<double>>(&error.values);
  if (!numbers || !errors || std::isnan(numbers->at(index))) {
    return cell(value, index, Digits::few);
  }
  return value_and_error(numbers->at(index), errors->at(index), scale_of(*numbers));
}

const Quantity* beside(const Quantity& quantity, const Block& block, const char* ending) {
  for (const Quantity* other : block.columns) {
    if (other->name == quantity.name + ending) return other;
  }
  return nullptr;
}

const Quantity* error_of(const Quantity& quantity, const Block& block) {
  return beside(quantity, block, "_error");
}

bool has_interval(const Quantity& quantity, const Block& block) {
  return beside(quantity, block, "_low_95") != nullptr &&
         beside(quantity, block, "_high_95") != nullptr;
}

bool is_shown_beside(const Quantity& quantity, const Block& block) {
  return std::ranges::any_of(block.columns, [&](const Quantity* other) {
    if (error_of(*other, block) == &quantity) return true;
    return has_interval(*other, block) &&
           std::ranges::any_of(interval_endings, [&](const char* ending) {
             return beside(*other, block, ending) == &quantity;
           });
  });
}

/// A value with what stands beside it: "2.1 (1.3 to 3.4)" where there is a 95 % interval, else
/// "2.1 +- 0.4".
std::string shown(const Quantity& quantity, const Block& block, std::size_t index) {
  if (has_interval(quantity, block)) {
    const auto at = [&](const char* ending) {
      const Quantity* end = beside(quantity, block, ending);
      const auto* numbers = std::get_if<std::vector<double>>(&end->values);
      return numbers != nullptr ? numbers->at(index) : std::nan("");
    };
    const double low = at("_low_95"), high = at("_high_95");
    if (!std::isfinite(low) || !std::isfinite(high)) return cell(quantity, index, Digits::few);
    const auto* values = std::get_if<std::vector<double>>(&quantity.values);
    return fmt::format("{:.4g} ({:.4g} to {:.4g})", values ? values->at(index) : std::nan(""), low,
                       high);
  }
  const Quantity* error = error_of(quantity, block);
  return error ? with_error(quantity, *error, index) : cell(quantity, index, Digits::few);
}

// Indices along the block's axes of a place in its flat, row-major values.
std::vector<std::size_t> place(const Table& table, const Block& block, std::size_t index) {
  std::vector<std::size_t> indices(block.axes.size());
  for (std::size_t i = block.axes.size(); i-- > 0;) {
    const std::size_t n = n_values(axis_named(table, block.axes[i]));
    indices[i] = index % n;
    index /= n;
  }
  return indices;
}

std::string single_values(const Block& block) {
  std::string text;
  for (const Quantity* quantity : block.columns) {
    if (is_shown_beside(*quantity, block)) continue;
    const bool unitless = quantity->units.empty() || quantity->units == "1";
    text += fmt::format("  {:<22} {}{}", quantity->name, shown(*quantity, block, 0),
                        unitless ? "" : " " + quantity->units);
    text += quantity->long_name.empty() ? "\n" : fmt::format("   ({})\n", quantity->long_name);
  }
  return text;
}

std::string columns_text(const Table& table, const Block& block) {
  std::vector<std::string> headers = block.axes;
  for (const Quantity* quantity : block.columns) {
    if (!is_shown_beside(*quantity, block)) headers.push_back(quantity->name);
  }
  TextTable text(headers);
  for (std::size_t row = 0; row < n_rows(block); ++row) {
    std::vector<std::string> cells;
    const auto indices = place(table, block, row);
    for (std::size_t i = 0; i < indices.size(); ++i) {
      cells.push_back(cell(axis_named(table, block.axes[i]), indices[i], Digits::few));
    }
    for (const Quantity* quantity : block.columns) {
      if (is_shown_beside(*quantity, block)) continue;
      cells.push_back(shown(*quantity, block, row));
    }
    text.add(cells);
  }
  return fmt::format("\n{}", text.text());
}

/// Says which columns are not shown, and why.
std::string left_out(const Block& block, const char* why) {
  std::string names;
  for (const Quantity* quantity : block.columns) {
    if (is_shown_beside(*quantity, block)) continue;
    names.append(names.empty() ? "" : ", ").append(quantity->name);
  }
  const std::string along = joined(block.axes, ", ");
  return fmt::format("  {:<22} {}{}\n", counted(n_rows(block), "row") + " of " + along, why, names);
}

Json nested(const Table& table, const Quantity& quantity, std::size_t axis, std::size_t& next) {
  if (axis == quantity.axes.size()) {
    const std::size_t index = next++;
    return std::visit(
        [&](const auto& values) -> Json {
          if constexpr (std::is_same_v<std::decay_t<decltype(values)>, std::vector<double>>) {
            if (!std::isfinite(values.at(index))) return nullptr;
          }
          return values.at(index);
        },
        quantity.values);
  }
  auto list = Json::array();
  const std::size_t n = n_values(axis_named(table, quantity.axes[axis]));
  for (std::size_t i = 0; i < n; ++i) list.push_back(nested(table, quantity, axis + 1, next));
  return list;
}

Json quantity_json(const Table& table, const Quantity& quantity) {
  std::size_t next = 0;
  return {{"values", nested(table, quantity, 0, next)},
          {"axes", quantity.axes},
          {"units", quantity.units},
          {"long_name", quantity.long_name},
          {"source", quantity.source}};
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  quoted += '"';
  return quoted;
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& text : cells) line.append(line.empty() ? "" : ",").append(quoted(text));
  line += '\n';
  return line;
}

}  // namespace

std::string table_text(const Table& stored, Detail detail) {
  const Table table = with_half_widths(stored);
  std::string text = fmt::format("{}\n", table.name);
  for (const auto& [name, note] : table.notes) text += fmt::format("  {:<22} {}\n", name, note);
  for (const Block& block : blocks_of(table)) {
    if (block.axes.empty()) {
      text += single_values(block);
    } else if (n_rows(block) == 0) {
      text += left_out(block, "none: ");
    } else if (detail == Detail::full || n_rows(block) <= most_brief_rows) {
      text += columns_text(table, block);
    } else {
      text += left_out(block, "in --csv FILE and --json: ");
    }
  }
  return text;
}

Json table_json(const Table& table) {
  Json object = {{"name", table.name},
                 {"notes", Json::object()},
                 {"axes", Json::object()},
                 {"quantities", Json::object()}};
  for (const auto& [name, note] : table.notes) object["notes"][name] = note;
  for (const Quantity& axis : table.axes) object["axes"][axis.name] = quantity_json(table, axis);
  for (const Quantity& quantity : table.quantities) {
    object["quantities"][quantity.name] = quantity_json(table, quantity);
  }
  return object;
}

std::string table_csv(const Table& table) {
  std::string text = fmt::format("# {}\n", table.name);
  for (const auto& [name, note] : table.notes) text += fmt::format("# {}: {}\n", name, note);
  for (const Block& block : blocks_of(table)) {
    std::vector<std::string> header = block.axes;
    for (const Quantity* quantity : block.columns) header.push_back(quantity->name);
    text += csv_line(header);
    for (std::size_t row = 0; row < n_rows(block); ++row) {
      std::vector<std::string> cells;
      const auto indices = place(table, block, row);
      for (std::size_t i = 0; i < indices.size(); ++i) {
        cells.push_back(cell(axis_named(table, block.axes[i]), indices[i], Digits::all));
      }
      for (const Quantity* quantity : block.columns) {
        cells.push_back(cell(*quantity, row, Digits::all));
      }
      text += csv_line(cells);
    }
    text += '\n';
  }
  return text;
}

}  // namespace jostle::inline cli
