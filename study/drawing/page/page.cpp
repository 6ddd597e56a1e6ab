#include "study/drawing/page/page.hpp"

#include "study/drawing/page/html_text.hpp"
#include "study/drawing/page/page_data.hpp"
#include "study/drawing/page/page_json.hpp"
#include "study/drawing/page/page_template.hpp"

namespace jostle::inline study {
namespace {

constexpr std::size_t packing_bytes =
    4'000'000;  // packing bytes of a page of one file; several share it

/// The template with each of its marks replaced; a mark occurs once.
std::string filled_template(const std::string& title, const std::string& data) {
  const std::string page = page_template();
  const auto cut = [&](const char* mark) { return page.find(mark); };
  constexpr std::string_view title_mark = "@TITLE@", data_mark = "@DATA@";
  const std::size_t at_title = cut(title_mark.data()), at_data = cut(data_mark.data());
  std::string html = page.substr(0, at_title);
  html += title;
  html += std::string_view(page).substr(at_title + title_mark.size(),
                                        at_data - at_title - title_mark.size());
  html += data;
  html += std::string_view(page).substr(at_data + data_mark.size());
  return html;
}

}  // namespace

std::string report_page(std::span<const PageSource> sources, const Provenance& provenance,
                        int threads) {
  const std::size_t n = std::max<std::size_t>(1, sources.size());
  const PageRoom room{DrawnRoom::of_one_in(n), packing_bytes / n};
  Json files = Json::array();
  std::string title;
  for (const PageSource& source : sources) {
    files.push_back(page_data(source.file, source.digest, room, threads));
    title += (title.empty() ? "" : ", ") + files.elements().back().at("file").text();
  }
  const Json data{{"format", 1},
                  {"made",
                   {{"version", page_text(provenance.version)},
                    {"git_revision", page_text(provenance.git_revision)},
                    {"command_line", page_text(provenance.command_line)},
                    {"started", page_text(provenance.started)}}},
                  {"files", files}};
  return filled_template(html_text(page_text(title, 200).text()), script_text(data));
}

}  // namespace jostle::inline study
