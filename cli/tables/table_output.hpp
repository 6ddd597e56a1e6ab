#pragma once

#include <string>

#include "config/json/json.hpp"
#include "ensemble/analysis/table.hpp"

// Tables of fits and analyses, for programs. A quantity "x" and its "x_error" are adjacent.
namespace jostle::inline cli {

/// {"name", "notes": {...}, "axes": {name: quantity}, "quantities": {name: quantity}}, a quantity
/// being {"values", "axes", "units", "long_name", "source"}: a number or text, or nested lists,
/// outermost axis first; what is not a number is null.
Json table_json(const Table& table);

/// A number to the last bit; an empty field for NaN and the infinities, which no reader of CSV
/// agrees on.
std::string csv_number(double value);

/// One block a set of axes, under a header of names, a row a place along the axes; numbers as
/// csv_number() writes them. Lines that begin with # hold the table's name and notes.
std::string table_csv(const Table& table);

}  // namespace jostle::inline cli
