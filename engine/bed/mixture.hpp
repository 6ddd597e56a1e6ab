#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/bed/container.hpp"
#include "engine/bed/random.hpp"
#include "engine/bed/sizes.hpp"
#include "engine/fields.hpp"

// Kinds of spheres and the laws of their diameters, from which the sizes of a realization are
// drawn.
namespace jostle::inline engine {

/// Laws are cut at so many standard deviations, so that the extremes of a mixture are known.
inline constexpr double cut_of_diameter_laws = 3;

/// Kinds of a mixture, at most.
inline constexpr std::size_t most_kinds = 1000;
/// The diameters that spheres may have.
inline constexpr Number diameter_form{closed_range(least_diameter, greatest_diameter), "diameters"};
/// Standard deviations of diameters.
inline constexpr Number diameter_deviation_form{closed_range(0, greatest_diameter), "diameters"};

/// All spheres of one diameter.
struct FixedDiameter {
  double value = 1;
  bool operator==(const FixedDiameter&) const = default;
};

/// The logarithm of the diameter is normal, cut at 3 standard deviations; mean and deviation are
/// those of the diameter without the cut.
struct LognormalDiameter {
  double mean = 1, deviation = 0.1;
  bool operator==(const LognormalDiameter&) const = default;

  static constexpr Description description{
      "lognormal",
      "The logarithm of the diameter is normal, cut at 3 standard deviations; mean and deviation "
      "are those of the diameter without the cut"};
  template <class Self = LognormalDiameter>
  static constexpr auto fields() {
    return std::tuple{
        field("mean", &Self::mean, diameter_form),
        field("deviation", &Self::deviation, diameter_deviation_form, "Standard deviation")};
  }
};

/// Normal, cut at 3 standard deviations; mean and deviation are those without the cut.
struct NormalDiameter {
  double mean = 1, deviation = 0.1;
  bool operator==(const NormalDiameter&) const = default;

  static constexpr Description description{
      "normal", "Normal, cut at 3 standard deviations; mean and deviation without the cut"};
  template <class Self = NormalDiameter>
  static constexpr auto fields() {
    return std::tuple{
        field("mean", &Self::mean, diameter_form),
        field("deviation", &Self::deviation, diameter_deviation_form, "Standard deviation")};
  }
};

/// Uniform in [from, to].
struct UniformDiameter {
  double smallest = 0.8, largest = 1.2;
  bool operator==(const UniformDiameter&) const = default;

  static constexpr Description description{"uniform", "Uniform between two diameters"};
  template <class Self = UniformDiameter>
  static constexpr auto fields() {
    return std::tuple{field("from", &Self::smallest, diameter_form),
                      field("to", &Self::largest, diameter_form)};
  }
};

/// The diameter of every sphere of the kind, in their order: [count].
struct ListedDiameters {
  std::vector<double> values;
  bool operator==(const ListedDiameters&) const = default;

  static constexpr Description description{
      "list", "The diameter of every sphere of the kind, in their order"};
  template <class Self = ListedDiameters>
  static constexpr auto fields() {
    return std::tuple{
        field("", &Self::values, list_of(diameter_form, 1, most_spheres, "diameters"))};
  }
};

using DiameterLaw = std::variant<FixedDiameter, LognormalDiameter, NormalDiameter, UniformDiameter,
                                 ListedDiameters>;

/// The least and the greatest diameter that a law can give.
struct DiameterRange {
  double least = 0, greatest = 0;
};

/// Requires a law without a fault.
DiameterRange range_of(const DiameterLaw& law);

/// The mean diameter of a law, without its cut. Requires a law without a fault.
double mean_of(const DiameterLaw& law);

/// Returns why the law gives no diameters of `count` spheres, or nothing.
std::optional<std::string> diameter_fault(const DiameterLaw& law, std::uint32_t count);

/// One kind of a mixture.
struct MixtureKind {
  std::string name;
  std::uint32_t count = 0;
  DiameterLaw diameter = FixedDiameter{};
  double density = 1;  // relative
  /// x and y, diameters, above which a single sphere is poured, before all that have no place.
  std::optional<std::array<double, 2>> place = std::nullopt;
  bool operator==(const MixtureKind&) const = default;
};

/// Returns everything that is wrong with a mixture as a whole, where its kinds have no faults:
/// names twice, more spheres than a packing holds, a ratio of diameters above 10.
std::vector<std::string> mixture_faults(const std::vector<MixtureKind>& kinds);

/// The extremes of all kinds. Requires at least one kind.
DiameterRange range_of(const std::vector<MixtureKind>& kinds);

/// Returns why spheres as large do not go into the container, or nothing: periodic widths exceed
/// two diameters of the largest sphere, other widths are at least one.
std::optional<std::string> width_fault(const Container& container, double largest_diameter);

/// Returns why trials do not move spheres as large in the container, or nothing: between walls just
/// as wide as a sphere every trial sideways fails, and the bed seems settled wherever it is.
std::optional<std::string> room_fault(const Container& container, double largest_diameter);

/// All spheres of the kinds.
std::uint64_t n_spheres_of(const std::vector<MixtureKind>& kinds);

/// The kinds with about `share` of their spheres, in (0, 1], at least one of each: listed diameters
/// are thinned evenly.
std::vector<MixtureKind> with_share(std::vector<MixtureKind> kinds, double share);

/// Draws the sizes of a realization: kind by kind in their order, sphere by sphere. Only lognormal,
/// normal and uniform diameters take numbers from the stream. Requires kinds without faults.
std::shared_ptr<const Sizes> draw_sizes(const std::vector<MixtureKind>& kinds,
                                        RandomStream& random);

}  // namespace jostle::inline engine
