#include "study/drawing/page/measured_page.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "fitting/report.hpp"
#include "study/drawing/page/html_text.hpp"
#include "study/drawing/page/page_json.hpp"

namespace jostle::inline study {
namespace {

constexpr const char* page_head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{0}</title>
<style>
body {{ font: 16px/1.5 system-ui, sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; color: #222; background: #fff }}
table {{ border-collapse: collapse; margin: 1rem 0 }}
th, td {{ text-align: left; padding: .25rem .8rem .25rem 0; border-bottom: 1px solid #ccc; vertical-align: top }}
img {{ max-width: 100% }}
figcaption, .small {{ font-size: .9rem; color: #555 }}
code {{ font-size: .95rem }}
</style></head><body>
<h1>{0}</h1>
)";

std::string paragraph(const std::string& text) {
  return fmt::format("<p>{}</p>\n", html_text(text));
}

std::string listed(const std::vector<std::string>& texts) {
  if (texts.empty()) return "";
  std::string list = "<ul>\n";
  for (const std::string& text : texts) list += fmt::format("<li>{}</li>\n", html_text(text));
  return list + "</ul>\n";
}

std::string figure_html(const PageFigure& figure) {
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(figure.svg.data()),
                        figure.svg.size());
  return fmt::format(
      "<figure><img alt=\"{0}\" src=\"data:image/svg+xml;base64,{1}\">\n"
      "<figcaption>{0}</figcaption></figure>\n",
      html_text(figure.caption), base64(bytes));
}

std::string formula_html(const std::string& formula, const std::string& source) {
  return fmt::format("<p><code>X = {}</code> {}</p>\n", html_text(formula), html_text(source));
}

std::string estimates_html(const std::vector<Estimate>& estimates, const CurveUnits& units) {
  std::string text =
      "<table><tr><th>parameter</th><th>unit</th><th>value</th><th>95 % interval</th>"
      "<th>statement</th></tr>\n";
  for (const Estimate& estimate : estimates) {
    text += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                        html_text(estimate.parameter.name),
                        html_text(unit_text(estimate.parameter.unit, units)),
                        html_text(estimate_text(estimate)), html_text(interval_text(estimate, 1)),
                        html_text(estimate.statement));
  }
  return text + "</table>\n";
}

std::string law_html(const Fit& fit, const CurveUnits& units) {
  std::string text = fmt::format("<h2>{}</h2>\n", html_text(fit.model));
  text += formula_html(fit.formula, fit.source);
  for (const ParameterTable& table : parameter_tables(fit)) {
    if (!table.heading.empty()) text += paragraph(table.heading + ":");
    text += estimates_html(table.estimates, units);
  }
  return text + listed(fit.remarks);
}

}  // namespace

std::string measured_page(const FittedCurve& fitted, std::span<const PageFigure> figures,
                          const Provenance& provenance) {
  std::vector<Fit> fits;
  std::vector<std::string> refusals;
  for (const FitOutcome& outcome : fitted.outcomes) {
    if (const auto* refusal = std::get_if<Refusal>(&outcome.result)) {
      refusals.push_back(outcome.model + ": no fit: " + refusal->message);
    } else {
      fits.push_back(std::get<Fit>(outcome.result));
    }
  }
  std::string text = fmt::format(page_head, html_text(fitted.source.title));
  text += listed(fitted.source.notes);
  if (!fits.empty()) text += paragraph(verdict(fits, fitted.comparison));
  for (const PageFigure& figure : figures) text += figure_html(figure);
  for (const Fit& fit : fits) text += law_html(fit, fitted.source.units);
  text += listed(refusals);
  text +=
      "<p class=\"small\">a(b): b, in the last digits of a, is half the 68 % interval; -: it is "
      "open, or the 95 % interval is on both sides. ";
  return text +
         html_text(fmt::format("Made {} by jostle {} ({}): {}", provenance.started,
                               provenance.version, provenance.git_revision,
                               provenance.command_line)) +
         "</p>\n</body></html>\n";
}

}  // namespace jostle::inline study
