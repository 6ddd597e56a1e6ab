#include "study/drawing/figures/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/drawing/page/page_json.hpp"

namespace jostle::inline study {
namespace {

/// An axis of an unknown name is linear.
constexpr const char* scale_names[] = {"linear", "log", "taps", "names"};
constexpr const char* mark_names[] = {"line", "points", "joined", "steps"};

Json axis_json(const FigureAxis& axis) {
  Json json{{"label", page_text(axis.label)},
            {"scale", scale_names[static_cast<std::size_t>(axis.kind)]}};
  if (axis.from_zero) json["from_zero"] = true;
  if (axis.low) json["low"] = page_number(*axis.low);
  if (axis.high) json["high"] = page_number(*axis.high);
  if (axis.kind == AxisKind::names) {
    json["names"] = Json::array();
    for (const std::string& name : axis.names) json["names"].push_back(page_text(name));
  }
  return json;
}

Json exact_number(double value) {
  if (std::isnan(value)) return nullptr;
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  constexpr double all_whole = 1e15;  // up to which every whole number is a double
  if (value == std::trunc(value) && std::abs(value) < all_whole && value != 0) {
    return static_cast<std::int64_t>(value);
  }
  return value;
}

/// Adds a column of the rows; nothing where none has a value.
void add_column(Json& json, const char* name, const std::vector<FigureRow>& rows,
                double FigureRow::*member, Digits digits) {
  const bool is_place = member == &FigureRow::x || member == &FigureRow::y;
  const bool has_value =
      std::ranges::any_of(rows, [&](const FigureRow& row) { return !std::isnan(row.*member); });
  if (!is_place && !has_value) return;
  Json values = Json::array();
  for (const FigureRow& row : rows) {
    values.push_back(digits == Digits::all ? exact_number(row.*member) : page_number(row.*member));
  }
  json[name] = values;
}

bool has_texts(const FigureSeries& series) {
  return std::ranges::any_of(series.rows, [](const FigureRow& row) { return !row.label.empty(); });
}

Json series_json(const FigureSeries& series, Digits digits) {
  Json json{{"name", page_text(series.name)},
            {"colour", colour_json(series.colour)},
            {"mark", mark_names[static_cast<std::size_t>(series.drawn)]},
            {"dash", series.dash},
            {"symbol", series.symbol}};
  if (series.point) json["point"] = *series.point;
  for (const auto& [name, is_set] : {std::pair{"hollow", series.hollow},
                                     {"no_band", !series.has_band},
                                     {"guide", series.is_guide},
                                     {"thin", series.is_thin},
                                     {"labelled", series.has_labels}}) {
    if (is_set) json[name] = true;
  }
  add_column(json, "x", series.rows, &FigureRow::x, digits);
  add_column(json, "y", series.rows, &FigureRow::y, digits);
  add_column(json, "error", series.rows, &FigureRow::error, digits);
  add_column(json, "low", series.rows, &FigureRow::low, digits);
  add_column(json, "high", series.rows, &FigureRow::high, digits);
  if (has_texts(series)) {
    json["labels"] = Json::array();
    for (const FigureRow& row : series.rows) json["labels"].push_back(page_text(row.label));
  }
  return json;
}

Json panel_json(const FigurePanel& panel, Digits digits) {
  Json rules = Json::array(), series = Json::array();
  for (const FigureRule& rule : panel.rules) {
    rules.push_back({{rule.x ? "x" : "y", page_number(rule.x ? *rule.x : *rule.y)}});
  }
  for (const FigureSeries& drawn_series : panel.series)
    series.push_back(series_json(drawn_series, digits));
  return {{"title", page_text(panel.title)},
          {"caption", page_text(panel.caption)},
          {"source", page_text(panel.source)},
          {"x", axis_json(panel.x)},
          {"y", axis_json(panel.y)},
          {"rules", rules},
          {"series", series}};
}

std::string text_cell(const std::string& text) {
  std::string cell = page_text(text).text();
  if (!cell.empty() && std::string_view("=+-@\t\r").find(cell[0]) != std::string_view::npos) {
    cell.insert(0, "'");
  }
  if (cell.find_first_of("\",\n\r") == std::string::npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string number_cell(double value) {
  if (std::isnan(value)) return "";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return fmt::format("{}", value);
}

/// All panels of a figure have one x axis.
std::string csv_head(const Figure& figure) {
  std::string values;
  for (const FigurePanel& panel : figure.panels) {
    values += (values.empty() ? "" : " | ") + panel.y.label;
  }
  return "panel,series," + text_cell(figure.panels.front().x.label) + "," + text_cell(values) +
         ",half width 68 %,low,high,label\n";
}

}  // namespace

Json colour_json(const FigureColour& colour) {
  return {{"light", colour.light}, {"dark", colour.dark}};
}

Json figure_json(const Figure& figure, const std::string& origin, Digits digits) {
  Json json{{"name", figure.name}, {"section", figure.section}};
  if (figure.point) json["point"] = *figure.point;
  if (!figure.subject.empty()) json["subject"] = page_text(figure.subject);
  if (!origin.empty()) json["origin"] = page_text(origin);
  json["panels"] = Json::array();
  for (const FigurePanel& panel : figure.panels)
    json["panels"].push_back(panel_json(panel, digits));
  return json;
}

Json catalogue_json(const std::vector<Json>& figures, const std::vector<std::string>& left_out) {
  Json texts = Json::array();
  for (const std::string& text : left_out) texts.push_back(page_text(text));
  return {{"format", 1}, {"figures", figures}, {"left_out", texts}};
}

std::string figure_csv(const Figure& figure) {
  std::string text = csv_head(figure);
  for (const FigurePanel& panel : figure.panels) {
    for (const FigureSeries& series : panel.series) {
      const std::string names =
          text_cell(panel.title) + "," +
          (series.is_guide ? "line to guide the eye" : text_cell(series.name));
      for (const FigureRow& row : series.rows) {
        text += names;
        for (const double value : {row.x, row.y, row.error, row.low, row.high}) {
          text += "," + number_cell(value);
        }
        text += "," + text_cell(row.label) + "\n";
      }
    }
  }
  return text;
}

std::string figure_script(const std::string& name, JournalColumns columns) {
  return fmt::format(R"PYTHON(#!/usr/bin/env python3
"""Draws {0}.pdf and {0}.svg from {0}.json. Needs matplotlib and the Python package of jostle."""

import json
import pathlib

from jostle import plot

here = pathlib.Path(__file__).resolve().parent
figure = json.loads((here / "{0}.json").read_text(encoding="utf-8"))
drawn = plot.draw(figure, columns={1})
# Change what you like: drawn.axes[0].set_ylim(...), drawn.axes[0].set_xlabel(...)
plot.save(drawn, here / "{0}")
)PYTHON",
                     name, static_cast<int>(columns));
}

}  // namespace jostle::inline study
