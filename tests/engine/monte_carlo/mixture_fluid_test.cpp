#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "engine/bed/cells/sized_grid.hpp"
#include "engine/bed/geometry.hpp"
#include "engine/monte_carlo/trial_loop.hpp"
#include "engine/starts/starts.hpp"
#include "tests/engine/monte_carlo/contact_value.hpp"

// Hard-sphere fluids of two sizes, as many spheres of diameter 1 as of diameter `ratio`.
using namespace jostle;

namespace {

constexpr double bin_width = 0.005;  // bin width of the sum of radii

// Pairs of small spheres, of unlike ones, of large ones.
using Trio = std::array<double, 3>;

// Boublik, J. Chem. Phys. 53, 471 (1970); Grundke & Henderson, Mol. Phys. 24, 269 (1972); Lee &
// Levesque, Mol. Phys. 26, 1351 (1973): pair distributions at contact.
Trio contact_values_of_theory(double ratio, double fraction) {
  const double d2 = 1 + ratio * ratio, d3 = 1 + ratio * ratio * ratio;
  const double x3 = fraction, x2 = fraction * d2 / d3;
  const auto g = [&](double a) {
    const double free = 1 - x3;
    return 1 / free + 3 * x2 * a / (free * free) + 2 * x2 * x2 * a * a / (free * free * free);
  };
  return {g(0.5), g(ratio / (1 + ratio)), g(0.5 * ratio)};
}

using Counts = std::array<std::array<double, n_contact_bins>, 3>;

// Counts of pairs per bin, in so many configurations, become values at contact.
Trio at_contact(Counts counts, int configurations, double ratio, std::uint32_t n_of_each,
                double volume) {
  Trio values;
  const double n = n_of_each;
  for (int kinds = 0; kinds < 3; ++kinds) {
    const double touching = kinds == 0 ? 1 : kinds == 1 ? 0.5 * (1 + ratio) : ratio;
    const double pairs = kinds == 1 ? n * n : 0.5 * n * (n - 1);
    for (int bin = 0; bin < n_contact_bins; ++bin) {
      const double low = 1 + bin * bin_width;
      const double shell = touching * touching * touching * shell_volume(low, low + bin_width);
      counts[kinds][bin] /= configurations * pairs * shell / volume;
    }
    values[kinds] = extrapolated_to_contact(counts[kinds]);
  }
  return values;
}

class TwoSizeFluid {
 public:
  TwoSizeFluid(double ratio, double fraction, std::uint32_t n_of_each, std::uint64_t seed)
      : ratio_(ratio), n_(n_of_each) {
    std::vector<double> diameters(n_of_each, 1.0);
    diameters.insert(diameters.end(), n_of_each, ratio);
    StartSpheres spheres{2 * n_of_each, std::make_shared<const Sizes>(diameters)};
    const double cubes = n_of_each * (1 + ratio * ratio * ratio);
    const double side = std::cbrt(cubes * sphere_volume / fraction);
    volume_ = side * side * side;
    RandomStream random(stream_key(seed, 0, 0, Purpose::start));
    packing_ = make_start(Grow{}, FullyPeriodicBox{side, side, side}, spheres, random);
    loop_ = make_trial_loop(packing_.container, MetropolisMove{0.3},
                            stream_key(seed, 0, 0, Purpose::trials), best_instruction_set(),
                            Sampler::exhaustive, SphereSizes::several);
    loop_->load(packing_);
  }

  void run(std::uint64_t sweeps) { loop_->run(2 * n_ * sweeps); }

  // Averages over configurations `every` sweeps apart.
  Trio contact_values(int configurations, std::uint64_t every) {
    Counts counts{};
    for (int k = 0; k < configurations; ++k) {
      run(every);
      loop_->store(packing_);
      count_pairs(counts);
    }
    return at_contact(counts, configurations, ratio_, n_, volume_);
  }

  const Packing& packing() const { return packing_; }

 private:
  void count_pairs(Counts& counts) const {
    const auto& box = std::get<FullyPeriodicBox>(packing_.container);
    SizedGrid grid;
    grid.build(
        Boundary(packing_.container), n_contact_bins * bin_width * ratio_, 2 * n_,
        [&](std::uint32_t i) { return packing_.centres[i]; },
        [&](std::uint32_t i) { return packing_.radius(i); });
    for (std::uint32_t i = 0; i < 2 * n_; ++i) {
      grid.for_each_near(packing_.centres[i], packing_.radius(i), [&](std::uint32_t j) {
        if (j <= i) return;
        const double touching = packing_.radius(i) + packing_.radius(j);
        const double r =
            std::sqrt(norm_squared(separation(box, packing_.centres[i], packing_.centres[j])));
        const auto bin = static_cast<int>((r / touching - 1) / bin_width);
        if (bin < n_contact_bins) ++counts[(i >= n_) + (j >= n_)][bin];
      });
    }
  }

  double ratio_, volume_ = 0;
  std::uint32_t n_;
  Packing packing_;
  std::unique_ptr<TrialLoop> loop_;
};

// The brute-force twin: its own numbers and steps, and every trial looks at all spheres.
class AllPairsFluid {
 public:
  AllPairsFluid(const Packing& begin, double ratio, std::uint32_t n_of_each)
      : ratio_(ratio), n_(n_of_each), centres_(begin.centres) {
    side_ = std::get<FullyPeriodicBox>(begin.container).width_x;
  }

  void run(std::uint64_t sweeps) {
    for (std::uint64_t trial = 0; trial < 2 * n_ * sweeps; ++trial) {
      const auto i = static_cast<std::uint32_t>(numbers_() % (2 * n_));
      const Vec3 end = centres_[i] + 0.6 * Vec3{step(), step(), step()};
      if (is_free(i, end)) centres_[i] = end;
    }
  }

  Trio contact_values(int configurations, std::uint64_t every) {
    Counts counts{};
    for (int k = 0; k < configurations; ++k) {
      run(every);
      for (std::uint32_t i = 0; i < 2 * n_; ++i) {
        for (std::uint32_t j = 0; j < i; ++j) {
          const double far = std::sqrt(squared(centres_[i], centres_[j])) / touching(i, j) - 1;
          if (far < n_contact_bins * bin_width)
            ++counts[(i >= n_) + (j >= n_)][static_cast<int>(far / bin_width)];
        }
      }
    }
    return at_contact(counts, configurations, ratio_, n_, side_ * side_ * side_);
  }

 private:
  double step() { return std::uniform_real_distribution<double>(-0.5, 0.5)(numbers_); }
  double touching(std::uint32_t i, std::uint32_t j) const {
    return 0.5 * ((i < n_ ? 1 : ratio_) + (j < n_ ? 1 : ratio_));
  }
  double squared(Vec3 a, Vec3 b) const {
    Vec3 way = a - b;
    for (double* longitudinal : {&way.x, &way.y, &way.z})
      *longitudinal -= side_ * std::rint(*longitudinal / side_);
    return norm_squared(way);
  }
  bool is_free(std::uint32_t i, Vec3 end) const {
    for (std::uint32_t j = 0; j < 2 * n_; ++j) {
      const double least = touching(i, j);
      if (j != i && squared(end, centres_[j]) < least * least) return false;
    }
    return true;
  }

  double ratio_, side_ = 0;
  std::uint32_t n_;
  std::vector<Vec3> centres_;
  std::mt19937_64 numbers_{2026};
};

struct Estimate {
  Trio value{}, error{};
};

template <class Fluid>
Estimate measure(Fluid& fluid, int configurations) {
  constexpr int blocks = 20;
  constexpr std::uint64_t every = 3;
  fluid.run(every * configurations / 4);  // equilibration
  Trio sum{}, squares{};
  for (int block = 0; block < blocks; ++block) {
    const Trio g = fluid.contact_values(configurations / blocks, every);
    for (int k = 0; k < 3; ++k) {
      sum[k] += g[k];
      squares[k] += g[k] * g[k];
    }
  }
  Estimate all;
  for (int k = 0; k < 3; ++k) {
    all.value[k] = sum[k] / blocks;
    all.error[k] = std::sqrt((squares[k] / blocks - all.value[k] * all.value[k]) / (blocks - 1));
  }
  return all;
}

// `most_error`: relative.
void check_fluid(double ratio, double fraction, std::uint32_t n_of_each, int configurations,
                 double most_error) {
  TwoSizeFluid fluid(ratio, fraction, n_of_each, 1970);
  const Estimate own = measure(fluid, configurations);
  const Trio theory = contact_values_of_theory(ratio, fraction);
  for (int k = 0; k < 3; ++k) {
    CAPTURE(ratio, fraction, k, own.value[k], own.error[k], theory[k]);
    if (most_error > 0.01) {
      CHECK(own.error[k] < most_error * theory[k]);
    } else {
      WARN("ratio " << ratio << ", fraction " << fraction << ", pairs " << k << ": g(contact) "
                    << own.value[k] << " +- " << own.error[k] << ", theory " << theory[k]);
    }
    // The theory of large pairs is 1.1 % low at ratio 3 and 0.30: 2.592(4) by a program that looks
    // at all pairs, for 2.563. These are left to the twin.
    const bool left_to_twin = ratio == 3 && fraction == 0.30 && k == 2 && most_error <= 0.01;
    if (fraction <= 0.30 && !left_to_twin)
      CHECK(std::abs(own.value[k] - theory[k]) <= std::max(3 * own.error[k], 0.01 * theory[k]));
  }
}

// Within three standard errors of the difference, none of which is above `most_error` of its value.
void check_against_twin(double ratio, double fraction, std::uint32_t n_of_each, int configurations,
                        double most_error) {
  TwoSizeFluid fluid(ratio, fraction, n_of_each, 1970);
  AllPairsFluid twin(fluid.packing(), ratio, n_of_each);
  const Estimate own = measure(fluid, configurations), second = measure(twin, configurations);
  for (int k = 0; k < 3; ++k) {
    const double error = std::hypot(own.error[k], second.error[k]);
    CAPTURE(ratio, fraction, k, own.value[k], own.error[k], second.value[k], second.error[k]);
    CHECK(error < most_error * second.value[k]);
    CHECK(std::abs(own.value[k] - second.value[k]) <= 3 * error);
  }
}

}  // namespace

TEST_CASE("the theory of mixtures has its published form") {
  const Trio near = contact_values_of_theory(1.4, 0.45), far = contact_values_of_theory(3, 0.45);
  CHECK(near[0] == Approx(3.963).margin(6e-4));
  CHECK(near[1] == Approx(4.394).margin(6e-4));
  CHECK(near[2] == Approx(5.034).margin(6e-4));
  CHECK(far[0] == Approx(2.693).margin(6e-4));
  CHECK(far[1] == Approx(3.188).margin(6e-4));
  CHECK(far[2] == Approx(4.908).margin(6e-4));
  // Equal spheres have those of Carnahan & Starling, (1 - x/2) / (1 - x)^3.
  for (const double value : contact_values_of_theory(1, 0.3))
    CHECK(value == Approx(0.85 / 0.343).epsilon(1e-12));
}

TEST_CASE("a fluid of two sizes has the contact values of theory") {
  check_fluid(1.4, 0.30, 200, 1000, 0.05);
  check_fluid(3, 0.30, 200, 1000, 0.12);
}

TEST_CASE("a fluid of two sizes has the contact values of a twin that looks at all pairs") {
  check_against_twin(1.4, 0.30, 60, 2000, 0.10);
  check_against_twin(3, 0.30, 60, 2000, 0.15);
}

TEST_CASE("fluids of two sizes have the contact values of a twin in long runs", "[nightly]") {
  check_against_twin(3, 0.30, 200, 20'000, 0.03);
}

TEST_CASE("fluids of two sizes have the contact values of theory, to one in a hundred",
          "[nightly]") {
  for (const double ratio : {1.4, 3.0}) {
    for (const double fraction : {0.10, 0.20, 0.30, 0.45})
      check_fluid(ratio, fraction, 500, 40'000, 0.01);
  }
}
