#include "cli/tables/table_blocks.hpp"

#include <algorithm>
#include <variant>

namespace jostle::inline cli {

std::size_t n_values(const Quantity& quantity) {
  return std::visit([](const auto& values) { return values.size(); }, quantity.values);
}

const Quantity& axis_named(const Table& table, const std::string& name) {
  return *std::ranges::find_if(table.axes, [&](const Quantity& axis) { return axis.name == name; });
}

std::vector<Block> blocks_of(const Table& table) {
  std::vector<Block> blocks;
  for (const Quantity& quantity : table.quantities) {
    const auto is_same = [&](const Block& block) { return block.axes == quantity.axes; };
    const auto found = std::ranges::find_if(blocks, is_same);
    if (found == blocks.end()) {
      blocks.push_back({quantity.axes, {&quantity}});
    } else {
      found->columns.push_back(&quantity);
    }
  }
  return blocks;
}

std::size_t Block::n_rows() const {
  return n_values(*columns.front());
}

std::vector<std::size_t> place(const Table& table, const Block& block, std::size_t index) {
  std::vector<std::size_t> indices(block.axes.size());
  for (std::size_t i = block.axes.size(); i-- > 0;) {
    const std::size_t n = n_values(axis_named(table, block.axes[i]));
    indices[i] = index % n;
    index /= n;
  }
  return indices;
}

}  // namespace jostle::inline cli
