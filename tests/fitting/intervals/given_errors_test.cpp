#include <catch2/catch.hpp>
#include <cmath>

#include "fitting/fit.hpp"
#include "fitting/models/models.hpp"
#include "fitting/report.hpp"
#include "tests/fitting/line_law.hpp"
#include "tests/fitting/noise.hpp"

// Errors of curves with a sigma column: known where it is right, whatever the units.
namespace jostle {
namespace {

constexpr double slope = 0.5;

// A line of n points with this noise; the seed is its number.
Curve line(int n, double noise_size, int number) {
  Noise noise(static_cast<std::uint64_t>(number));
  Curve curve{.t = {}, .x = {}, .sigma = {}};
  for (int t = 1; t <= n; ++t) {
    curve.t.push_back(t);
    curve.x.push_back(1 + slope * t + noise_size * noise());
  }
  return curve;
}

Curve relaxation(double noise_size, int number) {
  Noise noise(static_cast<std::uint64_t>(number));
  const ParameterValues truth = {0.6, 0.55, 30, 0.8};
  Curve curve{.t = geometric(1, 1000, 24), .x = {}, .sigma = std::vector<double>(24, 1e-4)};
  for (const double t : curve.t) {
    curve.x.push_back(StretchedExponential().value(t, truth.data()) + noise_size * noise());
  }
  return curve;
}

Curve in_units(Curve curve, double of_t, double of_x) {
  for (double& t : curve.t) t *= of_t;
  for (double& x : curve.x) x *= of_x;
  for (double& sigma : curve.sigma) sigma *= of_x;
  return curve;
}

// Units of each parameter's value.
void check_units(const Model& model, const Curve& curve, double of_t, double of_x,
                 const std::vector<double>& units) {
  const Fit plain_fit = std::get<Fit>(fit(model, curve));
  const Fit scaled_fit = std::get<Fit>(fit(model, in_units(curve, of_t, of_x)));
  INFO(model.name() << ": t times " << of_t << ", X times " << of_x);
  CHECK(plain_fit.error_dof == scaled_fit.error_dof);
  CHECK(verdict({plain_fit}, {}) == verdict({scaled_fit}, {}));
  for (std::size_t j = 0; j < units.size(); ++j) {
    INFO(plain_fit.estimates[j].parameter.name);
    CHECK(plain_fit.estimates[j].identifiability == scaled_fit.estimates[j].identifiability);
    for (int level = 0; level < 2; ++level) {
      const Interval &first = plain_fit.estimates[j].intervals[level],
                     &second = scaled_fit.estimates[j].intervals[level];
      // A profile finds its ends within 1e-6 of its threshold.
      const double margin = 3e-6 * (first.upper - first.lower) * units[j];
      CHECK(std::abs(second.lower - first.lower * units[j]) <= margin);
      CHECK(std::abs(second.upper - first.upper * units[j]) <= margin);
    }
  }
}

struct Coverage {
  int curves = 0, covered[2] = {0, 0};

  void add(const Interval intervals[2], double truth) {
    ++curves;
    for (int level = 0; level < 2; ++level) {
      covered[level] += intervals[level].lower <= truth && truth <= intervals[level].upper;
    }
  }
  // Within 4 binomial standard errors.
  void check() const {
    for (int level = 0; level < 2; ++level) {
      const double rate = interval_levels[level];
      CHECK(std::abs(1.0 * covered[level] / curves - rate) <=
            4 * std::sqrt(rate * (1 - rate) / curves));
    }
  }
};

}  // namespace

TEST_CASE("Given errors: intervals and verdicts do not depend on the units") {
  // Noise of 0.5 to 2 errors: chi2 on both sides of 1, and far above it.
  for (const double noise : {0.05, 0.1, 0.14, 0.2}) {
    for (int number = 1; number <= 5; ++number) {
      Curve few = line(4, noise, number);
      few.sigma.assign(few.t.size(), 0.1);
      for (const double of_x : {3.0, 100.0, 1e-3}) {
        for (const double of_t : {1.0, 7.0, 1e-3}) {
          check_units(Line(), few, of_t, of_x, {of_x, of_x / of_t});
        }
      }
    }
  }
  for (const double noise : {0.5e-4, 1e-4, 2e-4}) {
    const Curve curve = relaxation(noise, 3);
    for (const double of_x : {3.0, 100.0, 1e-3}) {
      check_units(StretchedExponential(), curve, 1, of_x, {of_x, of_x, 1, 1});
      check_units(StretchedExponential(), curve, 7, of_x, {of_x, of_x, 7, 1});
    }
  }
}

TEST_CASE("Given errors that are right make normal intervals that hold their level") {
  for (const int n : {4, 6, 20}) {
    INFO(n << " points");
    Coverage all, scattered;
    int doubted = 0, remembering = 0;
    for (int number = 1; number <= 400; ++number) {
      Curve curve = line(n, 0.1, number);
      curve.sigma.assign(curve.t.size(), 0.1);
      const Fit found = std::get<Fit>(fit(Line(), curve));
      doubted += found.scatter_ratio > 1;
      remembering += found.memory.time > 0;
      if (found.memory.time > 0) continue;
      CHECK(std::isinf(found.error_dof));
      all.add(found.estimates[1].intervals, slope);
      // The slope is independent of chi2, so it decides nothing.
      if (found.reduced_chi2 > 1) scattered.add(found.estimates[1].intervals, slope);
    }
    CHECK(doubted <= 4);
    CHECK(remembering <= 20);
    all.check();
    scattered.check();
  }
}

TEST_CASE("Errors from the scatter about the law have Student's t, and hold their level") {
  for (const int n : {4, 6, 20}) {
    INFO(n << " points");
    Coverage all;
    for (int number = 1; number <= 400; ++number) {
      const Fit found = std::get<Fit>(fit(Line(), line(n, 0.1, number), {.memory = false}));
      CHECK(found.error_dof == n - 2);
      all.add(found.estimates[1].intervals, slope);
    }
    all.check();
  }
}

TEST_CASE("Errors given too small: verdict and remark report how much longer they are") {
  for (const double share : {0.5, 0.25}) {
    Curve curve = line(60, 0.1, 7);
    curve.sigma.assign(curve.t.size(), 0.1 * share);
    const Fit found = std::get<Fit>(fit(Line(), curve, {.memory = false}));
    CHECK(found.scatter_ratio == Approx(1 / share).epsilon(0.25));
    CHECK(found.scatter_ratio == Approx(std::sqrt(found.reduced_chi2)));
    const std::string longer = "by the scatter around the law they are ";
    CHECK(verdict({found}, {}).find("from the errors given, taken as exact; " + longer) !=
          std::string::npos);
    CHECK(describe(found).find("from the errors given, taken as exact; " + longer) !=
          std::string::npos);
    REQUIRE(!found.remarks.empty());
    CHECK(found.remarks.front().find(longer) != std::string::npos);
  }
  // Points that are taken as independent count as many as they are, also if their residuals look
  // correlated.
  Curve walk = line(49, 0.1, 7);
  for (std::size_t i = 1; i < walk.x.size(); ++i)
    walk.x[i] += 0.7 * (walk.x[i - 1] - 1 - slope * walk.t[i - 1]);
  const double scatter =
      std::sqrt(std::get<Fit>(fit(Line(), walk, {.memory = false})).reduced_chi2);
  walk.sigma.assign(walk.t.size(), scatter / 1.5);
  const Fit doubted = std::get<Fit>(fit(Line(), walk, {.memory = false}));
  CHECK(doubted.effective_size == 49);
  CHECK(doubted.error_factor == 1);
  CHECK(doubted.scatter_ratio == Approx(1.5));
  // Errors that are right, too large, or not given raise no doubt.
  Curve curve = line(60, 0.1, 7);
  CHECK(std::get<Fit>(fit(Line(), curve)).scatter_ratio == 1);
  for (const double sigma : {0.1, 1.0}) {
    curve.sigma.assign(curve.t.size(), sigma);
    const Fit found = std::get<Fit>(fit(Line(), curve));
    CHECK(found.scatter_ratio == 1);
    CHECK(verdict({found}, {}).find("taken as exact") == std::string::npos);
  }
}

}  // namespace jostle
