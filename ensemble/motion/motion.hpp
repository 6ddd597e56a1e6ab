#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/bed/packing.hpp"
#include "engine/bed/vec3.hpp"

// How far spheres move over many taps, measured while they are tapped: reference positions at a few
// taps, unwrapped through periodic sides, and sums over spheres at a few lags after each. No
// positions are kept of other taps.
namespace jostle::inline ensemble {

/// Limits of an analysis of motion.
inline constexpr std::size_t most_motion_taps = 1000, most_overlap_lengths = 20;
inline constexpr std::uint32_t most_motion_layers = 1000;
inline constexpr std::uint64_t most_motion_bytes = std::uint64_t{1} << 30;    // a realization
inline constexpr std::uint64_t most_motion_numbers = std::uint64_t{1} << 27;  // a sweep point

/// Settings of the followed motion.
struct MotionSettings {
  std::vector<std::uint64_t> origins;   // waiting times t_W, ascending; tap 0 is the start
  std::vector<std::uint64_t> lags;      // taps, ascending, at least 1
  std::vector<double> overlap_lengths;  // a, diameters, ascending, above 0
  std::uint32_t layers = 0;  // layers of equal numbers of spheres, by their height at the origin
  std::uint32_t kinds = 0;   // kinds of a mixture; 0: not followed by kind
  bool operator==(const MotionSettings&) const = default;
};

/// Axes of a quantity.
enum class MotionPlaces {
  none,
  directions,
  overlap_lengths,
  layers,
  layer_directions,
  layer_overlap_lengths,
  kind_directions
};

/// An average over the spheres of a bed, or of a layer, of their displacements r(t_W + t) - r(t_W).
struct MotionQuantity {
  const char* name;
  MotionPlaces places;
  const char *units, *long_name, *source;
};
inline constexpr MotionQuantity motion_quantities[] = {
    {"mean_displacement", MotionPlaces::directions, "diameter",
     "mean displacement over the lag along x, y, z", ""},
    {"square_displacement", MotionPlaces::directions, "diameter^2",
     "mean square displacement over the lag along x, y, z", ""},
    {"lateral_quartic", MotionPlaces::none, "diameter^4",
     "mean fourth power of the lateral displacement", ""},
    {"vertical_quartic", MotionPlaces::none, "diameter^4",
     "mean fourth power of the vertical displacement about its mean", ""},
    {"lateral_overlap", MotionPlaces::overlap_lengths, "1",
     "fraction of spheres that moved less than overlap_length sideways",
     "after Dauchot et al. 2005, Keys et al. 2007"},
    {"overlap", MotionPlaces::overlap_lengths, "1",
     "fraction of spheres that moved less than overlap_length",
     "after Dauchot et al. 2005, Keys et al. 2007"},
    {"layer_settling", MotionPlaces::layers, "diameter",
     "mean vertical displacement of the layer over the lag", ""},
    {"layer_square_displacement", MotionPlaces::layer_directions, "diameter^2",
     "mean square displacement of the layer over the lag along x, y, z", ""},
    {"layer_lateral_quartic", MotionPlaces::layers, "diameter^4",
     "mean fourth power of the lateral displacement of the layer", ""},
    {"layer_vertical_quartic", MotionPlaces::layers, "diameter^4",
     "mean fourth power of the vertical displacement of the layer about its mean", ""},
    {"layer_lateral_overlap", MotionPlaces::layer_overlap_lengths, "1",
     "fraction of spheres of the layer that moved less than overlap_length sideways", ""},
    {"layer_overlap", MotionPlaces::layer_overlap_lengths, "1",
     "fraction of spheres of the layer that moved less than overlap_length", ""},
    {"kind_mean_displacement", MotionPlaces::kind_directions, "diameter",
     "mean displacement of the kind over the lag along x, y, z", ""},
    {"kind_square_displacement", MotionPlaces::kind_directions, "diameter^2",
     "mean square displacement of the kind over the lag along x, y, z", ""}};

/// Values of a quantity at one origin and lag.
std::size_t n_places(MotionPlaces places, const MotionSettings& settings);
/// Concatenates all quantities.
std::size_t n_motion_values(const MotionSettings& settings);
/// Lags of an origin that the first `rows` taps, the start included, have reached.
std::size_t lags_reached(const MotionSettings& settings, std::uint64_t origin, std::uint64_t rows);
/// Bytes held for one realization that has passed every origin and lag.
std::uint64_t motion_bytes(const MotionSettings& settings, std::uint64_t n_spheres);

/// Numbers stored of so many realizations.
std::uint64_t motion_numbers(const MotionSettings& settings, std::uint64_t realizations);

/// A reference: the bed at an origin, and what was measured since.
struct MotionOrigin {
  std::uint64_t tap = 0;
  std::vector<Vec3> centres;   // [n_spheres], unwrapped
  std::vector<double> values;  // [lags reached, n_motion_values]
  bool operator==(const MotionOrigin&) const = default;
};

/// State needed to resume following, with its results.
struct MotionState {
  std::vector<Vec3> unwrapped;  // [n_spheres], at the last recorded tap
  /// The largest step of a sphere in one tap along a periodic direction, in periods. A step of more
  /// than 1/2 is taken for a shorter one the other way: where this is well below 1/2, none was.
  double largest_step = 0;
  std::vector<MotionOrigin> origins;  // those passed
  bool operator==(const MotionState&) const = default;
};

/// Takes in the bed at rest after `tap`, which follows on the last one; tap 0 begins. An origin at
/// the tap before that is missing begins there.
void follow_motion(const MotionSettings& settings, const Packing& bed, std::uint64_t tap,
                   MotionState& state);

/// Heights in the container of unwrapped centres: within its period where it is periodic in z.
std::vector<double> heights_of(std::span<const Vec3> centres, const Container& container);

/// For every sphere the layer, 0 the lowest, by its height: ranks r of n spheres with
/// floor(r n_layers / n) equal make a layer. Equal heights are ranked by their numbers.
std::vector<std::uint32_t> layers_of(std::span<const double> heights, std::uint32_t n_layers);

/// Spheres of each layer of n: [n_layers].
std::vector<std::uint64_t> layer_sizes(std::uint64_t n_spheres, std::uint32_t n_layers);

/// Averages over spheres at one origin and lag: [n_motion_values]. `layers` of the reference;
/// `kinds` of the spheres, [n_spheres] where the settings have kinds. NaN of a kind without
/// spheres.
std::vector<double> motion_values(const MotionSettings& settings, std::span<const Vec3> reference,
                                  std::span<const Vec3> now, std::span<const std::uint32_t> layers,
                                  std::span<const std::uint32_t> kinds = {});

}  // namespace jostle::inline ensemble
