#include "cli/tables/tables_display.hpp"

#include <fmt/format.h>

#include "cli/reports/fit_output.hpp"
#include "cli/tables/table_text.hpp"
#include "cli/terminal/screen.hpp"
#include "cli/terminal/standard_streams.hpp"

namespace jostle::inline cli {

void TablesDisplay::fitted(const FittedCurve& curve) {
  if (quiet_ == Quiet::yes) return;
  if (detail_ == TableDetail::full) return print_report("\n" + fits_text(curve, layout_));
  for (FitSummary& row : summary_of(curve)) fits_.push_back(std::move(row));
}

void TablesDisplay::analysed(const Table& table) {
  if (quiet_ == Quiet::yes) return;
  if (detail_ == TableDetail::full) return print_report("\n" + table_text(table, layout_));
  results_.add(table);
}

void TablesDisplay::print_summary() const {
  if (!fits_.empty()) print_report("\n" + summary_text(fits_, layout_));
  if (const std::string text = results_.text(layout_.width); !text.empty()) {
    print_report("\n" + text);
  }
}

void TablesDisplay::without_structure(const std::string& reason) {
  print_to_standard_error(fmt::format("jostle: no structure: {}\n", reason));
}

std::vector<std::string> make_scene_tables(const ResultsFile& file,
                                           const SceneTablesRequest& request) {
  TablesDisplay display(request.quiet, request.layout, request.detail);
  std::vector<std::string> names =
      store_scene_tables(file, request.threads, display, request.patience);
  display.print_summary();
  return names;
}

}  // namespace jostle::inline cli
