#include "engine/monte_carlo/theta_table.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "engine/bed/random.hpp"
#include "engine/monte_carlo/kernel/proposals.hpp"

using namespace jostle;

namespace {

constexpr double pi = std::numbers::pi;

// Exact cumulative probability of the law truncated to [0, pi/2].
double cumulative(const PolarMove& move, double theta) {
  const auto unnormalised = [&](double t) {
    const double x = t / move.theta0;
    switch (move.law) {
      case ThetaLaw::gaussian:
        return std::erf(x);
      case ThetaLaw::exponential:
        return -std::expm1(-x);
      case ThetaLaw::linear:
        return x < 1 ? x - x * x / 2 : 0.5;
    }
    return 0.0;
  };
  return unnormalised(theta) / unnormalised(pi / 2);
}

std::vector<double> sample_thetas(const PolarMove& move, std::size_t n) {
  const auto table = make_theta_table(move);
  const auto kernels = baseline::proposal_kernels();
  auto batch = std::make_unique<ProposalBatch>();
  std::vector<double> thetas;
  const auto key = static_cast<std::uint64_t>(stream_key(5, 0, 0, Purpose::trials));
  for (std::uint64_t first = 0; thetas.size() < n; first += ProposalBatch::size) {
    kernels.polar({key, first, 1}, table.data(), move.max_step, *batch);
    for (std::uint32_t t = 0; t < ProposalBatch::size; ++t) {
      const double sideways = std::hypot(batch->dx[t], batch->dy[t]);
      thetas.push_back(std::atan2(sideways, -batch->dz[t]));
    }
  }
  return thetas;
}

}  // namespace

TEST_CASE("the angle follows its law (Kolmogorov-Smirnov)") {
  const PolarMove move = GENERATE(
      PolarMove{0.1, pi / 4, ThetaLaw::gaussian}, PolarMove{0.1, pi / 8, ThetaLaw::gaussian},
      PolarMove{0.1, 1e-3, ThetaLaw::gaussian}, PolarMove{0.1, 1e3, ThetaLaw::gaussian},
      PolarMove{0.1, pi / 4, ThetaLaw::exponential}, PolarMove{0.1, 1e-3, ThetaLaw::exponential},
      PolarMove{0.1, pi / 4, ThetaLaw::linear}, PolarMove{0.1, 3, ThetaLaw::linear});
  CAPTURE(move.theta0, static_cast<int>(move.law));
  auto thetas = sample_thetas(move, 1 << 19);
  std::ranges::sort(thetas);
  const auto n = static_cast<double>(thetas.size());
  double distance = 0;
  for (std::size_t k = 0; k < thetas.size(); ++k) {
    const double exact = cumulative(move, thetas[k]);
    distance = std::max({distance, exact - k / n, (k + 1) / n - exact});
  }
  // 1.95 / sqrt(n): the distance that a true sample exceeds once in a thousand times.
  CHECK(distance < 1.95 / std::sqrt(n));
}

TEST_CASE("the table's law differs from the exact one by less than 1e-5") {
  for (const ThetaLaw law : {ThetaLaw::gaussian, ThetaLaw::exponential, ThetaLaw::linear}) {
    for (const double theta0 : {1e-3, 0.1, pi / 4, 3.0, 1e3}) {
      const PolarMove move{0.1, theta0, law};
      const auto table = make_theta_table(move);
      CHECK(std::ranges::is_sorted(table, std::greater{}));
      double worst = 0;
      for (int node = 0; node + 1 < theta_table::size; ++node) {
        const double v0 = std::ldexp(1 + (node % 256) / 256.0, node / 256 - theta_table::octaves);
        const double v1 =
            std::ldexp(1 + ((node + 1) % 256) / 256.0, (node + 1) / 256 - theta_table::octaves);
        for (const double part : {0.0, 0.25, 0.5, 0.75}) {
          const double theta = 2 * (table[node] + part * (table[node + 1] - table[node]));
          worst = std::max(worst, std::abs(1 - cumulative(move, theta) - (v0 + part * (v1 - v0))));
        }
      }
      CAPTURE(theta0, static_cast<int>(law));
      CHECK(worst < 1e-5);
    }
  }
}
