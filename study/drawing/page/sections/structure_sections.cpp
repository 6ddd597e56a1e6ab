#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/drawing/drawn/value_text.hpp"
#include "study/drawing/page/page_json.hpp"
#include "study/drawing/page/sections/sections.hpp"

// The structure measured inside the kept packings.
namespace jostle::inline study {
namespace {

struct Part {
  const char *name, *title;
  std::vector<std::string> numbers;  // in a table, by tap
};

const std::vector<Part>& structure_parts() {
  static const std::vector<Part> parts{
      {"profile",
       "Density profile",
       {"alpha", "phi_region", "eq7_phi_0", "eq7_alpha", "eq7_beta", "eq7_z_star", "eq7_status"}},
      {"sides", "Across the bed", {"lateral", "lateral_change", "central", "central_change"}},
      {"layers", "Layers", {"grown_layers"}},
      {"coordination", "Coordination", {"n_c", "n_c_all", "normal_mean", "normal_width"}},
      {"pair_correlation", "Pair correlation", {}},
      {"order", "Order", {"fcc", "hcp", "disordered", "q4", "q6", "w6"}},
      {"voronoi",
       "Voronoi cells",
       {"mean_faces", "mean_free_volume", "mean_local_fraction", "k", "k_gamma_k",
        "k_gamma_status"}},
      {"pores",
       "Pores",
       {"n_pores", "nu", "tetrahedral", "octahedral", "mean_touched", "tail_v0", "tail_status"}},
      {"void_probability", "Void probability", {"phi"}},
      {"holes", "Bernal's holes", {"unclassified"}},
      {"gaps", "Gaps and contacts", {"contacts", "backbone_contacts", "rattlers", "gap_exponent"}},
      {"structure_factor", "Structure factor", {"s_0_of_line", "s_0_of_squares"}},
      {"clusters", "Clusters of Voronoi cells", {"mean_volume"}},
  };
  return parts;
}

Json numbers_table(const TableView& table, const Part& part) {
  std::vector<std::string> names;
  for (const std::string& name : part.numbers) {
    if (table.has(name)) names.push_back(name);
  }
  if (names.empty()) return nullptr;
  PageRow head{"tap"};
  for (const std::string& name : names)
    head.emplace_back(printed_name(name) + unit_text(table.units(name)));
  const std::vector<double> taps = table.axis("tap");
  std::vector<PageRow> rows;
  for (std::size_t i = 0; i < taps.size(); ++i) {
    PageRow row{fmt::format("{}", taps[i])};
    for (const std::string& name : names) {
      const std::vector<std::string> texts = table.texts(name);
      row.emplace_back(i < texts.size() ? texts[i] : value_cell(table, name, i, UnitPlace::head));
    }
    rows.push_back(row);
  }
  return estimates_block(part.title, head, rows);
}

/// Differences between sweep points, one line per quantity and pair. `made`: tables of the points,
/// which may have been measured with other settings since.
Json differences_table(const DrawnFile& file, const TableView& table, const Part& part,
                       const std::vector<TableView>& made) {
  const std::vector<std::string> quantities = table.texts("quantity"), units = table.texts("units");
  const auto label = [&](const char* bound, std::size_t i) {
    return file.label(static_cast<std::uint32_t>(table.value(bound, i)));
  };
  std::vector<PageRow> rows;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const bool is_shown = std::ranges::find(part.numbers, quantities[i]) != part.numbers.end();
    const auto in_units = [&](const std::string& number) {
      return i < units.size() ? with_unit(number, units[i]) : number;
    };
    if (!is_shown || !std::isfinite(table.value("difference", i))) continue;
    rows.push_back(
        {Json{{"print", page_text(printed_name(quantities[i]))}},
         Json{{"print", page_text(label("to_point", i) + " against " + label("from_point", i))}},
         in_units(number_cell(table, "to_mean", i, 5)),
         in_units(number_cell(table, "from_mean", i, 5)),
         in_units(value_cell(table, "difference", i)), p_cell(table, "p", i),
         p_cell(table, "p_corrected", i)});
  }
  const bool has_others =
      std::ranges::any_of(made, [&](const TableView& own) { return !measured_alike(own, table); });
  const Json lines = estimates_block(
      fmt::format("Differences between sweep points after {} taps{}, {}", table.note("tap"),
                  has_others ? ", measured with " + table.note("settings") : "",
                  table.note("test")),
      {"quantity", "sweep points", "first", "second", "difference", "p", "p_corrected"}, rows);
  constexpr std::size_t most_unfolded = 12;
  if (rows.size() <= most_unfolded) return lines;
  return details_block(fmt::format("Differences in {} lines", rows.size()), {lines});
}

/// Sweep points beside each other.
Blocks comparison_blocks(const PageContent& content, const Part& part,
                         const std::vector<TableView>& made) {
  Blocks blocks{figures_block(content, {.section = part.name, .subject = comparison_subject})};
  for (const TableView& table : tables_of(content.file, "structure", "comparison")) {
    if (table.path().back() != part.name || table.is_refused()) continue;
    blocks.add(differences_table(content.file, table, part, made));
  }
  return blocks;
}

Json part_section(const PageContent& content, const Part& part) {
  const std::vector<TableView> all = tables_of(content.file, "structure", part.name),
                               made = not_refused(all);
  return page_section(
      part.name, part.title, "",
      {subsection_block("Sweep points beside each other", comparison_blocks(content, part, made)),
       points_block(content.file, numbers_of(made),
                    [&](std::uint32_t point) {
                      Blocks blocks{figures_block(content, {.section = part.name, .point = point})};
                      for (const TableView& table : made) {
                        if (table.point() != point) continue;
                        blocks.add(details_block("Numbers by tap", {numbers_table(table, part)}));
                        const std::string region = table.note("region");
                        blocks.add(small_block(region.empty() ? "" : "Counted: " + region + "."));
                      }
                      return blocks;
                    }),
       refusals_block(content.file, all)});
}

}  // namespace

Json snapshots_section(const PageContent& content) {
  std::vector<std::uint32_t> points;
  for (const Figure& figure : content.figures) {
    if (figure.section == "snapshots" && figure.point) points.push_back(*figure.point);
  }
  return page_section(
      "snapshots", "Kept packings", "Means over the packings that the run kept.",
      {figures_block(content, {.section = "snapshots", .subject = "coordination"}),
       points_block(content.file, points, [&](std::uint32_t point) {
         return Blocks{figures_block(
             content, {.section = "snapshots", .point = point, .subject = "heights"})};
       })});
}

std::vector<Json> structure_sections(const PageContent& content) {
  std::vector<Json> sections;
  for (const Part& part : structure_parts()) {
    if (Json section = part_section(content, part); !section.is_null()) {
      sections.push_back(std::move(section));
    }
  }
  return sections;
}

}  // namespace jostle::inline study
