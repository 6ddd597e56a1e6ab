#include "study/figures/gnuplot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/figures/gnuplot_text.hpp"
#include "study/figures/scales.hpp"

namespace jostle::inline study {
namespace {

// Lengths in mm. Digits of text_points are about so wide.
constexpr double digit_width = 1.57, line_height = 3.6, page_margin = 3, sample_width = 5.5;
constexpr double mm_per_inch = 25.4, points_per_inch = 72, pixels_per_inch = 96;
constexpr const char* ink = "#222222";
constexpr const char* dashes[] = {"solid", "'-'", "'.'", "'-..'"};
// gnuplot's circles, squares, triangles, diamonds, triangles that point down, pentagons.
constexpr int filled_symbols[] = {7, 5, 9, 13, 11, 15}, hollow_symbols[] = {6, 4, 8, 12, 10, 14};

int symbol_of(const FigureSeries& series) {
  return (series.hollow ? hollow_symbols : filled_symbols)[series.symbol % 6];
}

/// About the width of a text in Arial of text_points, mm.
double text_width(const std::string& text) {
  constexpr std::string_view narrow = "fijlrtI.,:;'()[]!|/ -", wide = "mwMW%@";
  double width = 0;
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) & 0xc0) == 0x80) continue;  // not the first byte of a letter
    const bool is_capital = c >= 'A' && c <= 'Z';
    width += narrow.find(c) != std::string_view::npos ? 0.34
             : wide.find(c) != std::string_view::npos ? 0.85
             : is_capital                             ? 0.7
                                                      : 0.56;
  }
  return width * text_points * mm_per_inch / points_per_inch;
}

/// As much of it as is not wider.
std::string cut_to(const std::string& text, double width) {
  std::size_t n = n_letters(text);
  while (n > 1 && text_width(first_letters(text, n)) > width) --n;
  return first_letters(text, n);
}

/// Where everything stands, in mm from the lower left corner.
struct PageLayout {
  double width = 0, height = 0, left = 0, right = 0;
  struct Band {
    double bottom, top;
  };
  std::vector<Band> panels;  // from the top
  std::size_t key_columns = 1;
  double key_top = 0, key_entry_width = 0;
  std::vector<const FigureSeries*> key;
  double name_width = 0;

  double x(double mm) const { return mm / width; }
  double y(double mm) const { return mm / height; }
};

/// Named series, which all panels draw alike; none where there is but one.
std::vector<const FigureSeries*> key_of(const Figure& figure) {
  std::vector<const FigureSeries*> key;
  for (const FigureSeries& series : figure.panels.front().series) {
    if (!series.name.empty()) key.push_back(&series);
  }
  if (key.size() < 2) key.clear();
  return key;
}

double below_axis(const FigurePanel& panel, const Scale& scale) {
  if (panel.x.kind != AxisKind::names) return 11.5;
  double longest = 0;
  for (const Tick& tick : scale.ticks) longest = std::max(longest, text_width(tick.label));
  return 10 + 0.5 * longest;  // of labels that rise by 30 degrees
}

PageLayout layout_of(const Figure& figure, JournalColumns columns, const std::vector<Scale>& xs,
                     const std::vector<Scale>& ys) {
  PageLayout page;
  const bool is_narrow = columns == JournalColumns::one;
  page.width = is_narrow ? one_column_mm : two_columns_mm;
  std::size_t longest = 1;
  for (const Scale& scale : ys) longest = std::max(longest, scale.longest_label);
  page.left = 10 + digit_width * static_cast<double>(longest);
  page.right = page.width - page_margin;
  page.key = key_of(figure);
  double key_height = 0;
  if (!page.key.empty()) {
    const double room = page.right - page.left;
    for (const FigureSeries* one : page.key) {
      page.name_width = std::max(page.name_width, text_width(one->name));
    }
    page.name_width = std::min(page.name_width, room - sample_width - 1);
    page.key_entry_width = sample_width + 4 + page.name_width;
    page.key_columns = std::clamp<std::size_t>(
        static_cast<std::size_t>((room + 3) / page.key_entry_width), 1, page.key.size());
    const std::size_t rows = (page.key.size() + page.key_columns - 1) / page.key_columns;
    key_height = line_height * static_cast<double>(rows) + 1;
  }
  const double first = is_narrow ? 48 : 80, other = is_narrow ? 20 : 32, between = 3;
  const auto n_others = static_cast<double>(figure.panels.size() - 1);
  const double bottom = below_axis(figure.panels.back(), xs.back());
  page.height = bottom + first + n_others * (other + between) + key_height + page_margin;
  page.key_top = page.height - page_margin / 2;
  double top = page.height - page_margin - key_height;
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    const double height = i == 0 ? first : other;
    page.panels.push_back({top - height, top});
    top -= height + between;
  }
  return page;
}

/// Of even ticks: all with the digits of their step, but where that would be many.
std::string tick_format(const Scale& scale) {
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(scale.step) - 1e-9)));
  const double most = std::max(std::abs(scale.low), std::abs(scale.high));
  return decimals > 5 || most >= 1e6 ? "%h" : fmt::format("%.{}f", decimals);
}

/// "set xrange ..." and what stands along the axis.
std::string axis_text(char axis, const Scale& scale, const FigureAxis& of, bool is_labelled) {
  std::string text;
  const std::string low = fmt::format("{:.10g}", scale.low),
                    high = fmt::format("{:.10g}", scale.high);
  text += scale.is_logarithmic ? fmt::format("  set logscale {}\n", axis)
                               : fmt::format("  unset logscale {}\n", axis);
  text += fmt::format("  set {}range [{}:{}]\n", axis, low, high);
  if (!is_labelled) text += fmt::format("  set format {} ''\n", axis);
  if (scale.step > 0) {
    if (is_labelled) text += fmt::format("  set format {} '{}'\n", axis, tick_format(scale));
    text += fmt::format("  set {0}tics {1:.10g}\n  set m{0}tics {2}\n", axis, scale.step,
                        scale.is_whole ? 1 : 2);
  } else {
    std::string ticks;
    for (const Tick& tick : scale.ticks) {
      std::string label = of.kind == AxisKind::names ? quoted(tick.label) : "'" + tick.label + "'";
      for (std::size_t at = 0; (at = label.find('%', at)) != std::string::npos; at += 2) {
        label.insert(at, "%");
      }
      ticks += fmt::format("{}{} {:.10g}", ticks.empty() ? "" : ", ", is_labelled ? label : "''",
                           tick.at);
    }
    for (const double at : scale.minor) ticks += fmt::format(", '' {:.10g} 1", at);
    text += fmt::format("  set {}tics {}({})\n", axis,
                        of.kind == AxisKind::names ? "rotate by 30 right " : "", ticks);
  }
  return text;
}

/// What the axes show, in the same place whatever the width of their ticks.
std::string labels_text(const FigurePanel& panel, const PageLayout& page,
                        const PageLayout::Band& band, bool is_last, int& number) {
  constexpr double from_edge = 3;
  std::string text = fmt::format(
      "  set label {} {} at screen {:.4f}, screen {:.4f} center rotate by 90\n", ++number,
      quoted(panel.y.label), page.x(from_edge), page.y((band.bottom + band.top) / 2));
  if (is_last) {
    text +=
        fmt::format("  set label {} {} at screen {:.4f}, screen {:.4f} center\n", ++number,
                    quoted(panel.x.label), page.x((page.left + page.right) / 2), page.y(from_edge));
  }
  return text;
}

/// Where tap 0 stands apart, two strokes through the axis.
std::string break_text(const PageLayout& page, const PageLayout::Band& band, int& number) {
  std::string text;
  const double base = page.y(band.bottom), up = page.y(1);
  for (const double at : {0.50, 0.56}) {
    text += fmt::format(
        "  set arrow {} from first {}, screen {:.4f} to first {}, screen {:.4f} nohead lw 0.75 lc "
        "rgb '{}'\n",
        ++number, at * 0.96, base - up, at * 1.04, base + up, ink);
  }
  return text;
}

std::string rules_text(const FigurePanel& panel, int& number) {
  std::string text;
  for (const FigureRule& rule : panel.rules) {
    const std::string from = rule.x ? fmt::format("first {:.10g}, graph 0", *rule.x)
                                    : fmt::format("graph 0, first {:.10g}", *rule.y);
    const std::string to = rule.x ? fmt::format("first {:.10g}, graph 1", *rule.x)
                                  : fmt::format("graph 1, first {:.10g}", *rule.y);
    text +=
        fmt::format("  set arrow {} from {} to {} nohead back lw 0.75 dt '.' lc rgb '#777777'\n",
                    ++number, from, to);
  }
  return text;
}

std::string key_text(const PageLayout& page, int& number) {
  std::string text;
  for (std::size_t i = 0; i < page.key.size(); ++i) {
    const FigureSeries& one = *page.key[i];
    const double left =
        page.left + static_cast<double>(i % page.key_columns) * page.key_entry_width;
    const double height =
        page.key_top - line_height * (0.5 + static_cast<double>(i / page.key_columns));
    const double y = page.y(height);
    if (one.drawn != Drawn::points) {
      text += fmt::format(
          "  set arrow {} from screen {:.4f}, screen {:.4f} to screen {:.4f}, screen {:.4f} nohead "
          "lw 1.5 dt {} lc rgb '{}'\n",
          ++number, page.x(left), y, page.x(left + sample_width), y, dashes[one.dash % 4],
          one.colour);
    }
    const std::string point = one.drawn == Drawn::line ? ""
                                                       : fmt::format(" point pt {} lc rgb '{}'",
                                                                     symbol_of(one), one.colour);
    if (!point.empty()) {
      text += fmt::format("  set label {} '' at screen {:.4f}, screen {:.4f}{}\n", ++number,
                          page.x(left + sample_width / 2), y, point);
    }
    text += fmt::format("  set label {} {} at screen {:.4f}, screen {:.4f} left\n", ++number,
                        quoted(cut_to(one.name, page.name_width + 0.1)),
                        page.x(left + sample_width + 1), y);
  }
  return text;
}

/// Of gnuplot's `using`: the columns of one panel's data.
struct DataColumns {
  std::string low, high, label;  // empty where there is none
};

DataColumns columns_of(const FigurePanel& panel) {
  const ColumnsOfData there = columns_of_data(panel);
  DataColumns columns;
  int next = 3;
  if (there.error) {
    columns.low = fmt::format("low($2, $2 - ${})", next);
    columns.high = fmt::format("high($2, $2 + ${})", next);
    ++next;
  }
  if (there.limits) {
    columns.low = fmt::format("low($2, ${})", next);
    columns.high = fmt::format("high($2, ${})", next + 1);
    next += 2;
  }
  if (there.label) columns.label = fmt::format("{}", next);
  return columns;
}

bool has_errors(const FigureSeries& series) {
  return std::ranges::any_of(series.rows,
                             [](const FigureRow& row) { return lower_end(row) < upper_end(row); });
}

/// The parts of gnuplot's `plot` that draw one series, block `index` of the data.
std::vector<std::string> elements_of(const FigureSeries& series, const DataColumns& columns,
                                     std::size_t index, bool has_break) {
  const std::string data = fmt::format("data index {} using ", index);
  const std::string x = has_break ? "(later($1))" : "1", all_x = has_break ? "(place($1))" : "1";
  const std::string colour = fmt::format("lc rgb '{}'", series.colour);
  const std::string bars = fmt::format(":2:({}):({})", columns.low, columns.high);
  const bool errors = !columns.low.empty() && has_errors(series);
  const auto n = std::ranges::count_if(series.rows, [](const FigureRow& row) {
    return std::isfinite(row.x) && std::isfinite(row.y) && row.x >= 1;
  });
  std::vector<std::string> elements;
  if (series.drawn == Drawn::line) {
    if (errors && series.has_band) {
      elements.push_back(fmt::format(
          "{}{}:({}):({}) with filledcurves fc rgb '{}' fs transparent solid 0.2 noborder", data, x,
          columns.low, columns.high, series.colour));
    }
    elements.push_back(
        fmt::format("{}{}:2 with lines lw 1.5 dt {} {}", data, x, dashes[series.dash % 4], colour));
    if (n == 1) elements.push_back(fmt::format("{}{}:2 with points pt 7 {}", data, x, colour));
    const bool has_zero = has_break && std::ranges::any_of(series.rows, [](const FigureRow& row) {
                            return row.x < 1 && std::isfinite(row.y);
                          });
    if (has_zero && !series.is_guide) {
      elements.push_back(fmt::format("{}(zero($1)){} {} pt 7 {}", data, errors ? bars : ":2",
                                     errors ? "with yerrorbars lw 0.75" : "with points", colour));
    }
    return elements;
  }
  if (series.drawn != Drawn::points) {
    elements.push_back(fmt::format("{}{}:2 with {} lw 1 dt {} {}", data, x,
                                   series.drawn == Drawn::stepped_points ? "steps" : "lines",
                                   dashes[series.dash % 4], colour));
  }
  elements.push_back(fmt::format("{}{}{} {} pt {} {}", data, all_x, errors ? bars : ":2",
                                 errors ? "with yerrorbars lw 0.75" : "with points",
                                 symbol_of(series), colour));
  if (series.has_labels && !columns.label.empty()) {
    elements.push_back(
        fmt::format("{}{}:2:{} with labels offset 0, 0.6 noenhanced", data, all_x, columns.label));
  }
  return elements;
}

std::string panel_text(const FigurePanel& panel, const Scale& x, const Scale& y,
                       const PageLayout& page, std::size_t number, std::size_t& index,
                       int& n_marks) {
  const PageLayout::Band& band = page.panels[number];
  const bool is_last = number + 1 == page.panels.size();
  std::string text = fmt::format(
      "  set lmargin at screen {:.4f}\n  set rmargin at screen {:.4f}\n  set tmargin at screen "
      "{:.4f}\n  set bmargin at screen {:.4f}\n",
      page.x(page.left), page.x(page.right), page.y(band.top), page.y(band.bottom));
  text += axis_text('x', x, panel.x, is_last) + axis_text('y', y, panel.y, true);
  text += fmt::format("  low(y, end) = end > {0} ? end : (end == end ? {0} : y)\n",
                      y.is_logarithmic ? fmt::format("{:.10g}", y.low) : "-1e300");
  text += labels_text(panel, page, band, is_last, n_marks);
  if (x.has_break) text += break_text(page, band, n_marks);
  text += rules_text(panel, n_marks);
  const DataColumns columns = columns_of(panel);
  std::string plot;
  for (const FigureSeries& series : panel.series) {
    for (const std::string& element : elements_of(series, columns, index, x.has_break)) {
      plot += (plot.empty() ? "  plot " : ", \\\n       ") + element + " notitle";
    }
    ++index;
  }
  return text + plot + "\n";
}

}  // namespace

std::string figure_script(const Figure& figure, JournalColumns columns) {
  const std::size_t x_ticks = columns == JournalColumns::one ? 6 : 10;
  std::vector<Scale> xs, ys;
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    xs.push_back(scale_of_x(figure.panels[i], x_ticks));
    ys.push_back(scale_of_y(figure.panels[i], i == 0 ? 6 : 3));
  }
  const PageLayout page = layout_of(figure, columns, xs, ys);
  std::string text;
  for (const FigurePanel& panel : figure.panels) {
    text += fmt::format("# {}. {}\n", comment_text(panel.title), comment_text(panel.caption));
    if (!panel.source.empty()) text += fmt::format("# Source: {}\n", comment_text(panel.source));
  }
  text += fmt::format(
      "# gnuplot {0}.gp draws {0}.svg and {0}.pdf of {0}.dat. Blocks of the data have the colours "
      "and symbols of their lines below.\n\n"
      "data = '{0}.dat'\n"
      "set encoding utf8\nset minussign\nset datafile separator tab\nset errorbars 0\n"
      "unset key\nset border 3 lw 0.75 lc rgb '{1}'\nset tics out nomirror scale 0.6, 0.3\n"
      "set style fill transparent solid 0.2 noborder\n",
      figure.name, ink);
  text += "high(y, end) = end < 1e300 ? end : y\n";
  if (std::ranges::any_of(xs, &Scale::has_break)) {
    text += fmt::format(
        "# Tap 0 stands apart, to the left of the break of the axis.\n"
        "place(t) = t < 1 ? {0} : t\nlater(t) = t < 1 ? NaN : t\nzero(t) = t < 1 ? {0} : NaN\n",
        place_of_tap_zero);
  }
  // pdfcairo takes 96 points for an inch: its fonts are scaled back.
  const double pixels = pixels_per_inch / mm_per_inch;
  text += fmt::format(
      "\ndo for [form in 'svg pdf'] {{\n"
      "  if (form eq 'svg') {{\n"
      "    set terminal svg enhanced size {:.0f},{:.0f} font 'Arial,{:.2f}' linewidth 1 background "
      "rgb 'white'\n"
      "    set pointsize 0.45\n"
      "  }} else {{\n"
      "    set terminal pdfcairo enhanced size {:.2f}cm,{:.2f}cm font 'Arial,{}' fontscale 0.75 "
      "linewidth 1.5\n"
      "    set pointsize 0.5\n"
      "  }}\n"
      "  set output '{}.' . form\n",
      page.width * pixels, page.height * pixels, text_points * pixels_per_inch / points_per_inch,
      page.width / 10, page.height / 10, text_points, figure.name);
  const bool has_several = figure.panels.size() > 1;
  std::size_t index = 0;
  int n_marks = 0;
  if (has_several) text += "  set multiplot\n";
  text += key_text(page, n_marks);
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    if (i > 0) text += "  unset arrow\n  unset label\n";
    text += panel_text(figure.panels[i], xs[i], ys[i], page, i, index, n_marks);
  }
  if (has_several) text += "  unset multiplot\n  unset arrow\n  unset label\n";
  return text + "  unset output\n}\n";
}

}  // namespace jostle::inline study
