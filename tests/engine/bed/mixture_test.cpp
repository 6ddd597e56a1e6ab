#include "engine/bed/mixture.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace jostle;
using Catch::Matchers::Contains;

namespace {

struct Moments {
  double mean = 0, deviation = 0;
};

Moments moments_of(const DiameterLaw& law, std::uint32_t count) {
  RandomStream random(stream_key(11, 0, 0, Purpose::sizes));
  const auto sizes = draw_sizes({{"a", count, law}}, random);
  const DiameterRange range = range_of(law);
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double d = sizes->diameter(i);
    REQUIRE(d >= range.least);
    REQUIRE(d <= range.greatest);
    sum += d;
    squares += d * d;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(squares / count - mean * mean)};
}

}  // namespace

TEST_CASE("diameters follow their law") {
  constexpr std::uint32_t n = 40'000;
  // Four standard errors; the cut at 3 deviations narrows a normal law to 0.98658 of its deviation.
  const double tolerance = 4 * 0.1 / std::sqrt(double{n});
  for (const DiameterLaw& law :
       {DiameterLaw{NormalDiameter{1, 0.1}}, DiameterLaw{LognormalDiameter{1, 0.1}}}) {
    const Moments drawn = moments_of(law, n);
    CHECK(drawn.mean == Approx(1).margin(tolerance));
    CHECK(drawn.deviation == Approx(0.0987).margin(tolerance));
  }
  const Moments uniform = moments_of(UniformDiameter{0.5, 1.5}, n);
  CHECK(uniform.mean == Approx(1).margin(4 * 0.289 / std::sqrt(double{n})));
  CHECK(uniform.deviation == Approx(1 / std::sqrt(12.0)).margin(tolerance));
  const Moments fixed = moments_of(FixedDiameter{1.4}, 3);
  CHECK(fixed.mean == Approx(1.4).epsilon(1e-15));
}

TEST_CASE("the logarithm of a lognormal diameter is symmetric about its median") {
  const LognormalDiameter law{1, 0.4};
  const DiameterRange range = range_of(law);
  const double median = 1 / std::sqrt(1 + 0.16);
  CHECK(range.least * range.greatest == Approx(median * median).epsilon(1e-14));
  CHECK(range.greatest == Approx(median * std::exp(3 * std::sqrt(std::log(1.16)))).epsilon(1e-14));
  RandomStream random(stream_key(12, 0, 0, Purpose::sizes));
  const auto sizes = draw_sizes({{"a", 10'000, law}}, random);
  int n_below = 0;
  for (std::size_t i = 0; i < sizes->size(); ++i) n_below += sizes->diameter(i) < median;
  CHECK(n_below == Approx(5000).margin(4 * 50));
}

TEST_CASE("kinds are drawn in their order, the same from the same stream") {
  const std::vector<MixtureKind> kinds{{"large", 2, FixedDiameter{3}, 2},
                                       {"listed", 3, ListedDiameters{{1, 0.5, 2}}},
                                       {"spread", 4, NormalDiameter{1, 0.1}}};
  RandomStream first(stream_key(13, 0, 4, Purpose::sizes));
  RandomStream repeated(stream_key(13, 0, 4, Purpose::sizes));
  RandomStream second(stream_key(13, 0, 5, Purpose::sizes));
  const auto sizes = draw_sizes(kinds, first);
  REQUIRE(sizes->size() == 9);
  CHECK(sizes->diameter(0) == 3);
  CHECK(sizes->mass(1) == 54);
  CHECK(sizes->diameter(3) == 0.5);
  CHECK(sizes->diameter(4) == 2);
  CHECK(sizes->kind_of() == std::vector<std::uint32_t>{0, 0, 1, 1, 1, 2, 2, 2, 2});
  CHECK(sizes->kinds() == std::vector<SphereKind>{{"large", 2}, {"listed", 1}, {"spread", 1}});
  CHECK(*draw_sizes(kinds, repeated) == *sizes);
  CHECK_FALSE(*draw_sizes(kinds, second) == *sizes);
}

TEST_CASE("laws that leave the range of diameters are rejected") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto fault = [](const DiameterLaw& law, std::uint32_t count = 2) {
    return diameter_fault(law, count).value_or("none");
  };
  CHECK(fault(FixedDiameter{0.2}) == "none");
  CHECK(fault(FixedDiameter{10}) == "none");
  CHECK(fault(FixedDiameter{0.19}) ==
        "the diameter is 0.19: diameters must lie between 0.2 and 10");
  CHECK(fault(FixedDiameter{nan}) != "none");
  CHECK(fault(NormalDiameter{1, 0.26}) == "none");
  CHECK_THAT(fault(NormalDiameter{1, 0.27}), Contains("diameters from 0.19 to 1.81 are possible"));
  CHECK_THAT(fault(NormalDiameter{1, -0.1}), Contains("standard deviation is -0.1"));
  CHECK_THAT(fault(LognormalDiameter{-1, 0.1}), Contains("mean diameter is -1"));
  CHECK(fault(LognormalDiameter{nan, 0.1}) != "none");
  CHECK(fault(LognormalDiameter{1, nan}) != "none");
  CHECK(fault(LognormalDiameter{1, 3}) != "none");
  CHECK_THAT(fault(UniformDiameter{2, 1}), Contains("first must not exceed"));
  CHECK(fault(UniformDiameter{nan, 1}) != "none");
  CHECK_THAT(fault(ListedDiameters{{1}}), Contains("1 diameters are listed for 2 spheres"));
  CHECK(fault(ListedDiameters{{1, nan}}) != "none");
  CHECK(fault(ListedDiameters{{1, 11}}) != "none");
}

TEST_CASE("all faults of a mixture are found at once") {
  CHECK(mixture_faults({{"a", 1}, {"b", 1, FixedDiameter{2}}}).empty());
  CHECK(mixture_faults({}).size() == 1);
  const auto faults =
      mixture_faults({{"a", most_spheres, FixedDiameter{0.5}}, {"a", 1, UniformDiameter{1, 5.1}}});
  REQUIRE(faults.size() == 3);
  CHECK_THAT(faults[0], Contains("two kinds are named \"a\""));
  CHECK_THAT(faults[1], Contains("at most"));
  CHECK_THAT(faults[2], Contains("10 times the smallest"));
  // Extremes that a law computes to rounding.
  CHECK(mixture_faults({{"a", 1, UniformDiameter{0.7, 7}}}).empty());
}

TEST_CASE("the largest spheres decide on the least widths") {
  CHECK(width_fault(PeriodicBox{6, 9}, 3).value() ==
        "periodic width is 6 diameters: with spheres of 3 it must exceed 6");
  CHECK_FALSE(width_fault(PeriodicBox{6.01, 9}, 3));
  CHECK(width_fault(PeriodicBox{9, 6}, 3));
  CHECK(width_fault(WalledBox{9, 2.9}, 3));
  CHECK_FALSE(width_fault(WalledBox{3, 3}, 3));
  CHECK(width_fault(Cylinder{2.9}, 3));
  CHECK_FALSE(width_fault(Cylinder{3}, 3));
  CHECK_THAT(width_fault(FullyPeriodicBox{9, 9, 6}, 3).value(), Contains("periodic height"));
}
