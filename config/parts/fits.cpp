#include <fmt/format.h>

#include <algorithm>

#include "config/parts/parts.hpp"

namespace jostle::inline config {

namespace {

std::vector<std::string> fitted_models() {
  std::vector<std::string> models = relaxation_laws();
  models.emplace_back("all");
  return models;
}

/// One law, "all", or a list of laws that compete.
void read_models(const Reader& object, FitRequest& fit) {
  const auto model = object.find("model");
  if (!model) return object.missing("model", "one of the strings " + listed(fitted_models()));
  if (!model->value().is_array()) {
    if (const auto name = model->one_of(fitted_models())) fit.models = {*name};
    return;
  }
  const std::vector<std::string> laws = relaxation_laws();
  if (!model->is_list(1, laws.size(), "of the strings " + listed(laws))) return;
  for (std::size_t i = 0; i < model->value().size(); ++i) {
    const Reader element = model->element(i);
    const auto name = element.one_of(laws);
    if (!name) continue;
    if (std::ranges::find(fit.models, *name) != fit.models.end())
      element.fault(*name + " is listed twice");
    fit.models.push_back(*name);
  }
}

Json written_models(const FitRequest& fit) {
  return fit.models.size() == 1 ? Json(fit.models.front()) : Json(fit.models);
}

Json models_schema() {
  const std::vector<std::string> laws = relaxation_laws();
  return either(words_schema(fitted_models()), {{"type", "array"},
                                                {"minItems", 1},
                                                {"maxItems", laws.size()},
                                                {"uniqueItems", true},
                                                {"items", words_schema(laws)}});
}

void read_range(const Reader& object, FitRequest& fit) {
  const auto range = object.find("range");
  if (!range || !range->is_list(1, 2, "taps, first and last")) return;
  const Whole tap{0, most_taps};
  read_value(tap, range->element(0), fit.first);
  if (range->value().size() < 2 || !read_value(tap, range->element(1), fit.last.emplace())) return;
  if (*fit.last > fit.first) return;
  range->fault(fmt::format("the range from {} to {} is empty: the first tap must be the lower",
                           fit.first, *fit.last));
}

Json written_range(const FitRequest& fit) {
  Json range = Json::array({fit.first});
  if (fit.last) range.push_back(*fit.last);
  return range;
}

constexpr std::tuple fit_fields{
    field("observable", &FitRequest::observable, Text{}, "One that the scene observes",
          {.required = "the name of an observable of this scene"}),
    irregular(
        "model", read_models,
        [](const FitRequest& fit, Json& json) { json["model"] = written_models(fit); },
        [](ObjectSchema& schema, Definitions&) {
          schema.properties["model"] = described_as(
              models_schema(), "",
              "A law of docs/reference/laws.md, or a list of laws that compete; all: all that do, "
              "eqs. 3 and 4 as one.",
              std::nullopt, R"(["kww", ["inverse_log", "kww"]])");
          schema.required.emplace_back("model");
        }),
    irregular(
        "range", read_range,
        [](const FitRequest& fit, Json& json) { json["range"] = written_range(fit); },
        [](ObjectSchema& schema, Definitions& definitions) {
          schema.properties["range"] =
              described_as(value_schema(list_of(Whole{0, most_taps}, 1, 2, ""), definitions), "",
                           "First and last tap; without the last, to the end.", written_range({}),
                           "[[1, 4000], [10]]");
        })};

}  // namespace

std::vector<std::string> relaxation_laws() {
  return {"inverse_log", "inverse_log_height", "two_exponentials", "kww"};
}

// Eq. 4 is eq. 3 with other parameters.
std::vector<std::string> competing_laws() {
  return {"inverse_log", "two_exponentials", "kww"};
}

bool read_part(const Reader& reader, FitRequest& fit) {
  return read_object(fit_fields, reader, fit);
}
Json written_part(const FitRequest& fit) {
  return written_object(fit_fields, fit);
}
Json part_schema(std::type_identity<FitRequest>, Definitions& definitions) {
  return object_schema(fit_fields, definitions).json();
}

}  // namespace jostle::inline config
