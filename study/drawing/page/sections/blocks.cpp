#include "study/drawing/page/sections/blocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ensemble/analysis/analyses.hpp"
#include "study/drawing/drawn/value_text.hpp"
#include "study/drawing/figures/drawn_file.hpp"
#include "study/drawing/page/page_json.hpp"

namespace jostle::inline study {
namespace {

Json shown(const Json& cell) {
  return cell.is_string() ? page_text(cell.text()) : cell;
}

Json shown(const PageRow& row) {
  Json cells = Json::array();
  for (const Json& cell : row) cells.push_back(shown(cell));
  return cells;
}

}  // namespace

Json figures_block(const PageContent& content, const WantedFigures& wanted) {
  Json places = Json::array();
  for (std::size_t i = 0; i < content.figures.size(); ++i) {
    const Figure& figure = content.figures[i];
    if (figure.section != wanted.section) continue;
    if (wanted.point && figure.point && *wanted.point != *figure.point) continue;
    if (wanted.point && figure.subject == comparison_subject) continue;
    if (!wanted.subject.empty() && wanted.subject != figure.subject) continue;
    places.push_back(i);
  }
  if (places.empty()) return nullptr;
  return {{"kind", "figures"}, {"figures", places}};
}

Json table_block(const std::string& caption, const PageRow& head,
                 const std::vector<PageRow>& rows) {
  if (rows.empty()) return nullptr;
  Json shown_rows = Json::array();
  for (const PageRow& row : rows) shown_rows.push_back(shown(row));
  return {{"kind", "table"},
          {"caption", page_text(caption)},
          {"head", shown(head)},
          {"rows", shown_rows}};
}

Json estimates_block(const std::string& caption, const PageRow& head,
                     const std::vector<PageRow>& rows) {
  return table_block(caption +
                         ". In a(b), b is half the 68 % interval, in the last digits of a. Numbers "
                         "without a unit are dimensionless.",
                     head, rows);
}

Json verdict_cell(const std::string& text) {
  if (text.empty()) return "–";
  for (const std::string word : {"not reached", "reached", "cannot decide", "found", "not met",
                                 "met", "agrees", "maximum"}) {
    if (!text.starts_with(word)) continue;
    return {{"strong", word}, {"text", page_text(text.substr(word.size()))}};
  }
  return text;
}

Json statement_block(const std::string& label, const std::string& text) {
  if (text.empty()) return nullptr;
  return {{"kind", "statement"}, {"label", page_text(label)}, {"text", page_text(text)}};
}

Json small_block(const std::string& text) {
  if (text.empty()) return nullptr;
  return {{"kind", "small"}, {"text", page_text(text)}};
}

Json details_block(const std::string& summary, const Blocks& blocks, bool is_open) {
  if (blocks.empty()) return nullptr;
  return {{"kind", "details"},
          {"summary", page_text(summary)},
          {"open", is_open},
          {"blocks", blocks.json()}};
}

Json subsection_block(const std::string& title, const Blocks& blocks) {
  if (blocks.empty()) return nullptr;
  return {{"kind", "subsection"}, {"title", page_text(title)}, {"blocks", blocks.json()}};
}

Json definitions_block(const std::string& kind,
                       const std::vector<std::pair<std::string, std::string>>& rows) {
  Json list = Json::array();
  for (const auto& [term, text] : rows) {
    if (!text.empty()) list.push_back(Json::array({page_text(term), page_text(text)}));
  }
  if (list.empty()) return nullptr;
  return {{"kind", "definitions"}, {"class", kind}, {"rows", list}};
}

Json refusals_block(const DrawnFile& file, const std::vector<TableView>& tables) {
  Json texts = Json::array();
  for (const TableView& table : tables) {
    if (!table.is_refused()) continue;
    texts.push_back(page_text(
        fmt::format("{}: not possible: {}", title_of(file, table), table.note("refused"))));
  }
  if (texts.empty()) return nullptr;
  return {{"kind", "refusals"}, {"texts", texts}};
}

Json page_section(const std::string& id, const std::string& title, const std::string& intro,
                  const Blocks& blocks) {
  if (blocks.empty()) return nullptr;
  return {{"id", id}, {"title", title}, {"intro", intro}, {"blocks", blocks.json()}};
}

std::vector<TableView> tables_of(const DrawnFile& file, const std::string& group,
                                 const std::string& kind) {
  std::vector<TableView> found;
  for (const TableView& table : file.tables()) {
    if (table.is_in(group, kind)) found.push_back(table);
  }
  return found;
}

std::vector<TableView> not_refused(const std::vector<TableView>& tables) {
  std::vector<TableView> made;
  for (const TableView& table : tables) {
    if (!table.is_refused()) made.push_back(table);
  }
  return made;
}

std::vector<std::uint32_t> numbers_of(const std::vector<TableView>& tables) {
  std::vector<std::uint32_t> numbers;
  for (const TableView& table : tables) {
    if (table.point()) numbers.push_back(*table.point());
  }
  std::ranges::sort(numbers);
  const auto repeated = std::ranges::unique(numbers);
  numbers.erase(repeated.begin(), repeated.end());
  return numbers;
}

std::string title_of(const DrawnFile& file, const TableView& table) {
  std::string title;
  for (const std::string& part : table.path()) title += (title.empty() ? "" : " ") + words(part);
  return table.point() ? title + ", " + file.label(*table.point()) : title;
}

std::string value_cell(const TableView& table, const std::string& quantity, std::size_t i,
                       UnitPlace unit) {
  const double value = table.value(quantity, i);
  const bool is_bound = std::isfinite(value) && table.long_name(quantity).starts_with(lower_bound);
  const std::string text = is_bound ? "≥ " + typeset_number(value, 3)
                                    : typeset_with_error(value, table.half_width(quantity, i));
  const bool bare = unit == UnitPlace::head || !std::isfinite(value);
  return bare ? text : with_unit(text, table.units(quantity));
}

std::string number_cell(const TableView& table, const std::string& quantity, std::size_t i,
                        int digits) {
  const double value = table.value(quantity, i);
  const std::string text = typeset_number(value, digits);
  return std::isfinite(value) ? with_unit(text, table.units(quantity)) : text;
}

std::string p_cell(const TableView& table, const std::string& quantity, std::size_t i) {
  return typeset_probability(table.value(quantity, i));
}

std::string with_unit(const std::string& number, const std::string& units) {
  const std::string bracketed = unit_text(units);  // " (diameter)"
  if (bracketed.empty()) return number;
  return number + ' ' + bracketed.substr(2, bracketed.size() - 3);
}

}  // namespace jostle::inline study
