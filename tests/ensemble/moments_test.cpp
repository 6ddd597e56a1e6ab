#include "ensemble/moments.hpp"
#include "tests/test_files.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

using jostle::Moments;

namespace {

// NIST StRD, univariate: `middle` once, then (middle - 0.1, middle + 0.1) 500 times.
std::vector<double> num_acc(double low, double middle, double high) {
  std::vector<double> values{middle};
  for (int i = 0; i < 500; ++i) {
    values.push_back(low);
    values.push_back(high);
  }
  return values;
}

Moments folded(const std::vector<double>& values) {
  Moments moments;
  for (const double value : values) moments.add(value);
  return moments;
}

// NIST certifies the sample deviation, 1/(M - 1).
double sample_deviation(const Moments& moments) {
  return moments.standard_error() * std::sqrt(static_cast<double>(moments.count()));
}

double certified_mean(const std::string& name) {
  std::ifstream file(jostle::test_data("nist_univariate_cancellation.json"));
  const auto reference = nlohmann::json::parse(file);
  for (const auto& set : reference.at("sets")) {
    if (set.at("name") == name) return set.at("mean");
  }
  FAIL("no set " << name);
  return 0;
}

}  // namespace

TEST_CASE("Moments keep the digits of NIST's cancellation sets") {
  struct Set {
    std::string name;
    std::vector<double> values;
    double deviation;  // deviation of the stored doubles, in exact rational arithmetic
  };
  const std::vector<Set> sets = {
      {"NumAcc1", {10000001, 10000003, 10000002}, 1},
      {"NumAcc2", num_acc(1.1, 1.2, 1.3), 0.1},
      {"NumAcc3", num_acc(1000000.1, 1000000.2, 1000000.3), 0.1000000000349246},
      {"NumAcc4", num_acc(10000000.1, 10000000.2, 10000000.3), 0.10000000055879354}};
  for (const Set& set : sets) {
    CAPTURE(set.name);
    const Moments moments = folded(set.values);
    CHECK(moments.mean() == Approx(certified_mean(set.name)).epsilon(1e-14).margin(0));
    CHECK(sample_deviation(moments) == Approx(set.deviation).epsilon(1e-12).margin(0));
  }
}

TEST_CASE("Sigma is the population deviation and the error that of the mean") {
  const Moments moments = folded({1, 2, 4});
  CHECK(moments.count() == 3);
  CHECK(moments.mean() == Approx(7.0 / 3).epsilon(1e-15));
  CHECK(moments.sigma() == Approx(std::sqrt(14.0 / 9)).epsilon(1e-15));
  CHECK(moments.standard_error() == Approx(std::sqrt(7.0 / 9)).epsilon(1e-15));
}

TEST_CASE("Moments skip the NaN of failed realizations and mark missing values") {
  Moments moments;
  CHECK(std::isnan(moments.mean()));
  CHECK(std::isnan(moments.sigma()));
  moments.add(std::numeric_limits<double>::quiet_NaN());
  CHECK(moments.count() == 0);
  moments.add(0.6);
  CHECK(moments.mean() == 0.6);
  CHECK(moments.sigma() == 0);
  CHECK(std::isnan(moments.standard_error()));
}
