#include "ensemble/statistics/jackknife.hpp"
#include "tests/test_files.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

TEST_CASE("The jackknife of estimates left one out agrees with the reference") {
  std::ifstream file(jostle::test_data("jackknife_bootstrap.json"));
  const auto json = nlohmann::json::parse(file);
  const auto x = json["x"].get<std::vector<double>>();
  double sum = 0;
  for (const double value : x) sum += value;
  std::vector<double> means, squares;
  for (const double value : x) {
    means.push_back((sum - value) / static_cast<double>(x.size() - 1));
    squares.push_back(means.back() * means.back());
  }
  // Differences of the reference's means are 1e-4 of them: 12 digits are left of 16.
  CHECK(jostle::jackknife_error(means) ==
        Approx(json["jackknife_se_of_mean"].get<double>()).epsilon(1e-11));
  CHECK(jostle::jackknife_error(squares) ==
        Approx(json["jackknife_of_mean_squared"]["se"].get<double>()).epsilon(1e-11));
}

TEST_CASE("Errors that do not exist are not a number") {
  CHECK(std::isnan(jostle::jackknife_error({})));
  CHECK(std::isnan(jostle::jackknife_error(std::vector{1.0})));
  CHECK(std::isnan(jostle::jackknife_error(std::vector{1.0, std::nan(""), 2.0})));
  CHECK(std::isnan(jostle::student_half_width(1, 1)));
}

TEST_CASE("Student's interval is that of the tables") {
  // 2.262 for 9 degrees of freedom at 95 %, 1.960 for many.
  CHECK(jostle::student_half_width(1, 10, 0.95) == Approx(2.262157).epsilon(1e-6));
  CHECK(jostle::student_half_width(1, 1000001, 0.95) == Approx(1.959966).epsilon(1e-5));
}
