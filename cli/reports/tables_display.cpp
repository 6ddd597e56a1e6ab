#include "cli/reports/tables_display.hpp"

#include <fmt/format.h>

#include "cli/reports/fit_output.hpp"
#include "cli/reports/table_output.hpp"
#include "cli/terminal/standard_streams.hpp"

namespace jostle::inline cli {

void TablesDisplay::fitted(const FittedCurve& curve) {
  if (quiet_ == Quiet::no) print("\n" + fits_text(curve));
}

void TablesDisplay::analysed(const Table& table) {
  if (quiet_ == Quiet::no) print("\n" + table_text(table, Detail::brief));
}

void TablesDisplay::without_structure(const std::string& reason) {
  print_to_standard_error(fmt::format("jostle: no structure: {}\n", reason));
}

}  // namespace jostle::inline cli
