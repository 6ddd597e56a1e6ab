#include "engine/bed/mixture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>
#include <utility>

#include "engine/bed/boundary.hpp"
#include "engine/bed/elementary.hpp"

namespace jostle::inline engine {

namespace {

using Fault = std::optional<std::string>;

std::string diameter_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string diameter_bounds() {
  return "diameters must lie between " + diameter_text(least_diameter) + " and " +
         diameter_text(greatest_diameter);
}

/// exp(x) for |x| < 700, by the function for x <= 0.
double portable_exponential(double x) {
  return x <= 0 ? exponential(x) : 1 / exponential(-x);
}

/// Mean and standard deviation of the logarithm of a lognormal diameter.
struct LogarithmOfDiameter {
  double mean, deviation;

  explicit LogarithmOfDiameter(const LognormalDiameter& law) {
    const double relative = law.deviation / law.mean;
    const double variance = natural_log(1 + relative * relative);
    mean = natural_log(law.mean) - 0.5 * variance;
    deviation = std::sqrt(variance);
  }
};

/// Standard normal, cut: by Marsaglia's polar method (Marsaglia & Bray, SIAM Rev. 6, 260, 1964),
/// one number of a pair, drawn anew beyond the cut.
double cut_normal(RandomStream& random) {
  for (;;) {
    const double x = 2 * random.uniform() - 1, y = 2 * random.uniform() - 1;
    const double squared = x * x + y * y;
    if (squared >= 1 || squared < 1e-300) continue;
    const double normal = x * std::sqrt(-2 * natural_log(squared) / squared);
    if (std::abs(normal) <= cut_of_diameter_laws) return normal;
  }
}

struct RangeOf {
  DiameterRange operator()(const FixedDiameter& law) const { return {law.value, law.value}; }
  DiameterRange operator()(const LognormalDiameter& law) const {
    const LogarithmOfDiameter log(law);
    const double reach = cut_of_diameter_laws * log.deviation;
    return {portable_exponential(log.mean - reach), portable_exponential(log.mean + reach)};
  }
  DiameterRange operator()(const NormalDiameter& law) const {
    const double reach = cut_of_diameter_laws * law.deviation;
    return {law.mean - reach, law.mean + reach};
  }
  DiameterRange operator()(const UniformDiameter& law) const { return {law.smallest, law.largest}; }
  DiameterRange operator()(const ListedDiameters& law) const {
    const auto [least, greatest] = std::ranges::minmax_element(law.values);
    return {*least, *greatest};
  }
};

struct Draw {
  RandomStream& random;
  std::size_t place;  // place of the sphere in its kind

  double operator()(const FixedDiameter& law) const { return law.value; }
  double operator()(const LognormalDiameter& law) const {
    const LogarithmOfDiameter log(law);
    return portable_exponential(log.mean + log.deviation * cut_normal(random));
  }
  double operator()(const NormalDiameter& law) const {
    return law.mean + law.deviation * cut_normal(random);
  }
  double operator()(const UniformDiameter& law) const {
    return law.smallest + (law.largest - law.smallest) * random.uniform();
  }
  double operator()(const ListedDiameters& law) const { return law.values[place]; }
};

Fault spread_fault(double mean, double deviation) {
  if (!(mean > 0) || !std::isfinite(mean))
    return "the mean diameter is " + diameter_text(mean) + ": it must be a positive number";
  if (!(deviation >= 0) || !std::isfinite(deviation))
    return "the standard deviation is " + diameter_text(deviation) +
           ": it must be a number from 0 on";
  return std::nullopt;
}

/// Finds faults of the numbers of a law, apart from the diameters that they give.
struct NumbersFault {
  std::uint32_t count;

  Fault operator()(const FixedDiameter&) const { return std::nullopt; }
  Fault operator()(const LognormalDiameter& law) const {
    return spread_fault(law.mean, law.deviation);
  }
  Fault operator()(const NormalDiameter& law) const {
    return spread_fault(law.mean, law.deviation);
  }
  Fault operator()(const UniformDiameter& law) const {
    if (law.smallest <= law.largest) return std::nullopt;
    return "diameters from " + diameter_text(law.smallest) + " to " + diameter_text(law.largest) +
           " are given: the first must not exceed the second";
  }
  Fault operator()(const ListedDiameters& law) const {
    if (law.values.size() != count || count == 0)
      return std::to_string(law.values.size()) + " diameters are listed for " +
             std::to_string(count) + " spheres: list one per sphere";
    for (const double value : law.values)
      if (std::isnan(value)) return "a listed diameter is not a number";
    return std::nullopt;
  }
};

struct MeanOf {
  double operator()(const FixedDiameter& law) const { return law.value; }
  double operator()(const LognormalDiameter& law) const { return law.mean; }
  double operator()(const NormalDiameter& law) const { return law.mean; }
  double operator()(const UniformDiameter& law) const { return 0.5 * (law.smallest + law.largest); }
  double operator()(const ListedDiameters& law) const {
    double sum = 0;
    for (const double diameter : law.values) sum += diameter;
    return sum / static_cast<double>(law.values.size());
  }
};

}  // namespace

DiameterRange range_of(const DiameterLaw& law) {
  return std::visit(RangeOf{}, law);
}

double mean_of(const DiameterLaw& law) {
  return std::visit(MeanOf{}, law);
}

std::optional<std::string> diameter_fault(const DiameterLaw& law, std::uint32_t count) {
  if (auto fault = std::visit(NumbersFault{count}, law)) return fault;
  const DiameterRange range = range_of(law);
  if (range.least >= least_diameter && range.greatest <= greatest_diameter) return std::nullopt;
  if (range.least == range.greatest)
    return "the diameter is " + diameter_text(range.least) + ": " + diameter_bounds();
  return "diameters from " + diameter_text(range.least) + " to " + diameter_text(range.greatest) +
         " are possible: " + diameter_bounds() +
         "; choose a narrower law (lognormal and normal ones are cut at 3 standard deviations)";
}

DiameterRange range_of(const std::vector<MixtureKind>& kinds) {
  DiameterRange all = range_of(kinds.front().diameter);
  for (const MixtureKind& kind : kinds) {
    const DiameterRange range = range_of(kind.diameter);
    all = {std::min(all.least, range.least), std::max(all.greatest, range.greatest)};
  }
  return all;
}

std::vector<std::string> mixture_faults(const std::vector<MixtureKind>& kinds) {
  if (kinds.empty()) return {"no kind of spheres is given: give at least one"};
  std::vector<std::string> faults;
  std::set<std::string> names;
  const std::uint64_t spheres = n_spheres_of(kinds);
  for (const MixtureKind& kind : kinds) {
    if (!names.insert(kind.name).second)
      faults.push_back("two kinds are named \"" + kind.name + "\": give each a name of its own");
  }
  if (spheres > most_spheres)
    faults.push_back("the kinds have " + std::to_string(spheres) + " spheres: a packing holds at " +
                     "most " + std::to_string(most_spheres));
  const DiameterRange range = range_of(kinds);
  // The extremes of a law are computed: a ratio of 10 may exceed 10 by rounding.
  constexpr double rounding = 1e-12;
  if (range.greatest > greatest_size_ratio * range.least * (1 + rounding))
    faults.push_back("diameters from " + diameter_text(range.least) + " to " +
                     diameter_text(range.greatest) + " are possible: the largest must not exceed " +
                     diameter_text(greatest_size_ratio) + " times the smallest");
  return faults;
}

std::optional<std::string> width_fault(const Container& container, double largest_diameter) {
  const Boundary boundary(container);
  const char* const sides =
      std::holds_alternative<Cylinder>(container) ? "cylinder diameter" : "width between walls";
  const auto narrow = [&](bool periodic, const char* side_name, double width) -> Fault {
    const double least = periodic ? 2 * largest_diameter : largest_diameter;
    if (periodic ? width > least : width >= least) return std::nullopt;
    return std::string(side_name) + " is " + diameter_text(width) + " diameters: with spheres of " +
           diameter_text(largest_diameter) + " it must " + (periodic ? "exceed " : "be at least ") +
           diameter_text(least);
  };
  for (const auto& [periodic, width] : {std::pair(boundary.periodic_x, boundary.width_x),
                                        std::pair(boundary.periodic_y, boundary.width_y)})
    if (auto fault = narrow(periodic, periodic ? "periodic width" : sides, width)) return fault;
  return boundary.periodic_z ? narrow(true, "periodic height", boundary.height) : std::nullopt;
}

std::optional<std::string> room_fault(const Container& container, double largest_diameter) {
  const Boundary boundary(container);
  double least = std::numeric_limits<double>::infinity();
  if (!boundary.periodic_x) least = std::min(least, boundary.width_x);
  if (!boundary.periodic_y) least = std::min(least, boundary.width_y);
  if (least > largest_diameter) return std::nullopt;
  return "spheres of diameter " + diameter_text(largest_diameter) +
         " fill the width between the sides: every trial sideways fails, and nothing settles. Make "
         "the container wider, by 0.001 diameters or more, or use discrete elements";
}

std::uint64_t n_spheres_of(const std::vector<MixtureKind>& kinds) {
  std::uint64_t n = 0;
  for (const MixtureKind& kind : kinds) n += kind.count;
  return n;
}

std::vector<MixtureKind> with_share(std::vector<MixtureKind> kinds, double share) {
  for (MixtureKind& kind : kinds) {
    const std::uint32_t all = kind.count;
    kind.count = std::max(1u, static_cast<std::uint32_t>(std::lround(share * all)));
    auto* listed = std::get_if<ListedDiameters>(&kind.diameter);
    if (listed == nullptr) continue;
    std::vector<double> thinned;
    for (std::uint64_t i = 0; i < kind.count; ++i)
      thinned.push_back(listed->values[(2 * i + 1) * all / (2 * std::uint64_t{kind.count})]);
    listed->values = std::move(thinned);
  }
  return kinds;
}

std::shared_ptr<const Sizes> draw_sizes(const std::vector<MixtureKind>& kinds,
                                        RandomStream& random) {
  std::vector<double> diameters;
  std::vector<std::uint32_t> kind_of;
  std::vector<SphereKind> of_kinds;
  for (std::uint32_t k = 0; k < kinds.size(); ++k) {
    of_kinds.push_back({kinds[k].name, kinds[k].density});
    const DiameterRange range = range_of(kinds[k].diameter);
    for (std::size_t i = 0; i < kinds[k].count; ++i) {
      const double drawn = std::visit(Draw{random, i}, kinds[k].diameter);
      // Rounding alone could leave the range, against which widths and steps were checked.
      diameters.push_back(std::clamp(drawn, range.least, range.greatest));
      kind_of.push_back(k);
    }
  }
  return std::make_shared<const Sizes>(diameters, std::move(kind_of), std::move(of_kinds));
}

}  // namespace jostle::inline engine
