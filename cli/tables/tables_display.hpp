#pragma once

#include "cli/tables/layout.hpp"
#include "study/running/scene_tables.hpp"

namespace jostle::inline cli {

enum class Quiet { no, yes };

/// Prints briefly what a scene asks for, as it is made; where quiet, only what could not be made,
/// on stderr.
class TablesDisplay : public TablesObserver {
 public:
  TablesDisplay(Quiet quiet, const Layout& layout) : quiet_(quiet), layout_(layout) {}
  void fitted(const FittedCurve& curve) override;
  void analysed(const Table& table) override;
  void without_structure(const std::string& reason) override;

 private:
  Quiet quiet_;
  Layout layout_;
};

}  // namespace jostle::inline cli
