#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/json/json.hpp"
#include "study/drawing/figures/drawn_file.hpp"
#include "study/drawing/figures/figure.hpp"

// A page is sections of blocks: figures, tables and sentences. report/src/blocks.js shows them.
namespace jostle::inline study {

/// The parts of a page: a file, and the figures of the catalogue, which blocks name by their
/// places.
struct PageContent {
  const DrawnFile& file;
  const std::vector<Figure>& figures;
};

/// A list of blocks; what is null is left out.
class Blocks {
 public:
  Blocks() = default;
  Blocks(std::initializer_list<Json> blocks) {
    for (const Json& block : blocks) add(block);
  }
  void add(const Json& block) {
    if (!block.is_null()) list_.push_back(block);
  }
  void add(const Blocks& remaining) {
    for (const Json& block : remaining.list_) list_.push_back(block);
  }
  bool empty() const { return list_.empty(); }
  Json json() const { return list_; }

 private:
  std::vector<Json> list_;
};

/// Figures of a section; an empty `subject` means any.
struct WantedFigures {
  std::string section{};
  std::optional<std::uint32_t> point{};
  std::string subject{};
};
/// Null where there is none, as of all blocks below where they would be empty.
Json figures_block(const PageContent& content, const WantedFigures& wanted);

/// A cell is a text, {"strong": "reached", "text": ", ..."}, or {"print": "N_c"}, whose symbols get
/// their subscripts.
using PageRow = std::vector<Json>;
Json table_block(const std::string& caption, const PageRow& head, const std::vector<PageRow>& rows);
/// A table with values "a(b)"; the caption defines b.
Json estimates_block(const std::string& caption, const PageRow& head,
                     const std::vector<PageRow>& rows);
/// A verdict begins with what it states; the page sets it off.
Json verdict_cell(const std::string& text);

Json statement_block(const std::string& label, const std::string& text);
Json small_block(const std::string& text);
Json details_block(const std::string& summary, const Blocks& blocks, bool is_open = false);
/// Blocks under a heading of their own; null where there are none.
Json subsection_block(const std::string& title, const Blocks& blocks);
/// A list of terms with what they are; rows without a text are left out.
Json definitions_block(const std::string& kind,
                       const std::vector<std::pair<std::string, std::string>>& rows);

/// The names and statements of the refused tables; null where none was refused.
Json refusals_block(const DrawnFile& file, const std::vector<TableView>& tables);

/// The blocks of each sweep point, of which the page shows one.
template <class Make>
Json points_block(const DrawnFile& file, const std::vector<std::uint32_t>& points, Make make) {
  Json list = Json::array();
  for (const std::uint32_t point : points) {
    const Blocks blocks = make(point);
    if (blocks.empty()) continue;
    list.push_back({{"label", file.label(point)}, {"blocks", blocks.json()}});
  }
  if (list.empty()) return nullptr;
  return {{"kind", "points"}, {"points", list}};
}

/// Null where it has no blocks.
Json page_section(const std::string& id, const std::string& title, const std::string& intro,
                  const Blocks& blocks);

/// All tables of a kind of analysis, refused ones too.
std::vector<TableView> tables_of(const DrawnFile& file, const std::string& group,
                                 const std::string& kind);
std::vector<TableView> not_refused(const std::vector<TableView>& tables);
/// Their sweep points, each once and ascending.
std::vector<std::uint32_t> numbers_of(const std::vector<TableView>& tables);
std::string title_of(const DrawnFile& file, const TableView& table);

/// Where a unit is printed: with each number, or at the head of its column.
enum class UnitPlace { cell, head };
/// value(error) of a quantity, with its unit; its error is NAME_error. "≥ value" of a lower bound.
std::string value_cell(const TableView& table, const std::string& quantity, std::size_t i = 0,
                       UnitPlace unit = UnitPlace::cell);
std::string number_cell(const TableView& table, const std::string& quantity, std::size_t i = 0,
                        int digits = 4);
/// A p-value, "0.019" or "< 10⁻¹⁶".
std::string p_cell(const TableView& table, const std::string& quantity, std::size_t i = 0);
/// "4.18(2) diameter": a text that is a number, with a unit that is not 1.
std::string with_unit(const std::string& number, const std::string& units);

}  // namespace jostle::inline study
