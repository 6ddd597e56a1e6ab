#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "fitting/fit.hpp"
#include "fitting/mean_of_present.hpp"
#include "fitting/models/models.hpp"
#include "tests/fitting/noise.hpp"

// Fits to realizations with gaps: how often intervals hold the truth, and that no level is moved by
// who is missing.
namespace jostle {
namespace {

enum class Missing { none, random, drop_out };

struct Law {
  const char* model;
  ParameterValues truth;
  double noise;     // deviation of a realization
  double step = 2;  // step of 200 values of t that begin at `first`
  double first = 1;
};

const Law kww{"kww", {0.6, 0.55, 30, 0.6}, 1e-3};
const std::vector<Law>& other_laws() {
  static const std::vector<Law> all = {{"inverse_log", {0.58, 0.05, 1.0, 3}, 1e-3},
                                       {"two_exponentials", {13.5, 0.4, 8, 0.3, 100}, 0.01},
                                       {"ageing", {0.5, 0.8, 10}, 5e-3},
                                       {"profile", {0.6, 0.002, 2, 24}, 5e-3, 0.115, 5}};
  return all;
}

struct Ensemble {
  int m = 4;
  double rho = 0, offset = 0;  // memory from point to point; offsets over noise
  Missing missing = Missing::none;
};

// At random a fifth of the values; or half of the realizations, which leave one after another.
bool is_missing(const Ensemble& ensemble, int r, int k, double uniform) {
  if (ensemble.missing == Missing::random) return uniform < 0.2;
  return ensemble.missing == Missing::drop_out && r >= (ensemble.m + 1) / 2 && k >= 50 + 10 * r;
}

/// [n_t] and [n_t, m], NaN where a value is missing.
struct Measured {
  std::vector<double> t, values;
};

Measured measured(const Ensemble& ensemble, const Law& law, const Model& model, int number) {
  Noise noise(static_cast<std::uint64_t>(number));
  std::vector<double> states(static_cast<std::size_t>(ensemble.m)), offsets = states;
  auto [t, values] = Measured{};
  for (double& state : states) state = noise();
  for (double& offset : offsets) offset = ensemble.offset * noise();
  for (int k = 0; k < 200; ++k) {
    const double time = law.first + law.step * k, value = model.value(time, law.truth.data());
    std::vector<double> row;
    int n = 0;
    for (int r = 0; r < ensemble.m; ++r) {
      double& state = states[static_cast<std::size_t>(r)];
      const bool gap = is_missing(ensemble, r, k, noise.uniform());
      n += !gap;
      row.push_back(gap ? std::numeric_limits<double>::quiet_NaN()
                        : value + law.noise * (state + offsets[static_cast<std::size_t>(r)]));
      state = ensemble.rho * state + std::sqrt(1 - ensemble.rho * ensemble.rho) * noise();
    }
    if (n < 2) continue;
    t.push_back(time);
    values.insert(values.end(), row.begin(), row.end());
  }
  return {std::move(t), std::move(values)};
}

Curve curve_of(const Ensemble& ensemble, const Law& law, const Model& model, int number) {
  auto [t, values] = measured(ensemble, law, model, number);
  return mean_of_present(std::move(t), std::move(values), static_cast<std::size_t>(ensemble.m));
}

/// Shares of intervals that contain the truth, of all parameters; mean degrees of freedom.
struct Coverage {
  double share[2] = {0, 0};  // at interval_levels
  double dof = 0;
};

Coverage coverage(const Law& law, const Ensemble& ensemble, int ensembles) {
  const auto model = make_model(law.model);
  Coverage found;
  int examined = 0, covered[2] = {0, 0};
  for (int number = 1; number <= ensembles; ++number) {
    const auto result = fit(*model, curve_of(ensemble, law, *model, number));
    const Fit& fitted = std::get<Fit>(result);
    found.dof += fitted.error_dof / ensembles;
    for (std::size_t j = 0; j < law.truth.size(); ++j) {
      ++examined;
      for (int level = 0; level < 2; ++level) {
        const Interval& interval = fitted.estimates[j].intervals[level];
        covered[level] += interval.lower <= law.truth[j] && law.truth[j] <= interval.upper;
      }
    }
  }
  for (int level = 0; level < 2; ++level) found.share[level] = 1.0 * covered[level] / examined;
  return found;
}

void check(const Law& law, const Ensemble& ensemble, int ensembles, double least = 0.93) {
  const Coverage found = coverage(law, ensemble, ensembles);
  const char* names[] = {"none", "random", "drop-out"};
  const double low = found.share[0], high = found.share[1], dof = found.dof;
  std::printf(
      "%-16s gaps %-8s M %2d  rho %4.2f  offsets %1.0f  68 %%: %5.1f  95 %%: %5.1f  dof %4.2f\n",
      law.model, names[static_cast<int>(ensemble.missing)], ensemble.m, ensemble.rho,
      ensemble.offset, 100 * low, 100 * high, dof);
  std::fflush(stdout);
  INFO(law.model << ", " << names[static_cast<int>(ensemble.missing)] << ", " << ensemble.m
                 << " realizations, rho " << ensemble.rho);
  const auto margin = [&](double rate) { return 3 * std::sqrt(rate * (1 - rate) / ensembles); };
  CHECK(low >= 0.60 - margin(0.60));
  CHECK(low <= 0.80 + margin(0.80));
  CHECK(high >= least - margin(least));
  CHECK(dof <= ensemble.m - 1 + 1e-9);
  CHECK(dof >= 1);
}

}  // namespace

TEST_CASE("Realizations with gaps: intervals hold the truth at their stated rate", "[statistics]") {
  check(kww, {4, 0, 1, Missing::random}, 15);
  check(kww, {4, 0.99, 1, Missing::drop_out}, 15);
  check(kww, {10, 0, 0, Missing::drop_out}, 15);
}

TEST_CASE("Realizations with gaps: the order of the points changes no interval") {
  const auto model = make_model("kww");
  constexpr std::size_t m = 5;
  const Measured sorted = measured({m, 0.97, 1, Missing::drop_out}, kww, *model, 1);
  Measured mixed;
  const std::size_t n = sorted.t.size();
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = 37 * k % n;  // no neighbour stays one
    mixed.t.push_back(sorted.t[i]);
    const auto row = sorted.values.begin() + static_cast<std::ptrdiff_t>(i * m);
    mixed.values.insert(mixed.values.end(), row, row + m);
  }
  const auto first = fit(*model, mean_of_present(sorted.t, sorted.values, m)),
             second = fit(*model, mean_of_present(mixed.t, mixed.values, m));
  const Fit &a = std::get<Fit>(first), &b = std::get<Fit>(second);
  CHECK(b.error_dof == Approx(a.error_dof).epsilon(1e-6));
  CHECK(a.error_dof < 3.5);
  for (std::size_t j = 0; j < a.estimates.size(); ++j) {
    const Interval &of_a = a.estimates[j].intervals[1], &of_b = b.estimates[j].intervals[1];
    const double width = of_a.upper - of_a.lower;
    CHECK(of_b.lower == Approx(of_a.lower).margin(1e-3 * width));
    CHECK(of_b.upper == Approx(of_a.upper).margin(1e-3 * width));
  }
}

TEST_CASE("Six realizations, of which half leave, with a memory of half the curve", "[slow]") {
  // Less two standard errors of 300 ensembles. By influences of small changes of weight 91 %.
  constexpr int ensembles = 300;
  const double least = 0.95 - 2 * std::sqrt(0.95 * 0.05 / ensembles);
  const auto& laws = other_laws();
  const auto ageing = std::ranges::find(laws, std::string("ageing"), &Law::model);
  CHECK(coverage(*ageing, {6, 0.99, 1, Missing::drop_out}, ensembles).share[1] >= least);
}

TEST_CASE("Realizations with gaps: the table of intervals", "[nightly]") {
  for (const int m : {3, 4, 6, 10, 20}) {
    for (const double rho : {0.0, 0.99}) {
      for (const double offset : {0.0, 1.0}) {
        for (const Missing missing : {Missing::none, Missing::random, Missing::drop_out}) {
          check(kww, {m, rho, offset, missing}, 200);
        }
      }
    }
  }
}

TEST_CASE("Realizations with gaps: intervals of other laws", "[nightly]") {
  for (const Law& law : other_laws()) {
    DYNAMIC_SECTION(law.model) {
      for (const int m : {3, 6, 20}) {
        for (const double rho : {0.0, 0.99}) {
          for (const double offset : {0.0, 1.0}) {
            for (const Missing missing : {Missing::random, Missing::drop_out}) {
              check(law, {m, rho, offset, missing}, 100);
            }
          }
        }
      }
    }
  }
}

TEST_CASE("Who drops out does not move the level: the lowest realizations leave") {
  // Offsets 20 times the noise; those that leave are always the two lowest.
  const auto model = make_model("kww");
  double mean = 0;
  constexpr int ensembles = 10;
  for (int number = 1; number <= ensembles; ++number) {
    Noise noise(static_cast<std::uint64_t>(number));
    std::vector<double> t, values;
    for (int k = 1; k < 400; k += 2) {
      t.push_back(k);
      for (int r = 0; r < 4; ++r) {
        const double offset = 0.002 * (r - 1.5);
        const bool gap = r < 2 && k > 150;
        const double value = model->value(k, kww.truth.data()) + offset + 1e-4 * noise();
        values.push_back(gap ? std::numeric_limits<double>::quiet_NaN() : value);
      }
    }
    const auto result = fit(*model, mean_of_present(t, values, 4));
    mean += std::get<Fit>(result).estimates[0].value / ensembles;
  }
  // A plain mean would end 0.002 too high.
  CHECK(mean == Approx(0.6).margin(2e-4));
}

}  // namespace jostle
