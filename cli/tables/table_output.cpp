#include "cli/tables/table_output.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cli/tables/table_blocks.hpp"

namespace jostle::inline cli {

namespace {

std::string csv_cell(const Quantity& quantity, std::size_t index) {
  if (const auto* numbers = std::get_if<std::vector<double>>(&quantity.values)) {
    return csv_number(numbers->at(index));
  }
  if (const auto* counts = std::get_if<std::vector<std::uint64_t>>(&quantity.values)) {
    return fmt::to_string(counts->at(index));
  }
  return std::get<std::vector<std::string>>(quantity.values).at(index);
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
  for (std::size_t i = 0; i < cells.size(); ++i)
    line.append(i == 0 ? "" : ",").append(quoted(cells[i]));
  return (line.empty() ? "\"\"" : line) + "\n";  // an empty line would end the block
}

}  // namespace

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

std::string csv_number(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

std::string table_csv(const Table& table) {
  std::string text = fmt::format("# {}\n", table.name);
  for (const auto& [name, note] : table.notes) text += fmt::format("# {}: {}\n", name, note);
  for (const Block& block : blocks_of(table)) {
    std::vector<std::string> header = block.axes;
    for (const Quantity* quantity : block.columns) header.push_back(quantity->name);
    text += csv_line(header);
    for (std::size_t row = 0; row < block.n_rows(); ++row) {
      std::vector<std::string> cells;
      const auto indices = place(table, block, row);
      for (std::size_t i = 0; i < indices.size(); ++i) {
        cells.push_back(csv_cell(axis_named(table, block.axes[i]), indices[i]));
      }
      for (const Quantity* quantity : block.columns) {
        cells.push_back(csv_cell(*quantity, row));
      }
      text += csv_line(cells);
    }
    text += '\n';
  }
  return text;
}

}  // namespace jostle::inline cli
