#include "ensemble/analysis/structure_comparison.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string_view>

#include "ensemble/analysis/sweeps/sweep_curve.hpp"
#include "tests/ensemble/noise.hpp"

// Differences between sweep points: which numbers and pairs are compared, by which test, and how
// often a test finds a difference where there is none.
namespace jostle {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

template <class Value>
const std::vector<Value>& column(const Table& table, std::string_view name) {
  for (const Quantity& quantity : table.quantities) {
    if (quantity.name == name) return std::get<std::vector<Value>>(quantity.values);
  }
  FAIL("no " << name);
  return std::get<std::vector<Value>>(table.quantities.front().values);
}

/// A point with one number, whose values at the last tap are given.
ComparedPoint point_of(std::uint32_t number, std::vector<double> values,
                       std::vector<std::uint64_t> taps = {0, 10}) {
  PackingNumber packing_number{"coordination", "n_c", "1", "mean coordination", {}};
  for (std::size_t i = 0; i + 1 < taps.size(); ++i)
    packing_number.values.emplace_back(values.size(), 100.0 * number);
  packing_number.values.push_back(std::move(values));
  return {"point " + std::to_string(number), number, std::move(taps), {packing_number}};
}

}  // namespace

TEST_CASE("Points are compared pair by pair at the last tap that all keep") {
  const std::vector<ComparedPoint> points{point_of(0, {1, 2, 3}), point_of(2, {3, 4, 5, nan}),
                                          point_of(5, {2, 2.5, 4.5})};
  const std::vector<Table> tables = comparison_tables(points, Streams::independent);
  REQUIRE(tables.size() == 1);
  const Table& table = tables[0];
  CHECK(table.name == "comparison/coordination");
  CHECK(table.notes.at(0) == std::pair<std::string, std::string>{"tap", "10"});
  CHECK(column<std::string>(table, "from") ==
        std::vector<std::string>{"point 0", "point 0", "point 2"});
  CHECK(column<std::uint64_t>(table, "to_point") == std::vector<std::uint64_t>{2, 5, 5});
  CHECK(column<double>(table, "difference") == std::vector<double>{2, 1, -1});
  // Welch's test: both have variance 1, so t = 2 / sqrt(2/3) with 4 degrees of freedom.
  CHECK(column<double>(table, "difference_error").at(0) == Approx(std::sqrt(2.0 / 3)));
  CHECK(column<double>(table, "difference_dof").at(0) == Approx(4));
  CHECK(column<double>(table, "p").at(0) == Approx(0.0705).margin(1e-4));
  CHECK(column<double>(table, "p_corrected").at(0) == Approx(3 * column<double>(table, "p").at(0)));
}

TEST_CASE("Realizations of matched streams are pairs") {
  const std::vector<ComparedPoint> points{point_of(0, {1, 5, 9, nan}),
                                          point_of(1, {2.1, 5.9, 10, 7})};
  const Table paired = comparison_tables(points, Streams::matched).at(0);
  CHECK(column<double>(paired, "difference").at(0) == Approx(1));
  CHECK(column<double>(paired, "difference_error").at(0) == Approx(0.1 / std::sqrt(3.0)));
  CHECK(column<double>(paired, "difference_dof").at(0) == 2);
  CHECK(column<double>(paired, "p").at(0) < 0.01);
  const Table separated = comparison_tables(points, Streams::independent).at(0);
  CHECK(column<double>(separated, "p").at(0) > 0.5);
}

TEST_CASE("Differences without scatter, and single realizations, have no p-value") {
  for (const auto& [a, b] : {std::pair{std::vector<double>{2, 2, 2}, std::vector<double>{3, 3, 3}},
                             std::pair{std::vector<double>{2}, std::vector<double>{3}}}) {
    const std::vector<ComparedPoint> points{point_of(0, a), point_of(1, b)};
    const Table table = comparison_tables(points, Streams::independent).at(0);
    CHECK(column<double>(table, "difference").at(0) == 1);
    CHECK(std::isnan(column<double>(table, "difference_error").at(0)));
    CHECK(std::isnan(column<double>(table, "p").at(0)));
    CHECK(std::isnan(column<double>(table, "p_corrected").at(0)));
  }
}

TEST_CASE("Many points are compared with the first, and points without a common tap not at all") {
  std::vector<ComparedPoint> points;
  for (std::uint32_t i = 0; i <= most_compared_pairwise; ++i)
    points.push_back(point_of(i, {1.0 + i, 2.0 + i, 4.0}));
  const Table table = comparison_tables(points, Streams::independent).at(0);
  CHECK(column<std::uint64_t>(table, "from_point") ==
        std::vector<std::uint64_t>(most_compared_pairwise, 0));
  CHECK(comparison_tables(std::span(points).first(1), Streams::independent).empty());
  const std::vector<ComparedPoint> separated{point_of(0, {1, 2}, {0, 10}),
                                             point_of(1, {1, 2}, {5, 20})};
  CHECK(comparison_tables(separated, Streams::independent).empty());
  const std::vector<ComparedPoint> shared{point_of(0, {1, 2}, {0, 10, 30}),
                                          point_of(3, {1, 2}, {0, 10, 20})};
  CHECK(comparison_tables(shared, Streams::independent).at(0).notes.at(0).second == "10");
  CHECK(column<double>(comparison_tables(shared, Streams::independent).at(0), "to_mean").at(0) ==
        300);
}

TEST_CASE("Numbers of packings are single values with an error") {
  Measurement measurement{.part = "order"};
  measurement.places = {{"height", std::vector<double>{1, 2}, "diameter", "height"}};
  measurement.quantities = {{.name = "q6", .values = {0.4}, .long_name = "mean q6"},
                            {.name = "q6_at_height", .places = "height", .values = {0.1, 0.2}},
                            {.name = "line_error", .values = {0.1}, .with_error = false},
                            {.name = "n_pores", .values = {9}, .is_compared = false},
                            {.name = "pairs", .values = {7}, .pooling = Pooling::sum}};
  const EnsembleStructure structure{.taps = {0, 3},
                                    .packings = {{{measurement}, {}}, {{}, {measurement}}}};
  const ComparedPoint numbers = packing_numbers("weak", 4, structure);
  REQUIRE(numbers.numbers.size() == 1);
  CHECK(numbers.numbers[0].name == "q6");
  CHECK(numbers.numbers[0].values[0][0] == 0.4);
  CHECK(std::isnan(numbers.numbers[0].values[0][1]));
  CHECK(numbers.numbers[0].values[1][1] == 0.4);
  CHECK(numbers.label == "weak");
}

namespace {

/// How often p-values below 5 % arise where all points are alike: of one pair, and of any pair of
/// three points after the correction.
struct Alarms {
  double single = 0, any = 0;
};

Alarms alarms_of(std::size_t n_realizations, Streams streams, double spread, std::size_t n) {
  RandomStream random = test_stream(20261126 + n_realizations);
  Alarms alarms;
  for (std::size_t trial = 0; trial < n; ++trial) {
    std::vector<double> level(n_realizations, 0.0);
    if (streams == Streams::matched) {
      for (double& value : level) value = 3 * noise(random);
    }
    std::vector<ComparedPoint> points;
    for (std::uint32_t i = 0; i < 3; ++i) {
      std::vector<double> values = level;
      for (double& value : values) value += noise(random) * (i == 0 ? spread : 1);
      points.push_back(point_of(i, std::move(values)));
    }
    const Table table = comparison_tables(points, streams).at(0);
    if (column<double>(table, "p").at(0) < significance_level) alarms.single += 1.0 / double(n);
    const auto& corrected = column<double>(table, "p_corrected");
    if (std::ranges::any_of(corrected, [](double p) { return p < significance_level; })) {
      alarms.any += 1.0 / double(n);
    }
  }
  return alarms;
}

/// The rate of false alarms is at most the level: 5 % and 3 standard errors of the count. Student's
/// test of pairs has it exactly; Welch's may stay below, not under half of it.
void check_size(std::size_t n_trials) {
  const double margin = 3 * std::sqrt(0.05 * 0.95 / double(n_trials));
  for (const std::size_t m : {3, 6, 20}) {
    for (const double spread : {1.0, 3.0}) {
      CAPTURE(m, spread);
      const Alarms paired = alarms_of(m, Streams::matched, spread, n_trials);
      CHECK(paired.single == Approx(0.05).margin(margin));
      CHECK(paired.any < 0.05 + margin);
      const Alarms separated = alarms_of(m, Streams::independent, spread, n_trials);
      CHECK(separated.single < 0.055 + margin);
      CHECK(separated.single > 0.025);
      CHECK(separated.any < 0.055 + margin);
    }
  }
}

}  // namespace

TEST_CASE("Points that are alike differ at the 5 % level in one ensemble of twenty",
          "[statistics]") {
  check_size(2000);
}

TEST_CASE("The size of comparisons between points, with many ensembles", "[nightly]") {
  check_size(40000);
}

}  // namespace jostle
