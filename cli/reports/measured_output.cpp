#include "cli/reports/measured_output.hpp"

#include <fmt/format.h>

#include "cli/files/keep_tables.hpp"
#include "cli/files/output_file.hpp"
#include "cli/files/python_plot.hpp"
#include "study/drawing/figures/figures.hpp"
#include "study/drawing/page/measured_page.hpp"

namespace jostle::inline cli {
namespace {

/// The figures of the page, drawn by matplotlib.
std::vector<PageFigure> drawn_figures(const FittedCurve& fitted) {
  const std::vector<Figure> figures = figures_of(fitted).figures;
  std::vector<Json> described;
  for (const Figure& figure : figures) {
    described.push_back(figure_json(figure, fitted.source.title, Digits::all));
  }
  std::vector<PageFigure> page;
  for (PaperFigure& drawn : draw_with_python(described, JournalColumns::two)) {
    page.push_back({std::move(drawn.svg), ""});
    for (const FigurePanel& panel : figures[page.size() - 1].panels) {
      page.back().caption += (page.back().caption.empty() ? "" : " ") + panel.caption;
    }
  }
  return page;
}

}  // namespace

void add_measured_output(Command& command, MeasuredOutput& output) {
  const Option figures =
      command
          .add_option("--figures", output.figures.path,
                      "Folder for figures of the measured curve with its fits: SVG and PDF, "
                      "with data and Python scripts")
          .file_to_write();
  command
      .add_option("--columns", output.columns,
                  "Width of the figures: one column of a journal, 86 mm, or two, 178 mm (default: "
                  "1)")
      .limit(1, 2)
      .needs(figures);
  command
      .add_option("--page", output.page, "Page of the measured curve and its fits, for a browser")
      .file_to_write()
      .offers_files({"html"});
}

void require_measured_output(const MeasuredOutput& output, const std::string& input, bool force) {
  if (output.page.empty()) return;
  require_text_output("--page", output.page, std::span(&input, 1), force);
}

std::string write_measured(const MeasuredOutput& output, const FittedCurve& fitted,
                           const std::string& input, bool force, const Provenance& provenance) {
  std::string text;
  if (!output.figures.path.empty()) {
    FigureFolder folder = output.figures;
    folder.columns = output.columns == 2 ? JournalColumns::two : JournalColumns::single;
    folder.force = force;
    text += write_figures(fitted, input, folder, provenance);
  }
  if (!output.page.empty()) {
    write_text(output.page, measured_page(fitted, drawn_figures(fitted), provenance),
               existing_files(force));
    text += fmt::format("{}: open it in a browser\n", output.page);
  }
  return text;
}

}  // namespace jostle::inline cli
