#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "ensemble/analysis/motion/motion_curves.hpp"
#include "ensemble/analysis/motion/motion_tables.hpp"
#include "ensemble/moments.hpp"
#include "ensemble/statistics/log_estimate.hpp"
#include "fitting/fit.hpp"
#include "fitting/intervals/distributions.hpp"
#include "tests/ensemble/noise.hpp"
#include "tests/ensemble/synthetic_series.hpp"

// How often what is printed of the motion holds the truth, over ensembles of 3 to 20 realizations
// of spheres that move alone or in groups.

using namespace jostle;

namespace {

constexpr std::uint32_t n_spheres = 512;
constexpr std::size_t sizes[] = {3, 4, 10, 20};
constexpr int ensembles = 1500;

struct Coverage {
  int n = 0, in_68 = 0, in_95 = 0;

  void add(double truth, double low_68, double high_68, double low_95, double high_95) {
    if (std::isnan(low_95)) return;
    ++n;
    in_68 += low_68 <= truth && truth <= high_68;
    in_95 += low_95 <= truth && truth <= high_95;
  }
  void add(double truth, const LogEstimate& estimate) {
    add(truth, estimate.low_68, estimate.high_68, estimate.low_95, estimate.high_95);
  }
  void add(double truth, const MeanEstimate& estimate) {
    const double by_68 = estimate.error * student_two_sided(interval_levels[0], estimate.dof),
                 by_95 = estimate.error * student_two_sided(interval_levels[1], estimate.dof);
    add(truth, estimate.value - by_68, estimate.value + by_68, estimate.value - by_95,
        estimate.value + by_95);
  }
  double share_68() const { return static_cast<double>(in_68) / n; }
  double share_95() const { return static_cast<double>(in_95) / n; }
};

void require(const Coverage& found, bool not_too_wide = true) {
  CHECK(found.share_68() >= 0.60);
  CHECK(found.share_95() >= 0.90);
  if (!not_too_wide) return;
  CHECK(found.share_68() <= 0.78);
  CHECK(found.share_95() <= 0.99);
}

/// Walks of groups of `group` spheres, each with its own rate: of groups that are all alike, or one
/// in ten of which moves three times as far. Two waiting times, the second slower by `slowing`.
MotionRecords walks(std::size_t realizations, std::size_t group, bool mobile, double slowing,
                    RandomStream& random) {
  const MotionSettings settings{
      .origins = {0, 10}, .lags = {1, 2, 4}, .overlap_lengths = {0.1}, .layers = 2};
  MotionRecords records(settings, n_spheres, static_cast<std::uint32_t>(realizations));
  for (std::uint32_t r = 0; r < realizations; ++r) {
    MotionState state;
    for (std::size_t o = 0; o < 2; ++o) {
      MotionOrigin origin;
      origin.tap = settings.origins[o];
      origin.centres.resize(n_spheres);
      std::vector<Vec3> now(n_spheres);
      std::uint64_t index = 0;
      for (const std::uint64_t lag : settings.lags) {
        const double step = std::sqrt(static_cast<double>(lag - index) * (o == 1 ? slowing : 1.0));
        index = lag;
        Vec3 common;
        for (std::size_t i = 0; i < n_spheres; ++i) {
          const double scale = (mobile && (i / group) % 10 == 0 ? 0.09 : 0.03) * step;
          if (i % group == 0)
            common = {scale * noise(random), scale * noise(random), scale * noise(random)};
          now[i] = now[i] + common;
        }
        const auto values =
            motion_values(settings, origin.centres, now,
                          layers_of(std::vector<double>(n_spheres), settings.layers));
        origin.values.insert(origin.values.end(), values.begin(), values.end());
      }
      state.origins.push_back(std::move(origin));
    }
    records.add(r, state, PeriodicBox{8, 8});
  }
  return records;
}

/// For a share p of groups of `group` spheres that stay, the others moving: chi_4 = group p (1 -
/// p).
std::vector<double> overlaps(std::size_t realizations, std::size_t group, double p,
                             RandomStream& random) {
  std::vector<double> row;
  for (std::size_t r = 0; r < realizations; ++r) {
    double stay = 0;
    for (std::size_t i = 0; i < n_spheres; i += group)
      if (random.uniform() < p) stay += static_cast<double>(group);
    row.push_back(stay / n_spheres);
  }
  return row;
}

/// Spheres that move alone, Gaussian steps, those of each layer alike and `ratio` times as far as
/// those of the layer below. One waiting time and lag. `spread`: standard deviation over beds of
/// the logarithm of the mean square step.
MotionRecords sheared(std::size_t realizations, std::uint32_t spheres, std::uint32_t layers,
                      double ratio, synthetic::Gaussian& gaussian, double spread = 0) {
  const MotionSettings settings{
      .origins = {0}, .lags = {1}, .overlap_lengths = {0.1}, .layers = layers};
  MotionRecords records(settings, spheres, static_cast<std::uint32_t>(realizations));
  const std::vector<std::uint32_t> of_sphere = layers_of(std::vector<double>(spheres), layers);
  for (std::uint32_t r = 0; r < realizations; ++r) {
    MotionOrigin origin;
    origin.centres.resize(spheres);
    std::vector<Vec3> now(spheres);
    const double of_bed = 0.01 * (spread > 0 ? std::exp(spread * gaussian() / 2) : 1);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const double step = of_bed * std::pow(ratio, of_sphere[i]);
      now[i] = {step * gaussian(), step * gaussian(), step * (gaussian() - 1)};
    }
    origin.values = motion_values(settings, origin.centres, now, of_sphere);
    MotionState state;
    state.origins.push_back(std::move(origin));
    records.add(r, state, PeriodicBox{8, 8});
  }
  return records;
}

}  // namespace

TEST_CASE("Layers that move at their own rates, sphere by sphere, are not taken for groups") {
  constexpr std::uint32_t layers = 8;
  constexpr double ratio = 1.6;
  synthetic::Gaussian gaussian(20261125, 45);
  // For the truth: p of a layer that a lateral step is less than 0.1.
  double truth = 0, stay = 0;
  for (std::uint32_t k = 0; k < layers; ++k) {
    const double step = 0.01 * std::pow(ratio, k), p = 1 - std::exp(-0.005 / (step * step));
    truth += p * (1 - p) / layers;
    stay += p / layers;
  }
  REQUIRE(stay * (1 - stay) > 2 * truth);            // value of the whole bed
  for (const std::uint32_t spheres : {40u, 400u}) {  // 5 and 50 a layer
    CAPTURE(spheres);
    Moments independent, of_bed, chi_4, lateral, vertical, lateral_of_bed, vertical_of_bed;
    const int ensembles = 400;
    for (int e = 0; e < ensembles; ++e) {
      const MotionRecords records = sheared(4, spheres, layers, ratio, gaussian);
      for (const double value :
           independent_susceptibility(records, "layer_lateral_overlap", 0, 0, 0))
        independent.add(value);
      for (const double q : records.row("lateral_overlap", 0, 0)) of_bed.add(q * (1 - q));
      chi_4.add(four_point_susceptibility(records.row("lateral_overlap", 0, 0), spheres).value);
      for (std::uint32_t k = 0; k < layers; ++k) {
        lateral.add(layer_lateral_non_gaussian(records, 0, 0, k).value);
        vertical.add(layer_vertical_non_gaussian(records, 0, 0, k).value);
      }
      lateral_of_bed.add(lateral_non_gaussian(records, 0, 0).value);
      vertical_of_bed.add(vertical_non_gaussian(records, 0, 0).value);
    }
    CHECK(std::abs(independent.mean() - truth) <= 3 * independent.standard_error());
    CHECK(std::abs(chi_4.mean() - truth) <= 3 * chi_4.standard_error());
    CHECK(of_bed.mean() > 2 * truth);
    CHECK(std::abs(lateral.mean()) <= 3 * lateral.standard_error());
    CHECK(std::abs(vertical.mean()) <= 3 * vertical.standard_error());
    CHECK(lateral_of_bed.mean() > 0.5);
    CHECK(vertical_of_bed.mean() > 0.5);
  }
  // One layer is the whole bed; a sphere alone in its layer no information.
  const MotionRecords records = sheared(1, 200, 1, 1, gaussian);
  const double q = records.row("lateral_overlap", 0, 0)[0];
  CHECK(independent_susceptibility(records, "layer_lateral_overlap", 0, 0, 0)[0] ==
        Approx(q * (1 - q) * 200 / 199));
  const MotionRecords alone = sheared(1, 8, 8, 1.1, gaussian);
  CHECK(std::isnan(independent_susceptibility(alone, "layer_overlap", 0, 0, 0)[0]));
}

TEST_CASE("Groups that move together are above the reference of layers") {
  RandomStream random = test_stream(46);
  Moments chi_4, reference;
  for (int e = 0; e < 200; ++e) {
    const MotionRecords records = walks(4, 16, false, 1, random);
    chi_4.add(four_point_susceptibility(records.row("lateral_overlap", 0, 2), n_spheres).value);
    for (const double value : independent_susceptibility(records, "layer_lateral_overlap", 0, 2, 0))
      reference.add(value);
  }
  CHECK(chi_4.mean() > 10 * reference.mean());
}

TEST_CASE("Quantiles of chi2 are those of its tail and of tables") {
  CHECK(chi_squared_quantile(0.95, 1) == Approx(3.841458820694124));
  CHECK(chi_squared_quantile(0.025, 2) == Approx(0.0506356159685798));
  CHECK(chi_squared_quantile(0.975, 19) == Approx(32.8523268616912));
  for (const double p : {0.001, 0.16, 0.5, 0.999})
    for (const double dof : {1.0, 3.0, 50.0})
      CHECK(chi_squared_tail(chi_squared_quantile(p, dof), dof) == Approx(1 - p));
}

TEST_CASE("Intervals of chi_4 hold the truth at their stated rate", "[statistics]") {
  RandomStream random = test_stream(41);
  fmt::print("{:>3} {:>6} {:>5} | {:>7} {:>7} {:>8} {:>9}\n", "M", "group", "stay", "68 %", "95 %",
             "given", "mean/true");
  for (const std::size_t realizations : sizes)
    for (const std::size_t group : {1u, 8u, 32u})
      for (const double p : {0.5, 0.9, 0.98}) {
        Coverage found;
        Moments values;
        const double truth = static_cast<double>(group) * p * (1 - p);
        for (int e = 0; e < ensembles; ++e) {
          const LogEstimate estimate =
              four_point_susceptibility(overlaps(realizations, group, p, random), n_spheres);
          found.add(truth, estimate);
          values.add(estimate.value);
        }
        fmt::print("{:>3} {:>6} {:>5} | {:>6.1f}% {:>6.1f}% {:>7.0f}% {:>9.3f}\n", realizations,
                   group, p, 100 * found.share_68(), 100 * found.share_95(),
                   100.0 * found.n / ensembles, values.mean() / truth);
        CAPTURE(realizations, group, p, found.n);
        CHECK(std::abs(values.mean() - truth) <= 4 * values.standard_error());
        // For sixteen groups Q has few values, and three of them are often equal.
        if (found.n > ensembles / 2) require(found, group < 32);
      }
  std::fflush(stdout);
}

TEST_CASE("Errors of mean squares, overlaps, exponents and ratios hold the truth", "[slow]") {
  RandomStream random = test_stream(42);
  for (const std::size_t realizations : sizes)
    for (const bool mobile : {false, true}) {
      Coverage squares, settling, overlap, exponent, ratio;
      const double square = 2 * 4 * 0.0009 * (mobile ? (13.0 * 81 + 115 * 9) / (128 * 9) : 1);
      const auto stays = [](double step) { return 1 - std::exp(-0.01 / (2 * 4 * step * step)); };
      const double q = mobile ? (13 * stays(0.09) + 115 * stays(0.03)) / 128 : stays(0.03);
      for (int e = 0; e < 300; ++e) {
        const MotionRecords records = walks(realizations, 4, mobile, 0.5, random);
        squares.add(square, mean_estimate(lateral_squares(records, 0, 2)));
        settling.add(0, mean_estimate(records.row("mean_displacement", 0, 2, 2)));
        overlap.add(q, mean_estimate(records.row("lateral_overlap", 0, 2)));
        exponent.add(1, lateral_exponent(records, 0, 1));
        ratio.add(0.5, lateral_ratio(records, 1, 2));
      }
      CAPTURE(realizations, mobile);
      const std::pair<const char*, const Coverage*> all[] = {{"msd", &squares},
                                                             {"settling", &settling},
                                                             {"overlap", &overlap},
                                                             {"exponent", &exponent},
                                                             {"ratio", &ratio}};
      for (const auto& [name, coverage] : all) {
        CAPTURE(name);
        fmt::print("{:>3} {:>6} {:>9} | {:>6.1f}% {:>6.1f}%\n", realizations,
                   mobile ? "mixed" : "alike", name, 100 * coverage->share_68(),
                   100 * coverage->share_95());
        require(*coverage);
      }
    }
  std::fflush(stdout);
}

TEST_CASE("Gaussian motion has no non-Gaussian parameter, motion of two rates has") {
  RandomStream random = test_stream(43);
  Moments alike, mixed, vertical;
  for (int e = 0; e < 40; ++e) {
    alike.add(lateral_non_gaussian(walks(1, 1, false, 1, random), 0, 2).value);
    mixed.add(lateral_non_gaussian(walks(1, 1, true, 1, random), 0, 2).value);
    vertical.add(vertical_non_gaussian(walks(1, 1, true, 1, random), 0, 2).value);
  }
  // One in ten (52 of 512) of 9 times the variance: <v^2> / <v>^2 - 1.
  const double share = 52.0 / n_spheres;
  const double expected = (share * 81 + 1 - share) / std::pow(share * 9 + 1 - share, 2) - 1;
  CHECK(std::abs(alike.mean()) <= 3 * alike.standard_error() + 0.01);
  // For 512 spheres it is some 4 % low: a ratio of means of few fast ones.
  CHECK(mixed.mean() == Approx(expected).epsilon(0.1));
  CHECK(vertical.mean() == Approx(expected).epsilon(0.1));
}

TEST_CASE("Non-Gaussian parameters are ratios of means over spheres and realizations") {
  synthetic::Gaussian gaussian(20261126, 48);
  const MotionRecords records = sheared(3, 60, 2, 1.5, gaussian, 0.8);
  const auto mean = [&](const char* quantity, std::size_t place) {
    return mean_estimate(records.row(quantity, 0, 0, place)).value;
  };
  const double square = mean("square_displacement", 0) + mean("square_displacement", 1);
  const double of_bed = mean("lateral_quartic", 0) / (2 * square * square) - 1;
  CHECK(lateral_non_gaussian(records, 0, 0).value == Approx(of_bed));
  const double of_layer =
      mean("layer_square_displacement", 3) + mean("layer_square_displacement", 4);
  CHECK(layer_lateral_non_gaussian(records, 0, 0, 1).value ==
        Approx(mean("layer_lateral_quartic", 1) / (2 * of_layer * of_layer) * 91 / 90 - 1));
  CHECK(lateral_non_gaussian(records, 0, 0).dof == 2);
  const MeanEstimate alone = lateral_non_gaussian(sheared(1, 60, 1, 1, gaussian), 0, 0);
  CHECK(std::isfinite(alone.value));
  CHECK(std::isnan(alone.error));
}

// The mean over beds of the ratio of each bed is 0 here at any spread: 8 % low, in 0 of 1500 cases.
TEST_CASE("Beds of unlike mobility are one ensemble of displacements", "[statistics]") {
  synthetic::Gaussian gaussian(20261126, 49);
  constexpr double spread = 0.3;
  const double truth = std::exp(spread * spread) - 1;
  for (const std::size_t realizations : {3u, 6u, 18u}) {
    CAPTURE(realizations);
    Moments lateral, vertical;
    Coverage of_lateral, of_vertical;
    for (int e = 0; e < 500; ++e) {
      const MotionRecords records = sheared(realizations, 128, 1, 1, gaussian, spread);
      const MeanEstimate sideways = lateral_non_gaussian(records, 0, 0),
                         upwards = vertical_non_gaussian(records, 0, 0);
      lateral.add(sideways.value);
      vertical.add(upwards.value);
      of_lateral.add(truth, sideways);
      of_vertical.add(truth, upwards);
    }
    for (const Moments* moments : {&lateral, &vertical}) {
      CHECK((moments->mean() + 1) / (truth + 1) >= 0.94);
      CHECK((moments->mean() + 1) / (truth + 1) <= 1.01);
    }
    for (const Coverage* coverage : {&of_lateral, &of_vertical}) {
      fmt::print("{:>3} beds of unlike mobility | {:>6.1f}% {:>6.1f}%\n", realizations,
                 100 * coverage->share_68(), 100 * coverage->share_95());
      CHECK(coverage->share_95() >= 0.80);
    }
  }
  std::fflush(stdout);
}

TEST_CASE("A realization of which nothing is there yet counts for nothing") {
  RandomStream random = test_stream(47);
  const MotionRecords whole = walks(3, 1, false, 1, random);
  MotionRecords begun(whole.settings, n_spheres, 4);  // NaN all over
  const auto widen = [](const std::vector<double>& source, std::vector<double>& widened) {
    REQUIRE(widened.size() == source.size() / 3 * 4);
    for (std::size_t i = 0; i < source.size(); ++i) widened[i / 3 * 4 + i % 3] = source[i];
  };
  for (std::size_t i = 0; i < whole.values.size(); ++i) widen(whole.values[i], begun.values[i]);
  widen(whole.layer_height, begun.layer_height);
  widen(whole.largest_step, begun.largest_step);
  const auto expected = motion_tables("", whole), found = motion_tables("", begun);
  REQUIRE(found.size() == expected.size());
  for (std::size_t t = 0; t < found.size(); ++t) {
    REQUIRE(found[t].quantities.size() == expected[t].quantities.size());
    for (std::size_t q = 0; q < found[t].quantities.size(); ++q) {
      const auto* wanted = std::get_if<std::vector<double>>(&expected[t].quantities[q].values);
      const auto* numbers = std::get_if<std::vector<double>>(&found[t].quantities[q].values);
      if (wanted == nullptr) continue;
      INFO(found[t].name << " " << found[t].quantities[q].name);
      REQUIRE(numbers != nullptr);
      CHECK(std::ranges::equal(*numbers, *wanted, [](double a, double b) {
        return a == b || (std::isnan(a) && std::isnan(b));
      }));
    }
  }
}

TEST_CASE("A missing error stays empty, and a doubtful unwrapping is reported") {
  RandomStream random = test_stream(44);
  const LogEstimate still = four_point_susceptibility(std::vector<double>(8, 1.0), n_spheres);
  CHECK(still.value == 0);
  CHECK(std::isnan(still.low_95));
  CHECK(std::isnan(four_point_susceptibility(std::vector<double>{0.5}, n_spheres).value));
  MotionRecords records = walks(3, 1, false, 1, random);
  CHECK(mean_estimate(std::vector<double>{0.5}).dof == 0);
  CHECK(std::isnan(lateral_exponent(records, 0, 0).value));
  const auto notes = motion_tables("", records).at(0).notes;
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].second.starts_with("over 4 taps msd_lateral from tap 10 is "));
  CHECK(notes[0].second.find(" times that from tap 0 (95 %: ") != std::string::npos);
  CHECK(std::isnan(lateral_ratio(records, 0, 1).value));
  records.largest_step = {0.1, 0.3, 0};
  const Table table = motion_tables("point_0000/motion/", records).at(0);
  CHECK(table.name == "point_0000/motion/displacement");
  REQUIRE(table.notes.size() == 2);
  CHECK(table.notes[1].second.starts_with("doubtful"));
  records.largest_step = {0.1, 0.2, 0};
  CHECK(motion_tables("", records).at(0).notes[1].second.starts_with("sound"));
}
