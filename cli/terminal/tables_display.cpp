#include "cli/terminal/tables_display.hpp"

#include <fmt/format.h>

#include "cli/terminal/fit_output.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "cli/terminal/table_output.hpp"

namespace jostle {

void TablesDisplay::fitted(const FittedCurve& curve) {
  if (quiet_ == Quiet::no) print("\n" + fits_text(curve));
}

void TablesDisplay::analysed(const Table& table) {
  if (quiet_ == Quiet::no) print("\n" + table_text(table, Detail::brief));
}

void TablesDisplay::without_structure(const std::string& reason) {
  print_to_standard_error(fmt::format("jostle: no structure: {}\n", reason));
}

}  // namespace jostle
