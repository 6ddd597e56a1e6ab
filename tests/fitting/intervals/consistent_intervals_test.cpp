#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "fitting/fit.hpp"
#include "fitting/models/models.hpp"
#include "fitting/report.hpp"
#include "tests/fitting/line_law.hpp"
#include "tests/fitting/noise.hpp"

// Relations that hold for the intervals of every curve, however little it determines.
namespace jostle {
namespace {

const std::vector<std::string> laws = {"inverse_log", "kww", "two_exponentials"};

// Heights read from a figure to four digits, at powers of 2.
Curve read_curve(double sigma) {
  return {.t = {1, 2, 4, 8, 16, 32, 64, 128},
          .x = {0.5801, 0.5823, 0.585, 0.5898, 0.5941, 0.599, 0.6033, 0.6069},
          .sigma = std::vector<double>(8, sigma)};
}

void require_consistent(const Estimate& estimate) {
  const auto& [narrow, wide] = estimate.intervals;
  CAPTURE(estimate.parameter.name);
  CAPTURE(estimate.value);
  CAPTURE(narrow.lower);
  CAPTURE(narrow.upper);
  CAPTURE(wide.lower);
  CAPTURE(wide.upper);
  CHECK(narrow.lower <= estimate.value);
  CHECK(estimate.value <= narrow.upper);
  CHECK(wide.lower <= narrow.lower);
  CHECK(narrow.upper <= wide.upper);
  CHECK(estimate.half_width() >= 0);
  CHECK(estimate.error >= 0);
}

void require_consistent(const Curve& curve) {
  for (const std::string& name : laws) {
    CAPTURE(name);
    const auto outcome = fit(*make_model(name), curve, {});
    REQUIRE(std::holds_alternative<Fit>(outcome));
    const Fit& found = std::get<Fit>(outcome);
    for (const Estimate& estimate : found.estimates) require_consistent(estimate);
    for (const Estimate& estimate : found.combinations) require_consistent(estimate);
    if (!found.restated) continue;
    for (const Estimate& estimate : found.restated->estimates) require_consistent(estimate);
  }
}

/// Random relaxations from the first to the last seed.
void check_relaxations(std::uint64_t first, std::uint64_t last) {
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    CAPTURE(seed);
    Noise noise(100 + seed);
    Curve curve;
    const double tau = std::pow(10, 3 * noise.uniform()), beta = 0.3 + 0.7 * noise.uniform();
    const double change = seed % 5 == 0 ? 0 : 0.08;  // without one no law is determined
    const double error = std::pow(10, -1 - 8 * noise.uniform());
    for (double t = 1; t < 1000; t *= 1.3) {
      curve.t.push_back(t);
      curve.x.push_back(0.64 - change * std::exp(-std::pow(t / tau, beta)) + error * noise());
      if (seed % 3 == 0) curve.sigma.push_back(error);
      if (seed % 3 == 1) curve.sigma.push_back(1e-3 * error);
    }
    require_consistent(curve);
  }
}

TEST_CASE("intervals of random relaxations hold the estimates and one another", "[statistics]") {
  check_relaxations(1, 7);
}

TEST_CASE("intervals of more random relaxations hold the estimates and one another", "[slow]") {
  check_relaxations(8, 20);
}

TEST_CASE("intervals shrink with the errors given, until rounding", "[statistics]") {
  // A cost of 1e17 has no digits left of a rise by 1.
  const Curve plain = read_curve(1e-6);
  for (const std::string& name : laws) {
    CAPTURE(name);
    const Fit reference = std::get<Fit>(fit(*make_model(name), plain, {}));
    for (const double sigma : {1e-9, 1e-10, 1e-11, 1e-12}) {
      CAPTURE(sigma);
      const Fit found = std::get<Fit>(fit(*make_model(name), read_curve(sigma), {}));
      for (std::size_t j = 0; j < found.estimates.size(); ++j) {
        const double shrunk = found.estimates[j].half_width() / (sigma / 1e-6);
        CHECK(shrunk == Approx(reference.estimates[j].half_width()).epsilon(0.02));
        // The ends of so short an interval are rounded.
        CHECK(found.estimates[j].intervals[1].lower <= found.estimates[j].value);
        CHECK(found.estimates[j].value <= found.estimates[j].intervals[1].upper);
      }
    }
  }
}

// a + b t with b of one sign: a curve of the other sign has its least squares at b = 0.
class BoundedLine final : public Model {
 public:
  BoundedLine(double lower, double upper) : list_(line_.parameters()) {
    list_[1].linear = false;
    list_[1].lower = lower;
    list_[1].upper = upper;
  }
  std::string name() const override { return "bounded_line"; }
  const std::vector<Parameter>& parameters() const override { return list_; }
  double value(double t, const double* p) const override { return line_.value(t, p); }

 private:
  Line line_;
  std::vector<Parameter> list_;
};

TEST_CASE("an estimate on its bound has the limit of its profile") {
  Noise noise(7);
  Curve curve;
  double mean_t = 0, mean_x = 0;
  for (int i = 1; i <= 60; ++i) {
    curve.t.push_back(i);
    curve.x.push_back(0.6 - 2e-5 * i + 1e-3 * noise());
    mean_t += curve.t.back() / 60;
    mean_x += curve.x.back() / 60;
  }
  // With b held, the least squares are S(b) = S(0) - 2 b S_xt + b^2 S_tt.
  double squares = 0, products = 0, total = 0;
  for (std::size_t i = 0; i < 60; ++i) {
    squares += std::pow(curve.t[i] - mean_t, 2);
    products += (curve.t[i] - mean_t) * (curve.x[i] - mean_x);
    total += std::pow(curve.x[i] - mean_x, 2);
  }
  REQUIRE(products < 0);
  const double rise = std::pow(2.0017174841, 2) * total / 58;  // Student's t of 58, 95 %
  const double expected = (products + std::sqrt(products * products + squares * rise)) / squares;
  FitOptions options;
  options.memory = false;
  options.start = ParameterValues{0.6, 1e-3};
  for (const double upper : {std::numeric_limits<double>::infinity(), 1.0}) {
    const auto outcome = fit(BoundedLine(0, upper), curve, options);
    const Estimate& b = std::get<Fit>(outcome).estimates[1];
    CHECK(b.identifiability == Identifiability::bounded_above);
    CHECK(b.intervals[1].upper == Approx(expected).epsilon(1e-4));
    CHECK(b.intervals[0].upper < b.intervals[1].upper);
    CHECK(std::isinf(b.intervals[1].lower));
  }
}

TEST_CASE("a report denies errors only where there are none") {
  Fit found;
  found.memory = {.time = 4, .share = 1};
  found.error_dof = 15;
  found.estimates.resize(1);
  found.estimates[0].error = std::numeric_limits<double>::infinity();  // an open interval
  CHECK(describe(found).find("no errors") == std::string::npos);
  found.error_dof = 5;
  CHECK(describe(found).find("no errors") != std::string::npos);
}

}  // namespace
}  // namespace jostle
