#include "study/drawing/page/sections/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "ensemble/statistics/counted.hpp"
#include "study/drawing/drawn/value_text.hpp"

namespace jostle::inline study {
namespace {

Json curves_section(const PageContent& content, const std::string& id, const std::string& title,
                    const std::string& intro, const std::string& subject) {
  return page_section(id, title, intro, {figures_block(content, {.section = subject})});
}

/// The figures of a section that only some readers look for, folded until one asks for them.
Json folded_section(const PageContent& content, const std::string& id, const std::string& title,
                    const std::string& intro, const std::string& subject) {
  const Json figures = figures_block(content, {.section = subject});
  if (figures.is_null()) return nullptr;
  const std::size_t n = figures.at("figures").size();
  return page_section(id, title, intro,
                      {details_block(fmt::format("Show {}", counted(n, "figure")), {figures})});
}

Json engine_section(const PageContent& content, bool has_grains) {
  return has_grains
             ? folded_section(content, "grains", "Grains: energies and contacts",
                              "Quantities that the integration of the grains records at each tap. "
                              "Energies are in m g d per sphere.",
                              "engine")
             : folded_section(content, "relaxation", "Relaxation",
                              "Quantities that the relaxation records at each tap.", "engine");
}

std::string listed(const TableView& table, const std::string& quantity) {
  constexpr std::size_t most = 50;
  std::string text;
  const auto add = [&](const std::string& sentence) {
    text += (text.empty() ? "" : ", ") + sentence;
  };
  const std::vector<std::string> texts = table.texts(quantity);
  for (std::size_t i = 0; i < std::min(most, texts.size()); ++i) add(texts[i]);
  const std::vector<double> values = table.values(quantity);
  for (std::size_t i = 0; i < std::min(most, values.size()); ++i) add(typeset_number(values[i]));
  return text;
}

/// Tables of a later version, or another program, which no section shows.
Json other_section(const PageContent& content) {
  static const std::set<std::string> analyses{
      "steady",           "spectrum", "ageing", "hysteresis", "cost",  "sweep",
      "target_precision", "ordering", "motion", "volumes",    "memory"},
      parts{"profile",          "sides",     "layers",  "coordination",
            "pair_correlation", "order",     "voronoi", "pores",
            "void_probability", "holes",     "gaps",    "structure_factor",
            "clusters",         "comparison"};
  Blocks blocks;
  for (const TableView& table : content.file.tables()) {
    const std::string& kind = table.path().front();
    const bool is_shown = table.group() == "fits" ||
                          (table.group() == "analysis" && analyses.contains(kind)) ||
                          (table.group() == "structure" && parts.contains(kind));
    if (is_shown) continue;
    std::vector<PageRow> rows;
    for (const std::string& quantity : table.quantities()) {
      rows.push_back({words(quantity) + unit_text(table.units(quantity)), listed(table, quantity)});
    }
    blocks.add(details_block(table.group() + "/" + table.name(),
                             {table_block(table.name(), {"quantity", "values"}, rows)}));
  }
  return page_section("others", "Other tables", "", blocks);
}

}  // namespace

Json page_sections(const DrawnFile& file, const std::vector<Figure>& figures,
                   const PageParts& parts) {
  const PageContent content{file, figures};
  Json sections = Json::array();
  const auto add = [&](const Json& section) {
    if (!section.is_null()) sections.push_back(section);
  };
  add(curves_section(content, "compaction", "Compaction",
                     "How the bed changes from tap to tap, as means over realizations.",
                     "compaction"));
  add(folded_section(content, "spread", "Spread over realizations",
                     "The standard deviation over realizations at each tap.", "spread"));
  if (parts.has_packings) {
    add(page_section("packing", "A packing",
                     "Drag to turn; pinch, or click and scroll, to magnify; arrow keys, + and − do "
                     "the same.",
                     {Json{{"kind", "packing"}}}));
  }
  for (const auto make : {fits_section, steady_section, ageing_section, spectra_section,
                          hysteresis_section, sweep_section, ordering_section, motion_section,
                          volumes_section, memory_section, snapshots_section}) {
    add(make(content));
  }
  for (const Json& section : structure_sections(content)) add(section);
  add(engine_section(content, parts.has_grains));
  for (const auto make : {cost_section, precision_section, other_section}) add(make(content));
  return sections;
}

}  // namespace jostle::inline study
