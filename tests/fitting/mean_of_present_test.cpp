#include "fitting/mean_of_present.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/fitting/noise.hpp"

namespace jostle {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

std::vector<double> taps(std::size_t n) {
  std::vector<double> t;
  for (std::size_t i = 1; i <= n; ++i) t.push_back(static_cast<double>(i));
  return t;
}

// A mean that rises, realizations with offsets, white noise; a share of the values is missing.
std::vector<double> layout(std::size_t n, std::size_t m, double noise_size, double gaps) {
  Noise noise(7);
  std::vector<double> offsets, values;
  for (std::size_t r = 0; r < m; ++r) offsets.push_back(0.01 * noise());
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t r = 0; r < m; ++r) {
      const double value = 0.6 + 1e-3 * static_cast<double>(i) + offsets[r] + noise_size * noise();
      const bool is_missing = r >= 2 && noise.uniform() < gaps;  // two are always there
      values.push_back(is_missing ? missing : value);
    }
  }
  return values;
}

}  // namespace

TEST_CASE("Without gaps the mean of those present is the plain mean, to the bit") {
  const std::vector<double> values = layout(50, 4, 1e-3, 0);
  const Curve plain = mean_curve(taps(50), values, 4),
              present = mean_of_present(taps(50), values, 4);
  CHECK(present.x == plain.x);
  CHECK(present.values == plain.values);
  CHECK(present.present.empty());
  CHECK(with_pooled_errors(present).sigma == with_pooled_errors(plain).sigma);
}

TEST_CASE("A realization that leaves does not move the mean by its offset") {
  // Without noise the mean is that of the complete layout, whatever is missing.
  for (const double gaps : {0.1, 0.5}) {
    const Curve whole = mean_curve(taps(200), layout(200, 5, 0, 0), 5);
    const Curve found = mean_of_present(taps(200), layout(200, 5, 0, gaps), 5);
    double plain_error = 0;
    const std::vector<double> values = layout(200, 5, 0, gaps);
    for (std::size_t i = 0; i < 200; ++i) {
      CHECK(found.x[i] == Approx(whole.x[i]).epsilon(1e-12));
      double sum = 0, n = 0;
      for (std::size_t r = 0; r < 5; ++r) {
        if (std::isnan(values[i * 5 + r])) continue;
        sum += values[i * 5 + r];
        ++n;
      }
      plain_error = std::max(plain_error, std::abs(sum / n - whole.x[i]));
    }
    CHECK(plain_error > 1e-4);  // error of a plain mean: the case would detect it
  }
}

TEST_CASE("Drop-out: late means keep the level of all realizations") {
  std::vector<double> values = layout(100, 4, 0, 0);
  const Curve whole = mean_curve(taps(100), values, 4);
  for (std::size_t i = 60; i < 100; ++i) values[i * 4] = values[i * 4 + 3] = missing;
  const Curve found = mean_of_present(taps(100), values, 4);
  for (std::size_t i = 0; i < 100; ++i) CHECK(found.x[i] == Approx(whole.x[i]).epsilon(1e-12));
  CHECK(found.n_realizations == 4);
}

TEST_CASE("Pseudo-values scatter as the mean is uncertain: 400 layouts with gaps") {
  // Offsets and noise drawn anew each time; the same values are missing.
  constexpr std::size_t n = 12, m = 5;
  constexpr int layouts = 400;
  std::vector<double> squares(n, 0), predicted(n, 0);
  Noise noise(11);
  for (int k = 0; k < layouts; ++k) {
    std::vector<double> offsets(m), values;
    for (double& offset : offsets) offset = noise();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t r = 0; r < m; ++r) {
        const double value = offsets[r] + 2 * noise();
        values.push_back((i >= 6 && r >= 3) || (i == 2 && r < 2) ? missing : value);
      }
    }
    const Curve curve = mean_of_present(taps(n), values, m);
    for (std::size_t i = 0; i < n; ++i) {
      squares[i] += curve.x[i] * curve.x[i] / layouts;
      for (std::size_t r = 0; r < m; ++r) {
        predicted[i] +=
            std::pow(curve.values[i * m + r] - curve.x[i], 2) / (m * (m - 1.0) * layouts);
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    CAPTURE(i);
    // The variance of 400 squares has a relative error of sqrt(2/400); 4 of them. Leaving out one
    // of k present among m counts white noise up to k (m - 1)/(m (k - 1)) times.
    const double margin = 4 * std::sqrt(2.0 / layouts);
    const double k = i >= 6 || i == 2 ? 3 : 5, most = k * (m - 1.0) / (m * (k - 1));
    CHECK(predicted[i] / squares[i] >= 1 - margin);
    CHECK(predicted[i] / squares[i] <= most * (1 + margin));
  }
}

TEST_CASE("Pseudo-values are changes of the mean where a realization is left out") {
  constexpr std::size_t n = 40, m = 5;
  const std::vector<double> values = layout(n, m, 5e-3, 0.4);
  const Curve all = mean_of_present(taps(n), values, m);
  std::vector<std::vector<double>> changes(n);
  for (std::size_t r = 0; r < m; ++r) {
    std::vector<double> remaining;
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (k % m != r) remaining.push_back(values[k]);
    }
    const Curve reduced = mean_of_present(taps(n), remaining, m - 1);
    for (std::size_t i = 0; i < n; ++i) changes[i].push_back((m - 1.0) * (all.x[i] - reduced.x[i]));
  }
  for (std::size_t i = 0; i < n; ++i) {
    double mean = 0;
    for (const double change : changes[i]) mean += change / m;
    for (std::size_t r = 0; r < m; ++r) {
      const double deviation = all.values[i * m + r] - all.x[i];
      CHECK(deviation == Approx(changes[i][r] - mean).margin(1e-14).epsilon(1e-9));
    }
  }
}

TEST_CASE("Pseudo-values are finite where one realization alone links two others") {
  // Without the middle one the offset between the others would be anything.
  std::vector<double> values = layout(60, 3, 1e-3, 0);
  for (std::size_t i = 0; i < 60; ++i) values[i * 3 + (i < 30 ? 2 : 0)] = missing;
  const Curve curve = mean_of_present(taps(60), values, 3);
  for (std::size_t i = 30; i < 60; ++i) values[i * 3 + 2] += 5;
  const Curve shifted = mean_of_present(taps(60), values, 3);
  const auto offset = [](const Curve& curve_of_means, std::size_t r) {
    return curve_of_means.offsets[r];
  };
  CHECK(offset(shifted, 2) - offset(shifted, 1) == Approx(offset(curve, 2) - offset(curve, 1) + 5));
  // The level moves by a third of the shift, and so does the share of the third realization.
  CHECK(shifted.x[5] - curve.x[5] == Approx(5 / 3.0));
  for (std::size_t i = 0; i < 60; ++i) {
    CHECK(shifted.values[i * 3 + 2] - shifted.x[i] - (curve.values[i * 3 + 2] - curve.x[i]) ==
          Approx(10 / 3.0).epsilon(1e-6));
  }
}

TEST_CASE("Errors of means grow where realizations are missing") {
  std::vector<double> values = layout(100, 4, 1e-3, 0);
  for (std::size_t i = 60; i < 100; ++i) values[i * 4 + 2] = values[i * 4 + 3] = missing;
  const Curve curve = with_pooled_errors(mean_of_present(taps(100), values, 4));
  REQUIRE(curve.sigma.size() == 100);
  CHECK(curve.sigma[80] / curve.sigma[10] == Approx(std::sqrt(2.0)));
  const Curve late = restricted(curve, 61, 100);
  CHECK(late.present.size() == 40 * 4);
  CHECK(late.offsets == curve.offsets);
}

TEST_CASE("Realizations without a common t are in groups of their own") {
  const std::vector<double> separated = {1, 2, missing, missing, missing, missing, 3, 4};
  const auto groups = linked_groups(separated, 4);
  REQUIRE(groups.size() == 2);
  CHECK(groups[0] == std::vector<std::size_t>{0, 1});
  CHECK(groups[1] == std::vector<std::size_t>{2, 3});
  CHECK(linked_groups({1, 2, missing, missing, 3, 4}, 3).size() == 1);
}

}  // namespace jostle
