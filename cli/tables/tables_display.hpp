#pragma once

#include <vector>

#include "cli/reports/fit_output.hpp"
#include "cli/reports/scene_summary.hpp"
#include "cli/tables/layout.hpp"
#include "cli/tables/scene_tables.hpp"
#include "study/running/scene_tables.hpp"

namespace jostle::inline cli {

/// Prints the tables that a scene requests: their results by print_summary(), or each table at once
/// in full. If quiet, prints only failures, on stderr.
class TablesDisplay : public TablesObserver {
 public:
  TablesDisplay(Quiet quiet, const Layout& layout, TableDetail detail = TableDetail::summary)
      : quiet_(quiet), layout_(layout), detail_(detail) {}
  void fitted(const FittedCurve& curve) override;
  void analysed(const Table& table) override;
  void without_structure(const std::string& reason) override;
  void print_summary() const;

 private:
  Quiet quiet_;
  Layout layout_;
  TableDetail detail_;
  SceneSummary results_;
  std::vector<FitSummary> fits_;
};

}  // namespace jostle::inline cli
