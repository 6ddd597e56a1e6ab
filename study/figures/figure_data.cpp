#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/figures/gnuplot.hpp"
#include "study/figures/gnuplot_text.hpp"

namespace jostle::inline study {
namespace {

std::string number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return fmt::format("{}", value);  // as many digits as it takes to read the same
}

}  // namespace

ColumnsOfData columns_of_data(const FigurePanel& panel) {
  ColumnsOfData columns;
  for (const FigureSeries& series : panel.series) {
    for (const FigureRow& row : series.rows) {
      columns.error = columns.error || !std::isnan(row.error);
      columns.limits = columns.limits || !std::isnan(row.low) || !std::isnan(row.high);
      columns.label = columns.label || !row.label.empty();
    }
  }
  return columns;
}

std::string figure_data(const Figure& figure, const std::string& origin) {
  std::string text = fmt::format("# {}\n", comment_text(origin));
  for (const FigurePanel& panel : figure.panels) {
    text += fmt::format("#\n# {}. {}\n", comment_text(panel.title), comment_text(panel.caption));
    if (!panel.source.empty()) text += fmt::format("# Source: {}\n", comment_text(panel.source));
  }
  bool is_first = true;
  for (const FigurePanel& panel : figure.panels) {
    const ColumnsOfData columns = columns_of_data(panel);
    for (const FigureSeries& series : panel.series) {
      text += is_first ? "\n" : "\n\n";
      is_first = false;
      const std::string name = series.is_guide       ? "line to guide the eye"
                               : series.name.empty() ? panel.title
                                                     : series.name;
      text += fmt::format("# {}\n# {}\t{}", comment_text(name), comment_text(panel.x.label),
                          comment_text(panel.y.label));
      if (columns.error) text += "\tstandard error";
      if (columns.limits) text += "\tlow\thigh";
      if (columns.label) text += "\tlabel";
      text += "\n";
      for (const FigureRow& row : series.rows) {
        text += number(row.x) + "\t" + number(row.y);
        if (columns.error) text += "\t" + number(row.error);
        if (columns.limits) text += "\t" + number(row.low) + "\t" + number(row.high);
        if (columns.label) text += "\t\"" + data_text(row.label) + "\"";
        text += "\n";
      }
    }
  }
  return text;
}

}  // namespace jostle::inline study
