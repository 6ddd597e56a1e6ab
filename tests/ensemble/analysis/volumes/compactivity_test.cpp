#include "ensemble/analysis/volumes/compactivity.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "ensemble/analysis/volumes/log_ratio.hpp"
#include "fitting/fit.hpp"
#include "fitting/intervals/distributions.hpp"
#include "tests/ensemble/synthetic_series.hpp"

// Volumes with known 1/X: their intervals, and how often the verdict is wrong.

using namespace jostle;

namespace {

constexpr std::size_t n_states = 3;

/// The volumes: normal ones of constant variance and k-gamma ones have one density of states for
/// all strengths, so that 1/X is known; the others have not.
enum class Kind { normal, gamma, widths, skewed };

struct Setting {
  std::size_t realizations, n_taps;
  double rho;
};

/// For unit variance.
std::vector<double> memory(const Setting& setting, double rho, std::uint64_t seed,
                           std::uint64_t stream) {
  std::vector<double> series = synthetic::autoregressive(rho, setting.n_taps, seed, stream);
  for (double& x : series) x *= std::sqrt(1 - rho * rho);
  return series;
}

/// Normal: D is normal, mean 100 - 1/X, variance 1. Gamma: D(V) = V^3, scale X, the sum of eight
/// squares.
std::vector<double> volumes(Kind kind, std::size_t state, const Setting& setting,
                            std::uint64_t seed, std::uint64_t stream) {
  const auto i = static_cast<double>(state);
  const double shrinks = std::pow(1.5, -i);
  std::vector<double> series(setting.n_taps, kind == Kind::gamma ? 0 : 100 - i);
  const std::size_t terms = kind == Kind::gamma ? 8 : 1;
  for (std::size_t k = 0; k < terms; ++k) {
    const double rho = kind == Kind::gamma ? std::sqrt(setting.rho) : setting.rho;
    const std::vector<double> x = memory(setting, rho, seed, 1000 * stream + k);
    for (std::size_t t = 0; t < series.size(); ++t) {
      series[t] += kind == Kind::gamma    ? 0.5 * shrinks * x[t] * x[t]
                   : kind == Kind::widths ? shrinks * x[t]
                   : kind == Kind::skewed ? std::exp(0.6 * x[t]) - 1
                                          : x[t];
    }
  }
  return series;
}

struct Ensemble {
  std::vector<SteadyVolumes> states;
  VolumeBins bins;
};

Ensemble ensemble(Kind kind, const Setting& setting, std::uint64_t seed) {
  Ensemble made{std::vector<SteadyVolumes>(n_states), {}};
  std::vector<std::vector<double>> all;
  for (std::size_t i = 0; i < n_states; ++i) {
    for (std::size_t r = 0; r < setting.realizations; ++r) {
      all.push_back(volumes(kind, i, setting, seed, i * setting.realizations + r));
      made.states[i].add(all.back());
    }
  }
  made.bins = volume_bins(made.states);
  for (std::size_t k = 0; k < all.size(); ++k)
    made.states[k / setting.realizations].count(all[k], made.bins);
  return made;
}

/// How many intervals of 68 and of 95 % hold the truth.
struct Coverage {
  std::size_t held_68 = 0, held_95 = 0;
  void add(const Jackknifed& found, double truth) {
    const double deviation = std::abs(found.value - truth) / found.error.error;
    held_68 += deviation < student_two_sided(interval_levels[0], found.error.dof);
    held_95 += deviation < student_two_sided(interval_levels[1], found.error.dof);
  }
  void add(const LogEstimate& found, double truth) {
    held_68 += found.low_68 < truth && truth < found.high_68;
    held_95 += found.low_95 < truth && truth < found.high_95;
  }
};

struct Counts {
  Coverage fluctuations{}, histograms{}, variance{};
  std::size_t disagree = 0, agree = 0, drifting = 0;
};

Counts calibrated(Kind kind, const Setting& setting, std::size_t ensembles) {
  Counts counts;
  const double truth = kind == Kind::gamma ? 1.25 : 2;
  const double variance = kind == Kind::gamma ? 4 / 2.25 : 1;
  for (std::size_t e = 0; e < ensembles; ++e) {
    const Ensemble made = ensemble(kind, setting, 19890157 + e);
    const auto steps = compactivity_steps(made.states, made.bins);
    counts.fluctuations.add(inverse_compactivity(steps, &CompactivityStep::fluctuations).back(),
                            truth);
    counts.histograms.add(inverse_compactivity(steps, &CompactivityStep::histograms).back(), truth);
    counts.variance.add(variance_of(made.states[1]), variance);
    const std::string statement =
        compactivity_verdict(steps, drift_together(made.states)).statement;
    counts.drifting += statement.find("together still drift") != std::string::npos;
    counts.disagree += statement.starts_with("disagree");
    counts.agree += statement.starts_with("agree");
  }
  return counts;
}

double deviation(double share, std::size_t n) {
  return std::sqrt(share * (1 - share) / static_cast<double>(n));
}

void check_coverage(const Coverage& coverage, std::size_t n) {
  const auto total = static_cast<double>(n);
  CHECK(static_cast<double>(coverage.held_68) / total >= 0.6 - 3 * deviation(0.6, n));
  CHECK(static_cast<double>(coverage.held_68) / total <= 0.78 + 3 * deviation(0.78, n));
  CHECK(static_cast<double>(coverage.held_95) / total >= 0.9 - 3 * deviation(0.9, n));
}

void check(const std::vector<Setting>& settings, std::size_t ensembles) {
  fmt::print("{:>7} {:>3} {:>5} {:>5} | {:>11} | {:>11} | {:>11} | disagree agree\n", "volumes",
             "M", "taps", "rho", "fluct.", "histograms", "variance");
  const char* const names[] = {"normal", "gamma", "widths", "skewed"};
  for (const Kind kind : {Kind::normal, Kind::gamma, Kind::widths, Kind::skewed}) {
    for (const Setting& setting : settings) {
      const Counts counts = calibrated(kind, setting, ensembles);
      const auto percent = [&](std::size_t n) {
        return 100 * static_cast<double>(n) / static_cast<double>(ensembles);
      };
      const bool true_form = kind == Kind::normal || kind == Kind::gamma;
      fmt::print("{:>7} {:>3} {:>5} {:>5} |", names[static_cast<int>(kind)], setting.realizations,
                 setting.n_taps, setting.rho);
      for (const Coverage* coverage :
           {&counts.fluctuations, &counts.histograms, &counts.variance}) {
        if (true_form)
          fmt::print(" {:5.1f} {:5.1f} |", percent(coverage->held_68), percent(coverage->held_95));
        else
          fmt::print(" {:>11} |", "");
      }
      fmt::print(" {:8.1f} {:5.1f}\n", percent(counts.disagree), percent(counts.agree));
      CAPTURE(names[static_cast<int>(kind)], setting.realizations, setting.n_taps, setting.rho);
      CHECK(percent(counts.drifting) <=
            100 * (CompactivityVerdict::level +
                   3 * deviation(CompactivityVerdict::level, ensembles)));
      if (true_form) {
        check_coverage(counts.fluctuations, ensembles);
        check_coverage(counts.histograms, ensembles);
        check_coverage(counts.variance, ensembles);
        CHECK(percent(counts.disagree) <=
              100 * (CompactivityVerdict::level +
                     3 * deviation(CompactivityVerdict::level, ensembles)));
      } else {
        // Where the verdict gives it, it is detected in at least 80 %.
        CHECK(percent(counts.agree) <= 100 * (0.2 + 3 * deviation(0.2, ensembles)));
      }
    }
  }
  std::fflush(stdout);
}

}  // namespace

TEST_CASE("The jackknife takes the bias of a variance about the mean of realizations away") {
  SteadyVolumes state;
  for (const double mean : {1.0, 2.0, 6.0}) state.add(std::vector{mean - 0.5, mean + 0.5});
  // For single values: within 1/4 and between 14/3 of the means about theirs.
  CHECK(state.mean(3) == Approx(3).epsilon(1e-14));
  CHECK(state.variance(3) == Approx(0.25 + 14.0 / 3).epsilon(1e-14));
  CHECK(state.variance(2) == Approx(0.25 + 0.25).epsilon(1e-14));
  Replicates variance{state.variance(3), {}};
  for (std::size_t r = 0; r < 3; ++r) variance.left_out.push_back(state.variance(r));
  // Unbiased: 1/4 and 1/(M - 1) of the squares between.
  CHECK(jackknifed(variance).value == Approx(0.25 + 7).epsilon(1e-13));
  CHECK(jackknifed(variance).error.dof == 2);
}

TEST_CASE("ln P_2/P_1 of histograms that are tilts of one another is the tilt, whatever D is") {
  const VolumeBins bins{.first = 0, .width = 0.1, .count = 80};
  std::vector<double> first(80), second(80);
  double sum_1 = 0, sum_2 = 0;
  for (std::size_t k = 0; k < 80; ++k) {
    const double v = bins.middle(k), states = 1 + std::pow(std::sin(3 * v), 2) * v;
    first[k] = states * std::exp(-0.5 * v);
    second[k] = states * std::exp(-1.2 * v);
    sum_1 += first[k];
    sum_2 += second[k];
  }
  for (double& share : first) share /= sum_1;
  for (double& share : second) share /= sum_2;
  const LogRatio found = log_ratio(first, second, bins, 2, 1.5);
  CHECK(found.slope == Approx(-0.7).epsilon(1e-8));
  CHECK(std::abs(found.slope_change) < 1e-7);
  CHECK(shared(first, first) == Approx(1).epsilon(1e-12));
}

TEST_CASE("ln P_2/P_1 of normal laws of two widths bends by their variances") {
  const VolumeBins bins{.first = -12, .width = 0.05, .count = 480};
  std::vector<double> first(480), second(480);
  for (std::size_t k = 0; k < 480; ++k) {
    const double v = bins.middle(k);
    first[k] = std::exp(-0.5 * v * v) * 0.05 / std::sqrt(2 * M_PI);
    second[k] = std::exp(-0.5 * (v - 1) * (v - 1) / 1.44) * 0.05 / std::sqrt(2 * M_PI * 1.44);
  }
  // d^2 ln(P_2/P_1) / dV^2 = 1 - 1/1.44, over a scale of 2.
  CHECK(log_ratio(first, second, bins, 0.5, 2).slope_change ==
        Approx(2 * (1 - 1 / 1.44)).epsilon(1e-6));
}

TEST_CASE("States that do not vary or do not overlap are reported") {
  std::vector<SteadyVolumes> still(2);
  for (SteadyVolumes& state : still) state.add(std::vector{1.0, 1.0});
  CHECK_THROWS_AS(volume_bins(still), std::invalid_argument);
  std::vector<SteadyVolumes> separated(2);
  const Setting setting{4, 100, 0};
  VolumeBins bins;
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t r = 0; r < 4; ++r) {
        std::vector<double> series = memory(setting, 0, 1, 10 * i + r);
        for (double& x : series) x += 50 * static_cast<double>(i);
        if (pass == 0)
          separated[i].add(series);
        else
          separated[i].count(series, bins);
      }
    }
    if (pass == 0) bins = volume_bins(separated);
  }
  const auto steps = compactivity_steps(separated, bins);
  CHECK_FALSE(steps[0].overlaps);
  CHECK(std::isnan(inverse_compactivity(steps, &CompactivityStep::histograms)[1].value));
  CHECK(inverse_compactivity(steps, &CompactivityStep::fluctuations)[1].value < -40);
  CHECK(compactivity_verdict(steps, drift_together(separated))
            .statement.starts_with("cannot decide"));
}

TEST_CASE("Realizations that do not differ decide nothing on compactivities") {
  CompactivityStep step{.start = 0, .end = 1};
  step.separation = 1;
  step.overlaps = true;
  step.fluctuations = {1, {1, 1, 1}};
  step.histograms = {3, {3, 3, 3}};
  step.curvature = {2, {2, 2, 2}};
  const CompactivityVerdict even = compactivity_verdict(std::span(&step, 1), {0.1, {0.05, 2}});
  CHECK(std::isnan(even.difference_p));
  CHECK(even.statement ==
        "cannot decide: no test, for errors are not known, 3 realizations; no disagreement, "
        "however large, would be found");
  const CompactivityVerdict drifting = compactivity_verdict(std::span(&step, 1), {5, {0, 2}});
  CHECK(
      drifting.statement.starts_with("cannot decide: the states of all realizations drift by 5 "));
}

TEST_CASE("Steps are advised by the neighbours that overlap") {
  CompactivityStep steps[] = {{.start = 0, .end = 1}, {.start = 1, .end = 2}};
  steps[0].separation = 0.3;
  steps[0].overlaps = true;
  steps[0].fluctuations = {1, {1, 1.1, 0.9}};
  steps[0].histograms = {1, {1.1, 0.9, 1}};
  steps[0].curvature = {0, {0.1, -0.1, 0}};
  steps[1].separation = 3;
  const auto statement = [&](std::size_t n) {
    return compactivity_verdict({steps, n}, {0.1, {0.5, 2}}).statement;
  };
  CHECK(statement(1).starts_with("cannot decide: neighbours are at most 0.3 deviations apart"));
  CHECK(statement(2).find("neighbours that overlap are at most 0.3") != std::string::npos);
}

TEST_CASE("Close neighbours would agree whatever they are: no verdict") {
  const Setting setting{10, 1000, 0};
  std::vector<SteadyVolumes> states(2);
  VolumeBins bins;
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t r = 0; r < 10; ++r) {
        std::vector<double> series = memory(setting, 0, 2, 100 * i + r);
        for (double& x : series) x = std::exp(0.6 * x) + 0.2 * static_cast<double>(i);
        if (pass == 0)
          states[i].add(series);
        else
          states[i].count(series, bins);
      }
    }
    if (pass == 0) bins = volume_bins(states);
  }
  const CompactivityVerdict verdict =
      compactivity_verdict(compactivity_steps(states, bins), drift_together(states));
  CHECK(verdict.separation < CompactivityVerdict::least_separation);
  CHECK_FALSE(verdict.statement.starts_with("agree"));
  CHECK(verdict.statement.find("bend of ln P_1/P_2") != std::string::npos);
}

TEST_CASE("A drift that no state alone shows is seen in all together, and decides nothing") {
  std::size_t alone = 0, found = 0;
  constexpr std::size_t ensembles = 40, n_drifting = 12, realizations = 10, n_taps = 1000;
  for (std::size_t e = 0; e < ensembles; ++e) {
    std::vector<SteadyVolumes> states(n_drifting);
    for (std::size_t i = 0; i < n_drifting; ++i) {
      for (std::size_t r = 0; r < realizations; ++r) {
        std::vector<double> x = memory({realizations, n_taps, 0.9}, 0.9, 7 + e, 100 * i + r);
        for (std::size_t t = 0; t < n_taps; ++t)
          x[t] += 100 - 0.2 * static_cast<double>(t) / n_taps;
        states[i].add(x);
      }
    }
    const auto drifts = [](std::span<const SteadyVolumes> neighbours) {
      const Jackknifed drift = drift_together(neighbours);
      return p_value(drift.value, drift.error) < CompactivityVerdict::level;
    };
    found += drifts(states);
    alone += drifts({states.data(), 1});
  }
  CAPTURE(alone, found);
  CHECK(found > 0.9 * ensembles);
  CHECK(alone < 0.4 * ensembles);
  std::vector<SteadyVolumes> states(1);
  states[0].add(std::vector{1.0, 2.0, 3.5});
  CHECK_FALSE(drift_together(states).error.known());
}

TEST_CASE("Both estimators follow their definitions, value by value") {
  const Setting setting{4, 400, 0.5};
  std::vector<std::vector<double>> all[2];
  std::vector<SteadyVolumes> states(2);
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t r = 0; r < setting.realizations; ++r) {
      all[i].push_back(volumes(Kind::gamma, i, setting, 3, 10 * i + r));
      states[i].add(all[i].back());
    }
  }
  const VolumeBins bins = volume_bins(states);
  double mean[2] = {}, variance[2] = {};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto n = static_cast<double>(setting.realizations * setting.n_taps);
    for (const auto& series : all[i]) {
      states[i].count(series, bins);
      for (const double v : series) mean[i] += v / n;
    }
    for (const auto& series : all[i])
      for (const double v : series) variance[i] += (v - mean[i]) * (v - mean[i]) / n;
  }
  const CompactivityStep step = compactivity_steps(states, bins)[0];
  CHECK(step.fluctuations.whole ==
        Approx((mean[0] - mean[1]) / std::sqrt(variance[0] * variance[1])).epsilon(1e-9));
  // Logistic regression of single volumes, without bins, by Newton's method: their bins are a
  // sixteenth of a deviation.
  double level = 0, slope = 0;
  for (int iteration = 0; iteration < 50; ++iteration) {
    double g0 = 0, g1 = 0, h00 = 0, h01 = 0, h11 = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      for (const auto& series : all[i]) {
        for (const double v : series) {
          const double x = v - mean[0], p = 1 / (1 + std::exp(-(level + slope * x)));
          g0 += static_cast<double>(i) - p;
          g1 += (static_cast<double>(i) - p) * x;
          h00 += p * (1 - p);
          h01 += p * (1 - p) * x;
          h11 += p * (1 - p) * x * x;
        }
      }
    }
    const double determinant = h00 * h11 - h01 * h01;
    level += (h11 * g0 - h01 * g1) / determinant;
    slope += (h00 * g1 - h01 * g0) / determinant;
  }
  CHECK(step.histograms.whole == Approx(-slope).epsilon(0.01));
}

TEST_CASE("Compactivities and their verdict are calibrated", "[statistics]") {
  check({{3, 1000, 0.9}}, 100);
}

TEST_CASE("Compactivities and their verdict are calibrated, 2 to 20 realizations", "[slow]") {
  check({{2, 1000, 0.99}, {4, 1000, 0.99}, {10, 1000, 0}, {20, 1000, 0.99}}, 100);
}

TEST_CASE("Compactivities and their verdict are calibrated in many ensembles", "[nightly]") {
  check({{3, 1000, 0},
         {3, 1000, 0.9},
         {3, 1000, 0.99},
         {4, 1000, 0},
         {4, 1000, 0.99},
         {10, 1000, 0},
         {10, 1000, 0.9},
         {10, 1000, 0.99},
         {20, 1000, 0},
         {20, 1000, 0.99}},
        500);
}
