#include "fitting/comparison/held_out.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <string_view>

#include "fitting/models/models.hpp"
#include "fitting/report.hpp"
#include "tests/fitting/noise.hpp"

// How often the comparison of laws names the wrong one, and how often the right one, on synthetic
// ensembles of a known law.
namespace jostle {
namespace {

struct Truth {
  const char* name;   // printed
  const char* model;  // the law that makes the curve
  ParameterValues values;
  std::vector<std::string> right;  // laws that contain the curve
};

const std::vector<Truth>& truths() {
  static const std::vector<Truth> all = {
      {"inverse_log", "inverse_log", {0.64, 0.06, 0.5, 8}, {"inverse_log"}},
      {"kww", "kww", {0.63, 0.58, 60, 0.5}, {"kww"}},
      {"two_exponentials", "two_exponentials", {0.63, -0.03, 4, -0.03, 40}, {"two_exponentials"}},
      // Close to one exponential, which two laws contain.
      {"kww, beta 0.9", "kww", {0.63, 0.58, 30, 0.9}, {"kww"}},
      {"times 20 and 40", "two_exponentials", {0.63, -0.03, 20, -0.03, 40}, {"two_exponentials"}},
      {"one exponential", "kww", {0.63, 0.58, 30, 1}, {"kww", "two_exponentials"}}};
  return all;
}

struct Noises {
  double deviation;  // deviation of a realization at a tap
  double rho = 0;    // from tap to tap
  double level = 0;  // deviation of a realization's own level
};

std::vector<double> taps(int n) {
  std::vector<double> t;
  for (int tap = 1; tap <= n; ++tap) t.push_back(tap);
  return t;
}

Curve ensemble(const Truth& truth, const std::vector<double>& t, int n_realizations,
               const Noises& noises, int number) {
  Noise noise(static_cast<std::uint64_t>(number));
  const auto model = make_model(truth.model);
  std::vector<double> level, state, values;
  for (int m = 0; m < n_realizations; ++m) {
    level.push_back(noises.level * noise());
    state.push_back(noise());
  }
  for (const double tap : t) {
    const double law = model->value(tap, truth.values.data());
    for (std::size_t m = 0; m < level.size(); ++m) {
      values.push_back(law + level[m] + noises.deviation * state[m]);
      state[m] = noises.rho * state[m] + std::sqrt(1 - noises.rho * noises.rho) * noise();
    }
  }
  return mean_curve(t, std::move(values), static_cast<std::size_t>(n_realizations));
}

LawComparison comparison_of(const Curve& curve, const std::vector<std::string>& names) {
  std::vector<std::unique_ptr<Model>> models;
  std::vector<Fit> fits;
  FitOptions options;
  options.profiles = false;
  for (const std::string& name : names) {
    models.push_back(make_model(name));
    fits.push_back(std::get<Fit>(fit(*models.back(), curve, options)));
  }
  std::vector<FittedLaw> laws;
  for (std::size_t i = 0; i < fits.size(); ++i) laws.push_back({models[i].get(), &fits[i]});
  return compare_laws(laws, curve);
}

const std::vector<std::string> three_laws = {"inverse_log", "two_exponentials", "kww"};

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Root mean square distance of the curve from the nearest law that does not contain it.
double distance(const Truth& truth, const std::vector<double>& t,
                const std::vector<std::string>& names) {
  Curve curve{.t = t, .x = {}};
  const auto model = make_model(truth.model);
  for (const double tap : t) curve.x.push_back(model->value(tap, truth.values.data()));
  FitOptions options;
  options.profiles = false;
  double least = std::numeric_limits<double>::infinity();
  for (const std::string& name : names) {
    if (contains(truth.right, name)) continue;
    const Fit law = std::get<Fit>(fit(*make_model(name), curve, options));
    least = std::min(least, std::sqrt(law.residual_sum / static_cast<double>(t.size())));
  }
  return least;
}

struct Rates {
  int ensembles = 0;
  int wrong = 0;  // a law that is true is called worse
  int right = 0;  // all laws but true ones are called worse
  double share_wrong() const { return static_cast<double>(wrong) / ensembles; }
  double share_right() const { return static_cast<double>(right) / ensembles; }
};

struct Case {
  std::vector<double> t;
  int n_realizations;
  double signal;  // distance over the deviation of a realization at a tap
  double rho = 0;
  double level = 3;  // in deviations
};

Rates rates(const Truth& truth, const Case& study, int ensembles,
            const std::vector<std::string>& names = three_laws) {
  const double deviation = distance(truth, study.t, names) / study.signal;
  const Noises noises{deviation, study.rho, study.level * deviation};
  Rates found{.ensembles = ensembles};
  for (int number = 1; number <= ensembles; ++number) {
    const LawComparison comparison =
        comparison_of(ensemble(truth, study.t, study.n_realizations, noises, number), names);
    bool wrong = false, right = comparison.laws.size() == names.size();
    for (const HeldOutLaw& law : comparison.laws) {
      const bool is_true = contains(truth.right, law.model);
      wrong = wrong || (is_true && law.worse);
      right = right && (is_true != law.worse);
    }
    found.wrong += wrong;
    found.right += right;
  }
  std::printf(
      "%-17s %4zu points to %5.0f  M %2d  rho %4.2f  signal %5.2f  wrong %5.1f %%  right %5.1f "
      "%%\n",
      truth.name, study.t.size(), study.t.back(), study.n_realizations, study.rho, study.signal,
      100 * found.share_wrong(), 100 * found.share_right());
  std::fflush(stdout);
  return found;
}

// The share of wrong answers that 5 % allow, with 3 binomial errors.
double allowed(int ensembles) {
  return 0.05 + 3 * std::sqrt(0.05 * 0.95 / ensembles);
}

const Truth& truth_of(std::string_view name) {
  return *std::ranges::find(truths(), name, &Truth::name);
}

class Polynomial final : public Model {
 public:
  explicit Polynomial(std::size_t terms) {
    for (std::size_t j = 0; j < terms; ++j) {
      Parameter parameter{.name = std::string(1, static_cast<char>('a' + j)), .meaning = ""};
      parameter.linear = true;
      parameters_.push_back(parameter);
    }
  }
  std::string name() const override { return "terms_" + std::to_string(parameters_.size()); }
  const std::vector<Parameter>& parameters() const override { return parameters_; }
  double value(double t, const double* p) const override {
    double sum = 0;
    for (std::size_t j = parameters_.size(); j-- > 0;) sum = sum * t + p[j];
    return sum;
  }

 private:
  std::vector<Parameter> parameters_;
};

// The inverse log as a user may write it.
class Repeated final : public Model {
 public:
  std::string name() const override { return "repeated"; }
  const std::vector<Parameter>& parameters() const override { return law_.parameters(); }
  double value(double t, const double* p) const override { return law_.value(t, p); }

 private:
  InverseLog law_;
};

LawComparison constant_against_line(const Curve& curve) {
  const Polynomial constant(1), line(2);
  const Fit a = std::get<Fit>(fit(constant, curve)), b = std::get<Fit>(fit(line, curve));
  return compare_laws({{&constant, &a}, {&line, &b}}, curve);
}

/// Rates over 20 ensembles each: three realizations with a signal little above noise of memory rho,
/// and six with a signal far above it.
void check_rates(const char* name, double rho) {
  constexpr int ensembles = 20;
  const Truth& truth = truth_of(name);
  CAPTURE(name, rho);
  CHECK(rates(truth, {taps(60), 3, 0.3, rho}, ensembles).share_wrong() <= allowed(ensembles));
  const Rates clear = rates(truth, {taps(60), 6, 2, rho}, ensembles);
  CHECK(clear.share_wrong() <= allowed(ensembles));
  CHECK(clear.share_right() >= 0.9);
}

}  // namespace

TEST_CASE("A constant and a line compare as the algebra of linear laws has it") {
  // Realizations of three values each; along u = (-1, 0, 1)/sqrt(2) they are 2, 3 and 7 / sqrt(2).
  const std::vector<double> values = {0, 4, -2,  //
                                      3, 3, 3,   //
                                      2, 7, 5};
  const Curve curve = mean_curve({1, 2, 3}, values, 3);
  const LawComparison found = constant_against_line(curve);
  REQUIRE(found.laws.size() == 2);
  CHECK(found.laws[found.leading].model == "terms_2");
  const double mean = 4 / std::sqrt(2.0), variance = 7.0 / 2;  // mean of the three values along u
  double pooled = 0;                                           // variance of one realization
  for (std::size_t i = 0; i < 9; ++i) pooled += std::pow(values[i] - curve.x[i / 3], 2) / 6;
  const HeldOutLaw& worse = found.laws[0];
  // |mean along u|^2 without bias, and its errors of first and second order; a mean over 3 points.
  CHECK(worse.difference == Approx((mean * mean - variance / 3) / (3 * pooled)).epsilon(1e-9));
  CHECK(
      worse.error ==
      Approx(std::sqrt(4 * mean * mean * variance / 3 + 2 * variance * variance / 6) / (3 * pooled))
          .epsilon(1e-9));
  CHECK(worse.t == Approx(worse.difference / worse.error));
  CHECK(worse.p > 0.05);
  CHECK_FALSE(found.is_decided());
}

TEST_CASE("Levels of realizations cancel in the comparison of laws") {
  const Truth& truth = truth_of("inverse_log");
  const auto pooled = [](const Curve& curve) {
    return std::pow(with_pooled_errors(curve).sigma[0], 2);
  };
  const Curve bare = ensemble(truth, taps(60), 4, {1e-4, 0.5, 0}, 1);
  Curve raised = bare;
  for (std::size_t i = 0; i < raised.t.size(); ++i) {
    for (std::size_t m = 0; m < 4; ++m) raised.values[4 * i + m] += m == 0 ? 0.03 : -0.01;
  }
  const LawComparison comparison = comparison_of(bare, three_laws),
                      second = comparison_of(raised, three_laws);
  REQUIRE(comparison.leading == second.leading);
  for (std::size_t i = 0; i < comparison.laws.size(); ++i) {
    CAPTURE(comparison.laws[i].model);
    CHECK(second.laws[i].difference * pooled(raised) ==
          Approx(comparison.laws[i].difference * pooled(bare)).epsilon(1e-3).margin(1e-14));
    CHECK(second.laws[i].p == Approx(comparison.laws[i].p).epsilon(1e-2).margin(1e-9));
  }
}

TEST_CASE("Laws are not chosen without three realizations that differ") {
  const Truth& truth = truth_of("kww");
  for (const int m : {1, 2}) {
    const LawComparison found = comparison_of(ensemble(truth, taps(60), m, {1e-5}, 1), three_laws);
    CHECK(found.cannot_decide ==
          "the choice of a law requires 3 independent realizations or more, "
          "the curve has " +
              std::to_string(m));
    CHECK_FALSE(found.is_decided());
    CHECK(found.laws.empty());
  }
  const LawComparison copies = comparison_of(ensemble(truth, taps(60), 3, {0}, 1), three_laws);
  CHECK(copies.cannot_decide == "the realizations do not scatter: they are copies of one curve");
  const Curve curve = ensemble(truth, taps(60), 3, {1e-3}, 1);
  CHECK(comparison_of(curve, {"kww"}).cannot_decide.empty());
  const LawComparison logarithmic = comparison_of(curve, {"kww", "power_law"});
  CHECK(logarithmic.left_out ==
        std::vector<std::string>{"power_law was not compared: it is fitted to ln X, not to X"});
  CHECK_FALSE(logarithmic.is_decided());
}

TEST_CASE("Laws that draw one curve are not distinguished") {
  const InverseLog law;
  const Repeated repeated;
  for (const double deviation : {1e-6, 1e-3}) {
    const Curve curve = ensemble(truth_of("inverse_log"), taps(100), 6, {deviation, 0.9, 1e-3}, 3);
    const Fit first = std::get<Fit>(fit(law, curve)), second = std::get<Fit>(fit(repeated, curve));
    const LawComparison found = compare_laws({{&law, &first}, {&repeated, &second}}, curve);
    REQUIRE(found.laws.size() == 2);
    CHECK(found.laws[1 - found.leading].same_curve);
    CHECK_FALSE(found.is_decided());
    CHECK(choice_text(found).find("(same curve)") != std::string::npos);
  }
}

TEST_CASE("A law at its limit is compared as the law of that limit") {
  // 1 / (1 + t/50): the inverse log of infinite B and tau.
  const InverseLog inverse_log;
  const StretchedExponential kww;
  int limits = 0;
  for (int number = 1; number <= 5; ++number) {
    Noise noise(static_cast<std::uint64_t>(number));
    const std::vector<double> t = geometric(1, 1000, 60);
    std::vector<double> values;
    for (const double tap : t) {
      for (int m = 0; m < 6; ++m) values.push_back(1 - 1 / (1 + tap / 50) + 2e-3 * noise());
    }
    const Curve curve = mean_curve(t, std::move(values), 6);
    const Fit first = std::get<Fit>(fit(inverse_log, curve)),
              second = std::get<Fit>(fit(kww, curve));
    limits += first.limit.has_value();
    const LawComparison found = compare_laws({{&inverse_log, &first}, {&kww, &second}}, curve);
    REQUIRE(found.laws.size() == 2);
    for (const HeldOutLaw& law : found.laws) {
      CHECK(std::isfinite(law.squared_error));
      CHECK(std::isfinite(law.difference));
      CHECK(std::isfinite(law.error));
    }
    CHECK(found.laws[found.leading].model == "inverse_log");
    CHECK(found.is_decided());
  }
  CHECK(limits > 0);
}

TEST_CASE("The law that made few realizations is found, the wrong one seldom", "[statistics]") {
  check_rates("inverse_log", 0);
  check_rates("kww", 0.99);
}

TEST_CASE("The law that made few realizations is found for other laws and memories", "[slow]") {
  check_rates("inverse_log", 0.99);
  check_rates("kww", 0);
  for (const double rho : {0.0, 0.99}) check_rates("one exponential", rho);
}

TEST_CASE("The calibration of the comparison of laws", "[nightly]") {
  // An hour of one core: -c NAME takes one curve.
  constexpr int ensembles = 100;
  for (const Truth& truth : truths()) {
    DYNAMIC_SECTION(truth.name) {
      for (const int m : {3, 6, 20}) {
        for (const double rho : {0.0, 0.9, 0.99}) {
          for (const double signal : {0.1, 0.5, 2.0}) {
            const Rates found = rates(truth, {taps(100), m, signal, rho}, ensembles);
            CHECK(found.share_wrong() <= allowed(ensembles));
          }
        }
      }
    }
  }
}

TEST_CASE("The calibration of the comparison of laws on logarithmic grids", "[nightly]") {
  constexpr int ensembles = 100;
  for (const Truth& truth : truths()) {
    DYNAMIC_SECTION(truth.name) {
      for (const int m : {3, 6, 20}) {
        for (const double rho : {0.0, 0.9}) {
          for (const double signal : {0.5, 2.0}) {
            const Rates found = rates(truth, {geometric(1, 1e4, 60), m, signal, rho}, ensembles);
            CHECK(found.share_wrong() <= allowed(ensembles));
          }
        }
      }
    }
  }
}

TEST_CASE("The calibration of the comparison of laws over 4000 taps", "[nightly]") {
  constexpr int ensembles = 20;
  for (const Truth& truth : truths()) {
    DYNAMIC_SECTION(truth.name) {
      for (const int m : {3, 6, 20}) {
        for (const double signal : {0.1, 0.5}) {
          const Rates found = rates(truth, {taps(4000), m, signal, 0.99}, ensembles);
          CHECK(found.share_wrong() <= allowed(ensembles));
        }
      }
    }
  }
}

}  // namespace jostle
