#include "engine/monte_carlo/kernel/proposals.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <vector>

#include "engine/bed/philox.hpp"
#include "engine/monte_carlo/theta_table.hpp"
#include "engine/monte_carlo/trial_loop.hpp"

using namespace jostle;

namespace {

constexpr std::uint64_t key = 0x0123456789abcdef;

// Sample mean and its standard error.
struct Mean {
  double n = 0, sum = 0, squares = 0;
  void add(double x) { n += 1, sum += x, squares += x * x; }
  double value() const { return sum / n; }
  double error() const { return std::sqrt((squares / n - value() * value()) / (n - 1)); }
};

void check_mean(const Mean& mean, double exact) {
  CHECK(std::abs(mean.value() - exact) < 3 * mean.error());
}

}  // namespace

TEST_CASE("the moments of the polar move are those of the law without sin(theta)") {
  // Integrals over the density in theta itself, done independently to 16 digits; max_step = 1.
  struct Row {
    double theta0, drift, msd_per_axis, variance_z;
  };
  const auto row = GENERATE(
      Row{std::numbers::pi / 4, -0.4309363602087049, 0.037796788441003516, 0.07203360990139962},
      Row{std::numbers::pi / 8, -0.48109029327252645, 0.011909180031303276, 0.07806710298968128},
      Row{std::numbers::pi / 2, -0.35962918233038443, 0.06766758904051194, 0.06866500646868856});
  const auto table = make_theta_table({1, row.theta0});
  const auto kernels = baseline::proposal_kernels();
  auto batch = std::make_unique<ProposalBatch>();
  Mean dz, squared_z, squared_x, squared_y, dx;
  for (std::uint64_t first = 0; first < 1'000'000; first += ProposalBatch::size) {
    kernels.polar({key, first, 10}, table.data(), 1.0, *batch);
    for (std::uint32_t t = 0; t < ProposalBatch::size; ++t) {
      REQUIRE(batch->dz[t] <= 0);
      dz.add(batch->dz[t]);
      squared_z.add((batch->dz[t] - row.drift) * (batch->dz[t] - row.drift));
      dx.add(batch->dx[t]);
      squared_x.add(batch->dx[t] * batch->dx[t]);
      squared_y.add(batch->dy[t] * batch->dy[t]);
    }
  }
  check_mean(dz, row.drift);
  check_mean(squared_z, row.variance_z);
  check_mean(dx, 0);
  check_mean(squared_x, row.msd_per_axis);
  check_mean(squared_y, row.msd_per_axis);
}

TEST_CASE("the components of the Metropolis move are uniform in (-1, 1)") {
  const auto kernels = baseline::proposal_kernels();
  auto batch = std::make_unique<ProposalBatch>();
  Mean x, xx, y, z, zz, xz;
  std::vector<int> chosen(10, 0);
  for (std::uint64_t first = 0; first < 1'000'000; first += ProposalBatch::size) {
    kernels.metropolis({key, first, 10}, *batch);
    for (std::uint32_t t = 0; t < ProposalBatch::size; ++t) {
      x.add(batch->dx[t]);
      xx.add(batch->dx[t] * batch->dx[t]);
      y.add(batch->dy[t]);
      z.add(batch->dz[t]);
      zz.add(batch->dz[t] * batch->dz[t]);
      xz.add(batch->dx[t] * batch->dz[t]);
      ++chosen.at(batch->sphere[t]);
    }
  }
  for (const Mean& mean : {x, y, z, xz}) check_mean(mean, 0);
  for (const Mean& mean : {xx, zz}) check_mean(mean, 1.0 / 3);
  // Chi-square with 9 degrees of freedom: beyond 27.9 once in a thousand times.
  double chi_square = 0;
  for (const int count : chosen) chi_square += (count - x.n / 10) * (count - x.n / 10) / (x.n / 10);
  CHECK(chi_square < 27.9);
}

TEST_CASE("a batch is made of the blocks of its stream") {
  const auto kernels = baseline::proposal_kernels();
  auto batch = std::make_unique<ProposalBatch>();
  const std::uint64_t first = (std::uint64_t{3} << 32) - ProposalBatch::size;
  kernels.metropolis({key, first, 4096}, *batch);
  for (std::uint32_t t = 0; t < ProposalBatch::size; ++t) {
    const auto words = philox_block(StreamKey{key}, first + t);
    CHECK(batch->sphere[t] == (std::uint64_t{words[0]} * 4096) >> 32);
    CHECK(batch->dx[t] == 1 - 2 * ((words[1] + 0.5) * 0x1p-32));
    CHECK(batch->dy[t] == 1 - 2 * ((words[2] + 0.5) * 0x1p-32));
    CHECK(batch->dz[t] == 1 - 2 * ((words[3] + 0.5) * 0x1p-32));
  }
}

TEST_CASE("every instruction set proposes the same bits") {
  const auto table = make_theta_table({});
  const auto compare = [&](const ProposalKernels& kernels) {
    auto own = std::make_unique<ProposalBatch>(), second = std::make_unique<ProposalBatch>();
    for (std::uint64_t first = 0; first < 200'000; first += ProposalBatch::size) {
      baseline::proposal_kernels().polar({key, first, 1000}, table.data(), 0.1, *own);
      kernels.polar({key, first, 1000}, table.data(), 0.1, *second);
      REQUIRE(std::memcmp(own.get(), second.get(), sizeof(ProposalBatch)) == 0);
      baseline::proposal_kernels().metropolis({key, first, 1000}, *own);
      kernels.metropolis({key, first, 1000}, *second);
      REQUIRE(std::memcmp(own.get(), second.get(), sizeof(ProposalBatch)) == 0);
    }
  };
  for (const InstructionSet set : instruction_sets()) compare(proposal_kernels_for(set));
}
