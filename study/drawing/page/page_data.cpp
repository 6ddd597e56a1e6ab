#include "study/drawing/page/page_data.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "study/drawing/drawn/study_words.hpp"
#include "study/drawing/drawn/thinning.hpp"
#include "study/drawing/figures/catalogue.hpp"
#include "study/drawing/figures/figures.hpp"
#include "study/drawing/page/page_json.hpp"
#include "study/drawing/page/page_packings.hpp"
#include "study/drawing/page/page_run.hpp"
#include "study/drawing/page/sections/sections.hpp"

namespace jostle::inline study {
namespace {

/// The sweep points of curves that show several; the page switches them on and off.
Json curve_points(const DrawnFile& drawn) {
  Json points = Json::array();
  const std::vector<ShownPoint> all = drawn.shown_points();
  const std::vector<std::size_t> usual = evenly_spread(all.size(), most_shown);
  for (std::size_t i = 0; i < all.size(); ++i) {
    points.push_back({{"number", all[i].number},
                      {"label", page_text(drawn.label(all[i].number))},
                      {"colour", colour_json(all[i].colour)},
                      {"shown", std::ranges::find(usual, i) != usual.end()}});
  }
  return points;
}

/// "512 spheres in periodic sides, 8 x 8 diameters; 8 realizations at each of 3 sweep points (ε =
/// 0.02 to ε = 0.3)".
std::string run_words(const Study& study, const DrawnFile& drawn) {
  std::string text = study_words(study);
  if (const std::size_t n = study.points.size(); n > 1) {
    text += fmt::format(" ({} points, {} to {})", n, drawn.label(0),
                        drawn.label(static_cast<std::uint32_t>(n - 1)));
  }
  return text;
}

}  // namespace

Json page_data(const ResultsFile& file, const std::string& digest, const PageRoom& room,
               int threads) {
  const DrawnFile drawn(file, room.drawn, {}, DrawnPoints::all);
  std::vector<std::string> left_out = drawn.left_out();
  Json data = page_run(file, drawn, digest, left_out);
  const std::vector<Figure> figures = figures_of(drawn);
  Json described = Json::array();
  for (const Figure& figure : figures) {
    described.push_back(figure_json(figure, "", Digits::seven));
  }
  data["curve_points"] = curve_points(drawn);
  data["figures"] = described;
  data["packings"] = page_packings(file, room.packing_bytes, threads, left_out);
  data["summary"] = summary_section(drawn, run_words(file.study(), drawn), file.path());
  data["sections"] = page_sections(drawn, figures,
                                   {.has_grains = common_unit(file.study()) != "trials",
                                    .has_packings = !data["packings"].empty()});
  Json texts = Json::array();
  for (const std::string& text : left_out) texts.push_back(page_text(text));
  data["left_out"] = texts;
  return data;
}

}  // namespace jostle::inline study
