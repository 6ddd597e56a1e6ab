#include "study/drawing/drawn/point_labels.hpp"

#include <catch2/catch.hpp>

#include "config/sweep.hpp"

namespace jostle {

namespace {

using Values = std::vector<std::pair<std::string, std::string>>;

/// A study whose points sweep these values, labelled as scenes without labels do.
Study swept(const std::vector<Values>& points) {
  Study study;
  for (const Values& values : points) {
    SweepPoint point;
    for (const auto& [pointer, text] : values)
      point.values.emplace_back(pointer, Json::parse(text));
    StudyPoint& study_point = study.points.emplace_back();
    study_point.sweep_values = values;
    study_point.label = point_label(point);
  }
  return study;
}

using Labels = std::vector<std::string>;

}  // namespace

TEST_CASE("Points are called by their swept values, in few letters") {
  const std::string dilate = "/protocol/0/tap/dilate";
  CHECK(shown_labels(swept({{{dilate, "0.02"}}, {{dilate, "0.3"}}})) ==
        Labels{"ε = 0.02", "ε = 0.3"});
  CHECK(shown_labels(swept({{{"/engine", "\"monte_carlo\""}},
                            {{"/engine", R"({"discrete_element": {"mu": 0.5}})"}}})) ==
        Labels{"Monte Carlo", "grains"});
  CHECK(shown_labels(swept({{{"/protocol/0/tap", R"({"dilate": 0.02})"}},
                            {{"/protocol/0/tap", R"({"lift": 0.25})"}}})) ==
        Labels{"ε = 0.02", "γ = 0.25"});
  CHECK(shown_labels(swept({{{"/container/width", "8"}, {dilate, "0.1"}},
                            {{"/container/width", "8"}, {dilate, "0.2"}},
                            {{"/container/width", "16"}, {dilate, "0.1"}},
                            {{"/container/width", "16"}, {dilate, "0.2"}}})) ==
        Labels{"width = 8, ε = 0.1", "width = 8, ε = 0.2", "width = 16, ε = 0.1",
               "width = 16, ε = 0.2"});
}

TEST_CASE("A value that varies with another has no part of a label") {
  CHECK(shown_labels(swept({{{"/protocol/0/tap/dilate", "0.1"}, {"/protocol/0/count", "100"}},
                            {{"/protocol/0/tap/dilate", "0.2"}, {"/protocol/0/count", "300"}}})) ==
        Labels{"ε = 0.1", "ε = 0.2"});
}

TEST_CASE("Labels of the scene, and those that would be alike in short, stay") {
  Study named = swept({{{"/protocol/0/tap/dilate", "0.02"}}, {{"/protocol/0/tap/dilate", "0.3"}}});
  named.points[0].label = "weak";
  named.points[1].label = "strong";
  CHECK(shown_labels(named) == Labels{"weak", "strong"});
  const Study alike = swept({{{"/engine", R"({"discrete_element": {"mu": 0.5}})"}},
                             {{"/engine", R"({"discrete_element": {"mu": 0.1}})"}}});
  CHECK(shown_labels(alike) == Labels{alike.points[0].label, alike.points[1].label});
  CHECK(shown_labels(swept({{}})) == Labels{""});
}

}  // namespace jostle
