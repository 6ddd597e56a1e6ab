#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

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

TEST_CASE("Known errors of as many points as parameters give the errors of a fit") {
  Curve curve{.t = {3, 10, 30, 100}, .x = {}, .sigma = std::vector<double>(4, 2e-3)};
  for (const double t : curve.t)
    curve.x.push_back(StretchedExponential().value(t, ParameterValues{0.64, 0.56, 30, 0.6}.data()));
  const auto remarked = [](const Fit& fit, const char* text) {
    return std::ranges::any_of(fit.remarks, [&](const std::string& remark) {
      return remark.find(text) != std::string::npos;
    });
  };
  const Fit known = std::get<Fit>(fit(StretchedExponential(), curve));
  CHECK(known.dof == 0);
  CHECK(std::isfinite(known.estimates[0].intervals[0].lower));  // rho_inf
  CHECK(remarked(known, "as many parameters as there are points: nothing tests it"));
  CHECK_FALSE(remarked(known, "errors cannot be estimated"));
  curve.sigma.clear();
  CHECK(remarked(std::get<Fit>(fit(StretchedExponential(), curve)), "errors cannot be estimated"));
}

TEST_CASE("Intervals of realizations that differ by their level alone contain the estimates") {
  Curve curve{.t = geometric(1, 1000, 7), .x = {}, .sigma = {}, .n_realizations = 2};
  for (const double t : curve.t) {
    const double x = StretchedExponential().value(t, ParameterValues{0.64, 0.56, 40, 0.6}.data());
    curve.values.insert(curve.values.end(), {x, x + 0.01});
    curve.x.push_back(x + 0.005);
  }
  const Fit found = std::get<Fit>(fit(StretchedExponential(), curve));
  for (const Estimate& estimate : found.estimates) {
    for (const Interval& interval : estimate.intervals) {
      CAPTURE(estimate.parameter.name, estimate.value);
      CHECK(interval.lower <= estimate.value);
      CHECK(interval.upper >= estimate.value);
    }
  }
}

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

namespace {

// A power law with noise that is a share of X, AR(1) from point to point.
struct NoisyPowerLaw {
  int n;
  double noise, rho = 0;  // noise relative to X

  // follows: power of the measured X that the errors given are computed with; 0: of the true X.
  Curve curve(double follows, int number) const {
    Noise next(static_cast<std::uint64_t>(number));
    Curve made{.t = {}, .x = {}, .sigma = {}};
    double state = next();
    for (int i = 1; i <= n; ++i) {
      const double t = rho > 0 ? i : 1e-3 * std::pow(500.0, (i - 1.0) / (n - 1));
      const double truth = PowerLaw().value(t, parameters.data());
      made.t.push_back(t);
      made.x.push_back(truth * (1 + noise * state));
      made.sigma.push_back(noise * truth * std::pow(made.x.back() / truth, follows));
      state = rho * state + std::sqrt(1 - rho * rho) * next();
    }
    return made;
  }

  ParameterValues parameters = {1e-7, 1.3};
};

struct CurvesOfOneKind {
  Coverage amplitude, slope;
  int curves = 0, without_errors = 0;
};

CurvesOfOneKind coverage_of(const NoisyPowerLaw& law, double follows, int curves) {
  CurvesOfOneKind found{.amplitude = {}, .slope = {}, .curves = curves};
  for (int number = 1; number <= curves; ++number) {
    const auto outcome = fit(PowerLaw(), law.curve(follows, number));
    const Fit& fitted = std::get<Fit>(outcome);
    CHECK(!fitted.logarithmic);
    if (fitted.estimates[0].identifiability == Identifiability::not_examined) {
      ++found.without_errors;
      continue;
    }
    found.amplitude.add(fitted.estimates[0].intervals, law.parameters[0]);
    found.slope.add(fitted.estimates[1].intervals, law.parameters[1]);
  }
  const auto share = [](const Coverage& coverage, int level) {
    return 100.0 * coverage.covered[level] / std::max(coverage.curves, 1);
  };
  std::printf(
      "power_law  n %3d  noise %5.3f  rho %3.1f  errors as X^%3.1f  no errors %3d of %d  A %5.1f "
      "%5.1f  s %5.1f %5.1f\n",
      law.n, law.noise, law.rho, follows, found.without_errors, curves, share(found.amplitude, 0),
      share(found.amplitude, 1), share(found.slope, 0), share(found.slope, 1));
  return found;
}

void check_white_noise(const NoisyPowerLaw& law, int curves) {
  for (const double follows : {0.0, 0.5, 1.0}) {
    INFO(law.n << " points, noise " << law.noise << ", errors as X^" << follows);
    const CurvesOfOneKind found = coverage_of(law, follows, curves);
    CHECK(found.without_errors <= 0.05 * curves);
    found.amplitude.check();
    found.slope.check();
  }
}

}  // namespace

TEST_CASE("Errors of a power law hold their level, whatever X they are computed from") {
  for (const double noise : {0.005, 0.2}) check_white_noise({.n = 30, .noise = noise}, 100);
}

TEST_CASE("Errors of a power law of 300 points hold their level", "[slow]") {
  for (const double noise : {0.005, 0.2}) check_white_noise({.n = 300, .noise = noise}, 100);
}

TEST_CASE("Errors of a power law: white noise and AR(1)", "[nightly]") {
  for (const int n : {30, 60, 100, 300}) {
    for (const double noise : {0.005, 0.02, 0.05, 0.2}) {
      check_white_noise({.n = n, .noise = noise}, 400);
      // Shorter curves, and those of rho 0.9 that have errors at all, have too short intervals.
      for (const double rho : {0.5, 0.9}) {
        for (const double follows : {0.0, 1.0}) {
          const CurvesOfOneKind found =
              coverage_of({.n = n, .noise = noise, .rho = rho}, follows, 400);
          if (rho > 0.5 || n < 100) continue;
          CHECK(found.without_errors <= 0.05 * found.curves);
          found.amplitude.check();
          found.slope.check();
        }
      }
    }
  }
}

TEST_CASE("Roots of counts and shares of X are taken at the law, other errors as given") {
  const ParameterValues truth = {5000, 0.1};
  std::vector<double> v;
  for (int i = 0; i < 60; ++i) v.push_back(0.005 * i);
  for (const double follows : {0.0, 0.5, 1.0}) {
    INFO("errors as X^" << follows);
    int followed = 0;
    Coverage of_v0;
    for (int number = 1; number <= 100; ++number) {
      Noise noise(static_cast<std::uint64_t>(number));
      Curve curve{.t = v, .x = {}, .sigma = {}};
      for (const double t : v) {
        const double x = PoreTail().value(t, truth.data());
        curve.x.push_back(x + std::sqrt(x) * noise());
        curve.sigma.push_back(std::sqrt(x) * std::pow(curve.x.back() / x, follows));
      }
      const auto outcome = fit(PoreTail(), curve);
      const Fit& fitted = std::get<Fit>(outcome);
      for (const std::string& remark : fitted.remarks)
        followed += remark.find("The errors given follow the scatter of X") == 0;
      if (fitted.estimates[1].identifiability == Identifiability::not_examined) continue;
      of_v0.add(fitted.estimates[1].intervals, truth[1]);
    }
    CHECK(followed == (follows > 0 ? 100 : 0));
    CHECK(of_v0.curves >= 95);
    of_v0.check();
  }
  // Errors of points that were measured differently, by chance and not by their X.
  int followed = 0;
  for (int number = 1; number <= 200; ++number) {
    Noise noise(static_cast<std::uint64_t>(number));
    Curve curve{.t = v, .x = {}, .sigma = {}};
    for (const double t : v) {
      curve.sigma.push_back(20 * std::exp(0.5 * noise()));
      curve.x.push_back(PoreTail().value(t, truth.data()) + curve.sigma.back() * noise());
    }
    const auto outcome = fit(PoreTail(), curve, {.profiles = false});
    for (const std::string& remark : std::get<Fit>(outcome).remarks)
      followed += remark.find("The errors given follow the scatter of X") == 0;
  }
  CHECK(followed <= 2);
}

}  // namespace jostle
