#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "study/drawing/drawn/value_text.hpp"
#include "study/drawing/page/page_json.hpp"
#include "study/drawing/page/sections/sections.hpp"

// Steady states, ageing, spectra, hysteresis, sweeps, cost and precision.
namespace jostle::inline study {
namespace {

std::string point_label(const DrawnFile& file, const TableView& table) {
  return table.point() ? file.label(*table.point()) : "all points";
}

std::string text_at(const TableView& table, const std::string& quantity, std::size_t i) {
  const std::vector<std::string> texts = table.texts(quantity);
  return i < texts.size() && !texts[i].empty() ? texts[i] : "–";
}

Json steady_table(const DrawnFile& file, const std::vector<TableView>& made) {
  std::vector<PageRow> rows;
  for (const TableView& table : made) {
    rows.push_back({words(table.observable()), point_label(file, table), table.note("taps"),
                    value_cell(table, "value"), value_cell(table, "sigma"),
                    value_cell(table, "autocorrelation_time"), value_cell(table, "drift"),
                    verdict_cell(table.note("verdict"))});
  }
  return estimates_block("The last taps of every sweep point",
                         {"observable", "sweep point", "taps", "mean", "σ of single taps",
                          "memory τ", "drift", "verdict"},
                         rows);
}

Json ageing_table(const TableView& table) {
  const std::vector<double> ages = table.axis("waiting_time");
  std::vector<PageRow> rows;
  for (std::size_t k = 0; k < ages.size(); ++k) {
    PageRow row{typeset_number(ages[k], 7)};
    for (const char* const name : {"a_inf", "b", "tau"}) {
      row.emplace_back(std::isfinite(table.value(name, k)) ? value_cell(table, name, k) : "–");
    }
    row.emplace_back(number_cell(table, "misfit", k, 2));
    row.emplace_back(Json{{"print", page_text(in_print(text_at(table, "verdict", k)))}});
    rows.push_back(row);
  }
  return estimates_block("A∞ (1 − 1/(1 + B ln(1 + t/τ))), fitted to each waiting time",
                         {"waiting time (taps)", "A∞", "B", "τ", "misfit", "statement"}, rows);
}

/// The table's quantities a, b and v as the captions call them: A, B and V.
std::string with_capitals(std::string text) {
  for (const auto& [name, symbol] :
       {std::pair{'a', 'A'}, std::pair{'b', 'B'}, std::pair{'v', 'V'}}) {
    for (const std::string prefix : {"of ", "equal "}) {
      const std::string written = prefix + name + ' ';
      for (std::size_t index = 0; (index = text.find(written, index)) != std::string::npos;
           ++index) {
        text[index + prefix.size()] = symbol;
      }
    }
    if (text.starts_with(std::string(1, name) + ' ')) text.front() = symbol;
  }
  return text;
}

/// A table of the tests of ageing: a question, its answer, and the test in brackets behind it.
Json ageing_verdicts(const TableView& table) {
  constexpr std::array<std::array<const char*, 2>, 7> questions{
      {{"Does A change with age?", "ageing_verdict"},
       {"Do the fluctuations V change with age?", "fluctuation_verdict"},
       {"Do the curves fall on eq. 6?", "collapse_verdict"},
       {"Is A a function of t/t_W^μ?", "mu_verdict"},
       {"Is A a function of ln(t_W + t)/ln t_W?", "logarithmic_collapse_verdict"},
       {"Is V a function of t/t_W^μ?", "v_mu_verdict"},
       {"Is V a function of ln(t_W + t)/ln t_W?", "v_logarithmic_collapse_verdict"}}};
  const auto print = [](const std::string& text) {
    return Json{{"print", page_text(in_print(with_capitals(text)))}};
  };
  std::vector<PageRow> rows;
  for (const auto& [question, note] : questions) {
    const std::string verdict = table.note(note);
    if (verdict.empty()) continue;
    const std::size_t test = verdict.ends_with(')') ? verdict.rfind(" (") : std::string::npos;
    const bool has_test = test != std::string::npos;
    rows.push_back({print(question), print(verdict.substr(0, test)),
                    has_test ? print(verdict.substr(test + 2, verdict.size() - test - 3)) : "–"});
  }
  return table_block("Verdicts", {"question", "answer", "test"}, rows);
}

Blocks ageing_blocks(const PageContent& content, const TableView& table) {
  return {figures_block(content,
                        {.section = "ageing", .point = table.point(), .subject = table.name()}),
          ageing_verdicts(table), ageing_table(table)};
}

Json slopes_table(const DrawnFile& file, const std::vector<TableView>& made) {
  std::vector<PageRow> rows;
  for (const TableView& table : made) {
    rows.push_back({words(table.path().back()), point_label(file, table),
                    value_cell(table, "slope"), value_cell(table, "ar1_slope"),
                    p_cell(table, "ar1_slope_p", 0), table.note("verdict"), table.note("drift")});
  }
  return estimates_block("Log-log slopes in the band",
                         {"observable", "sweep point", "slope",
                          "slope of an AR(1) with this memory", "p", "verdict", "drift"},
                         rows);
}

Json areas_table(const TableView& table) {
  const std::vector<double> branches = table.values("branch");
  const double first = branches.empty() ? 0 : std::ranges::min(branches);
  const auto branch = [&](const char* name, std::size_t i) {
    return typeset_number(table.value(name, i) - first + 1);  // counted from 1
  };
  std::vector<PageRow> rows;
  for (std::size_t i = 0; i < table.axis("loop").size(); ++i) {
    rows.push_back({branch("earlier_branch", i) + " and " + branch("later_branch", i),
                    number_cell(table, "lowest_strength", i) + " to " +
                        number_cell(table, "highest_strength", i),
                    value_cell(table, "area", i), p_cell(table, "area_p_corrected", i),
                    text_at(table, "area_verdict", i)});
  }
  return estimates_block("Area between branches, later minus earlier",
                         {"branches", "over strengths", "area", "p", "verdict"}, rows);
}

Json differences_table(const TableView& table) {
  std::vector<PageRow> rows;
  for (std::size_t i = 0; i < table.axis("pair").size(); ++i) {
    rows.push_back({number_cell(table, "from", i), number_cell(table, "to", i),
                    value_cell(table, "difference", i),
                    p_cell(table, "difference_p_corrected", i)});
  }
  return estimates_block("Differences between points", {"from", "to", "difference", "p, corrected"},
                         rows);
}

Json settings_table(const TableView& table) {
  const std::vector<std::string> names = table.axis_texts("setting");
  std::vector<PageRow> rows;
  for (std::size_t i = 0; i < names.size(); ++i) {
    rows.push_back({names[i], text_at(table, "part", i), value_cell(table, "bias", i),
                    number_cell(table, "tap_seconds", i, 3), number_cell(table, "core_hours", i, 3),
                    table.value("pareto", i) == 1 ? "yes" : ""});
  }
  return estimates_block(
      "Settings, " + words(table.observable()),
      {"setting", "part", "bias", "core time per tap", "cost of the scene", "best"}, rows);
}

}  // namespace

Json steady_section(const PageContent& content) {
  const std::vector<TableView> all = tables_of(content.file, "analysis", "steady"),
                               made = not_refused(all);
  const Json curves = points_block(content.file, numbers_of(made), [&](std::uint32_t point) {
    return Blocks{figures_block(content, {.section = "steady", .point = point})};
  });
  return page_section("steady", "Steady state", "A test of drift of the last taps, and their mean.",
                      {steady_table(content.file, made), details_block("Blocking curves", {curves}),
                       refusals_block(content.file, all)});
}

Json ageing_section(const PageContent& content) {
  const std::vector<TableView> all = tables_of(content.file, "analysis", "ageing"),
                               made = not_refused(all);
  return page_section(
      "ageing", "Ageing",
      "How much an observable changes in a lag t, counted from the waiting time t_W.",
      {points_block(content.file, numbers_of(made),
                    [&](std::uint32_t point) {
                      Blocks blocks;
                      for (const TableView& table : made) {
                        if (table.point() == point) blocks.add(ageing_blocks(content, table));
                      }
                      return blocks;
                    }),
       refusals_block(content.file, all)});
}

Json spectra_section(const PageContent& content) {
  const std::vector<TableView> all = tables_of(content.file, "analysis", "spectrum");
  return page_section(
      "spectra", "Spectra",
      "The frequencies at which an observable fluctuates. Memory alone gives a "
      "slope: compare it with that of a process with the same autocorrelation time.",
      {figures_block(content, {.section = "spectra"}), slopes_table(content.file, not_refused(all)),
       refusals_block(content.file, all)});
}

Json hysteresis_section(const PageContent& content) {
  const std::vector<TableView> all = tables_of(content.file, "analysis", "hysteresis");
  std::vector<TableView> made = not_refused(all);
  std::erase_if(made, [](const TableView& table) { return table.axis("step").empty(); });
  return page_section(
      "hysteresis", "Hysteresis", "A strength reached from below and from above.",
      {points_block(content.file, numbers_of(made),
                    [&](std::uint32_t point) {
                      Blocks blocks;
                      for (const TableView& table : made) {
                        if (table.point() != point) continue;
                        blocks.add(figures_block(
                            content,
                            {.section = "hysteresis", .point = point, .subject = table.name()}));
                        blocks.add(areas_table(table));
                      }
                      return blocks;
                    }),
       refusals_block(content.file, all)});
}

Json sweep_section(const PageContent& content) {
  const std::vector<TableView> all = tables_of(content.file, "analysis", "sweep");
  Blocks blocks;
  for (const TableView& table : not_refused(all)) {
    const Json figures = figures_block(content, {.section = "sweep", .subject = table.name()});
    if (figures.is_null()) continue;
    blocks.add(figures);
    blocks.add(statement_block("Maximum", table.note("maximum")));
    blocks.add(statement_block("Minimum", table.note("minimum")));
    if (std::isfinite(table.value("line_slope"))) {
      blocks.add(statement_block(
          "Straight line",
          "slope " + value_cell(table, "line_slope") +
              "; p of the hypothesis that the points lie on it: " + p_cell(table, "line_p", 0)));
    }
    blocks.add(differences_table(table));
  }
  blocks.add(refusals_block(content.file, all));
  return page_section("sweep", "Sweep curves", "A quantity against the swept value.", blocks);
}

Json cost_section(const PageContent& content) {
  Blocks blocks;
  for (const TableView& table : tables_of(content.file, "analysis", "cost")) {
    blocks.add(figures_block(content, {.section = "cost", .subject = table.name()}));
    blocks.add(
        details_block("All settings, " + words(table.path().back()), {settings_table(table)}));
  }
  return page_section("cost", "Accuracy against time",
                      "CPU time of settings of the relaxation, and the bias that each leaves.",
                      blocks);
}

Json precision_section(const PageContent& content) {
  Blocks blocks;
  for (const TableView& table : tables_of(content.file, "analysis", "target_precision")) {
    blocks.add(statement_block("Targets", table.note("verdict")));
    std::vector<PageRow> rows;
    for (std::size_t i = 0; i < table.axis("target").size(); ++i) {
      const double point = table.value("point", i);
      rows.push_back({words(text_at(table, "observable", i)),
                      std::isfinite(point) ? content.file.label(static_cast<std::uint32_t>(point))
                                           : "all points",
                      words(text_at(table, "spread", i)), number_cell(table, "value", i),
                      number_cell(table, "at_most", i)});
    }
    blocks.add(table_block(
        "Targets", {"observable", "sweep point", "spread", "largest over the taps", "required"},
        rows));
  }
  return page_section("precision", "Target precision", "", blocks);
}

}  // namespace jostle::inline study
