#include <fmt/format.h>

#include <cmath>

#include "study/drawing/drawn/value_text.hpp"
#include "study/drawing/page/sections/sections.hpp"

// Ordering, motion, volumes and memory.
namespace jostle::inline study {
namespace {

std::string limits(double low, double high) {
  if (!std::isfinite(low) && !std::isfinite(high)) return "";
  const auto end = [](double value) {
    return std::isfinite(value) ? typeset_number(value) : std::string("no limit");
  };
  return " (" + end(low) + " to " + end(high) + ")";
}

Json times_table(const DrawnFile& file, const std::vector<TableView>& tables) {
  std::vector<PageRow> rows;
  for (const TableView& table : tables) {
    const std::string verdict = table.note("verdict");
    rows.push_back({words(table.path().back()), file.label(*table.point()),
                    verdict.substr(0, verdict.find(';')),
                    number_cell(table, "median_time") + limits(table.value("median_time_low_95"),
                                                               table.value("median_time_high_95")),
                    value_cell(table, "growth_per_decade"), table.note("law")});
  }
  return estimates_block("Times to order",
                         {"observable", "sweep point", "ordered", "half by tap (95 %)",
                          "growth per decade of taps", "law of the times"},
                         rows);
}

Json steps_table(const TableView& table) {
  std::vector<PageRow> rows;
  for (std::size_t i = 0; i < table.axis("neighbours").size(); ++i) {
    PageRow row{number_cell(table, "from_state", i) + " and " + number_cell(table, "to_state", i)};
    for (const char* const name :
         {"step_fluctuations", "step_histograms", "step_difference", "bend"}) {
      row.emplace_back(value_cell(table, name, i));
    }
    row.emplace_back(number_cell(table, "separation", i, 3));
    row.emplace_back(number_cell(table, "overlap", i, 2));
    rows.push_back(row);
  }
  return estimates_block("Steps of 1/X from state to state",
                         {"states", "step fluctuations", "step histograms", "step difference",
                          "bend", "distance (deviations)", "overlap"},
                         rows);
}

Json histories_table(const TableView& table) {
  const std::vector<double> lags = table.axis("lag_window");
  const std::string control = control_of(table);
  PageRow head{"histories, by " + control_symbol(control) + " before"};
  for (std::size_t j = 0; j < lags.size(); ++j) {
    const double first = table.value("first_lag", j);
    head.emplace_back(first == lags[j] ? "lag " + typeset_number(lags[j], 7)
                                       : "lags " + typeset_number(first, 7) + " to " +
                                             typeset_number(lags[j], 7));
  }
  std::vector<PageRow> rows;
  for (std::size_t i = 0; i < table.axis("pair").size(); ++i) {
    PageRow row{number_cell(table, "second_" + control, i) + " minus " +
                number_cell(table, "first_" + control, i)};
    for (std::size_t j = 0; j < lags.size(); ++j) {
      const std::size_t index = i * lags.size() + j;
      row.emplace_back(value_cell(table, "difference", index) + ", " +
                       typeset_p(table.value("difference_p_corrected", index)));
    }
    rows.push_back(row);
  }
  return estimates_block("Differences between histories at equal value, p corrected", head, rows);
}

}  // namespace

Json ordering_section(const PageContent& content) {
  const std::vector<TableView> all = tables_of(content.file, "analysis", "ordering");
  std::vector<TableView> points, comparisons;
  for (const TableView& table : not_refused(all))
    (table.point() ? points : comparisons).push_back(table);
  Blocks blocks{figures_block(content, {.section = "ordering"})};
  for (const TableView& table : comparisons) {
    blocks.add(statement_block("Orders first, by " + words(table.path().back()),
                               table.note("orders_first")));
    blocks.add(statement_block("Ends highest", table.note("largest_value")));
    blocks.add(statement_block("Test of equality", table.note("verdict")));
  }
  blocks.add(times_table(content.file, points));
  blocks.add(refusals_block(content.file, all));
  return page_section("ordering", "Ordering",
                      "When beds order. A bed that had not ordered when its taps ended counts as "
                      "such, not as one that never orders.",
                      blocks);
}

Json motion_section(const PageContent& content) {
  const std::vector<TableView> all = tables_of(content.file, "analysis", "motion"),
                               made = not_refused(all);
  return page_section(
      "motion", "Motion", "How far spheres move in a lag t, counted from the waiting time t_W.",
      {points_block(content.file, numbers_of(made),
                    [&](std::uint32_t point) {
                      Blocks blocks{figures_block(content, {.section = "motion", .point = point})};
                      for (const TableView& table : made) {
                        if (table.point() != point || table.path().back() != "displacement")
                          continue;
                        blocks.add(statement_block("With age", table.note("age")));
                        blocks.add(
                            statement_block("Through periodic sides", table.note("unwrapping")));
                      }
                      return blocks;
                    }),
       refusals_block(content.file, all)});
}

Json volumes_section(const PageContent& content) {
  const std::vector<TableView> all = tables_of(content.file, "analysis", "volumes");
  Blocks blocks;
  for (const TableView& table : not_refused(all)) {
    blocks.add(figures_block(content, {.section = "volumes", .subject = table.name()}));
    blocks.add(statement_block("Agreement of the estimators", table.note("verdict")));
    blocks.add(statement_block("Left out", table.note("left_out")));
    blocks.add(steps_table(table));
  }
  blocks.add(refusals_block(content.file, all));
  return page_section("volumes", "Volumes of steady states",
                      "The compactivity from the fluctuations of the volume, by two estimators.",
                      blocks);
}

Json memory_section(const PageContent& content) {
  const std::vector<TableView> all = tables_of(content.file, "analysis", "memory");
  Blocks blocks;
  for (const TableView& table : not_refused(all)) {
    blocks.add(figures_block(content, {.section = "memory", .subject = table.name()}));
    blocks.add(statement_block("Is the value alone the state", table.note("verdict")));
    blocks.add(histories_table(table));
  }
  blocks.add(refusals_block(content.file, all));
  return page_section("memory", "Memory",
                      "A test of whether the further evolution depends on how a value was reached.",
                      blocks);
}

}  // namespace jostle::inline study
