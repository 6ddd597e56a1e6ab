#include "study/tables/points/half_widths.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "ensemble/moments.hpp"
#include "tests/ensemble/synthetic_series.hpp"

using namespace jostle;

namespace {

/// The ends of what a person reads in "0.5591(14)" or "12.3(4.5)".
std::pair<double, double> ends_of(const std::string& text) {
  const auto open = text.find('('), point = text.find('.');
  const double value = std::stod(text.substr(0, open));
  const std::string digits = text.substr(open + 1, text.find(')') - open - 1);
  const bool in_last_digits = digits.find('.') == std::string::npos && point != std::string::npos;
  const double unit = in_last_digits ? std::pow(10.0, -static_cast<double>(open - point - 1)) : 1.0;
  const double half = std::stod(digits) * unit;
  return {value - half, value + half};
}

EnsembleSeries series_of(const Moments& moments) {
  return {.label = {},
          .mean = {moments.mean()},
          .sigma = {moments.sigma()},
          .error = {moments.standard_error()},
          .count = {static_cast<std::uint32_t>(moments.count())}};
}

}  // namespace

TEST_CASE("Means over realizations are printed with intervals that hold the truth in 68 %") {
  constexpr std::size_t ensembles = 3000;
  for (const std::size_t realizations : {3, 6, 20}) {
    std::size_t held = 0;
    for (std::size_t e = 0; e < ensembles; ++e) {
      synthetic::Gaussian gaussian(20261126 + e, realizations);
      Moments moments;
      for (std::size_t r = 0; r < realizations; ++r) moments.add(0.6 + 0.01 * gaussian());
      const std::string text = mean_text(series_of(moments), 0);
      CAPTURE(text);
      REQUIRE(text.find('(') != std::string::npos);
      const auto [low, high] = ends_of(text);
      held += low <= 0.6 && 0.6 <= high;
    }
    // Standard errors would hold it in 58 % with three realizations.
    CAPTURE(realizations, held);
    const double share = static_cast<double>(held) / ensembles;
    CHECK(share >= 0.64);
    CHECK(share <= 0.72);
  }
}

TEST_CASE("Errors of a table become half widths where their degrees of freedom are known") {
  Table table{.name = "t"};
  table.axes = {{"tap", {"tap"}, std::vector<double>{0, 1}, "taps"}};
  const std::vector<std::string> axes = {"tap"};
  table.quantities = {
      {"x", axes, std::vector{1.0, 2.0}},
      {"x_error", axes, std::vector{0.1, 0.1}},
      {"x_dof", axes, std::vector{2.0, std::numeric_limits<double>::infinity()}},
      {"x_pooled_error", axes, std::vector{0.2, 0.2}, "1", "standard error by the pooled variance"},
      {"x_pooled_dof", axes, std::vector{2.0, 2.0}},
      {"y", axes, std::vector{1.0, 2.0}},
      {"y_error", axes, std::vector{0.1, 0.2}}};
  const Table shown = with_half_widths(table);
  REQUIRE(shown.quantities.size() == 5);
  CHECK(shown.quantities[1].name == "x_half_width");
  const auto& widths = std::get<std::vector<double>>(shown.quantities[1].values);
  CHECK(widths[0] == Approx(0.13212773729262588).epsilon(1e-9));
  CHECK(widths[1] == Approx(0.1).epsilon(1e-12));
  // Another error of x is one convention with it.
  CHECK(shown.quantities[2].name == "x_pooled_half_width");
  CHECK(std::get<std::vector<double>>(shown.quantities[2].values)[0] ==
        Approx(2 * widths[0]).epsilon(1e-9));
  CHECK(shown.quantities[2].long_name == "half the 68 % interval by the pooled variance");
  CHECK(shown.quantities[4].name == "y_error");  // a standard error is a column of its own
  REQUIRE(shown.notes.size() == 1);
  CHECK(shown.notes[0].second.find("half the 68 % interval") != std::string::npos);
  CHECK(shown.notes[0].second.find("y_error: standard errors") != std::string::npos);
}
