#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ensemble/analysis/table.hpp"

namespace jostle::inline cli {

/// Quantities along the same axes, in the order of the table.
struct Block {
  std::vector<std::string> axes;
  std::vector<const Quantity*> columns;

  std::size_t n_rows() const;
};

std::vector<Block> blocks_of(const Table& table);

std::size_t n_values(const Quantity& quantity);
const Quantity& axis_named(const Table& table, const std::string& name);

/// Indices along the block's axes of a place in its flat, row-major values.
std::vector<std::size_t> place(const Table& table, const Block& block, std::size_t index);

}  // namespace jostle::inline cli
