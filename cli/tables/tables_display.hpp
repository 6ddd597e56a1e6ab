#pragma once

#include <vector>

#include "cli/reports/fit_output.hpp"
#include "cli/tables/layout.hpp"
#include "study/running/scene_tables.hpp"

namespace jostle::inline cli {

enum class Quiet { no, yes };

/// How much of each fit is printed.
enum class FitDetail { summary, full };

/// Prints the tables that a scene requests: analyses at once, fits as one summary table by
/// print_summary(), or each at once in full. If quiet, prints only failures, on stderr.
class TablesDisplay : public TablesObserver {
 public:
  TablesDisplay(Quiet quiet, const Layout& layout, FitDetail detail = FitDetail::summary)
      : quiet_(quiet), layout_(layout), detail_(detail) {}
  void fitted(const FittedCurve& curve) override;
  void analysed(const Table& table) override;
  void without_structure(const std::string& reason) override;
  void print_summary() const;

 private:
  Quiet quiet_;
  Layout layout_;
  FitDetail detail_;
  std::vector<FitSummary> summary_;
};

}  // namespace jostle::inline cli
