#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"
#include "engine/fields.hpp"

// How the packing begins, tap 0. Lengths in diameters.
namespace jostle::inline engine {

/// The order in which the spheres of a mixture are poured. Their numbers are those of the list of
/// kinds whatever the order.
enum class PourOrder { random, as_listed, large_first, small_first };
inline constexpr NameTable<PourOrder, 4> pour_orders{{{"random", PourOrder::random},
                                                      {"as_listed", PourOrder::as_listed},
                                                      {"large_first", PourOrder::large_first},
                                                      {"small_first", PourOrder::small_first}}};

/// A sphere that is poured before all that have no place, from above (x, y).
struct PlacedSphere {
  std::uint32_t sphere = 0;
  double x = 0, y = 0;  // diameters
  bool operator==(const PlacedSphere&) const = default;
};

/// The spheres that a start places: `n` of diameter 1, or those of `sizes`.
struct StartSpheres {
  std::uint32_t n = 0;
  std::shared_ptr<const Sizes> sizes = nullptr;  // null: equal spheres; else of n spheres
  PourOrder order = PourOrder::random;           // order of spheres with sizes
  std::vector<PlacedSphere> placed{};            // in the order in which they are poured
};

/// A start that cannot fit; what() gives the fault, the reason and what to do.
class StartError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A start that was stopped under way: its work is lost.
class StartStopped : public std::exception {
 public:
  const char* what() const noexcept override { return "the start was stopped"; }
};

/// True if a start under way is to stop; empty: never.
using StopAsked = std::function<bool()>;

/// Arguments of a start: spheres, container, random numbers.
struct Placing {
  const Container& container;
  const StartSpheres& spheres;
  RandomStream& random;
  const StopAsked& stop;
  Packing* before_fitting = nullptr;  // receives what was poured before a fitting
};

// A start has, beside its fields: its name where a mixture is refused (`of_equal_spheres`, null
// where it places several sizes), whether spheres may move before tap 0 (`may_move`), the reason
// why a container does not suit it, and place(), which places the spheres. place() throws
// StartError and StartStopped as make_start does. make_start has checked the start, the container
// and the number of spheres before.

/// Spheres one by one from a random (x, y): each falls, rolls along the steepest descent and stops
/// on three supports or on the floor. Philippe & Bideau 2001, sec. II. Poured directly into the
/// container, whatever its sides. Spheres of a mixture roll on one another in the same way.
struct SteepestDescentPour {
  bool operator==(const SteepestDescentPour&) const = default;

  static constexpr const char* of_equal_spheres = nullptr;
  static constexpr bool may_move = false;
  std::optional<std::string> container_fault(const Container& container) const;
  std::vector<Vec3> place(const Placing& placing) const;

  static constexpr Description description{"steepest_descent"};
  static constexpr auto fields() { return std::tuple{}; }
};

/// The route of Philippe & Bideau 2001 to a walled box: a steepest-descent pour with periodic
/// sides, fitted between walls. The paper gives no details. Here the spheres that overlap a wall
/// are taken out and poured again by the same steepest descent, between the walls and onto the
/// others, in the order in which they were poured: so lower spheres remain lower. No other
/// sphere moves, to the bit, not even one that has lost a support. Spheres that touched through a
/// seam no longer meet. Other containers and widths of 2 diameters or less are an error.
struct FittedPour {
  bool operator==(const FittedPour&) const = default;

  static constexpr const char* of_equal_spheres = "a fitted pour";
  static constexpr bool may_move = true;
  std::optional<std::string> container_fault(const Container& container) const;
  std::vector<Vec3> place(const Placing& placing) const;

  static constexpr Description description{"fitted"};
  static constexpr auto fields() { return std::tuple{}; }
};

/// Packing fraction up to which random places that do not overlap are found one after another: such
/// beds jam at 0.384 (random sequential addition; Zhang & Torquato 2013).
inline constexpr double densest_dilution = 0.36;
inline constexpr double highest_drop = 1000;  // diameters

/// Non-overlapping random positions at the given packing fraction, of a mixture the largest spheres
/// first, then a relaxation without a tap (the scene's own). Rosato et al. 2010, sec. II.
struct RandomSettle {
  double dilute_fraction = 0.1;  // at most densest_dilution
  double drop_height = 0;        // drop height of the column's foot above the floor, diameters
  bool operator==(const RandomSettle&) const = default;

  static constexpr const char* of_equal_spheres = nullptr;
  static constexpr bool may_move = true;
  std::optional<std::string> container_fault(const Container& container) const;
  std::vector<Vec3> place(const Placing& placing) const;

  static constexpr Description description{
      "random_settle", "Random positions in a tall dilute box, then a relaxation without a tap",
      "Random settle"};
  template <class Self = RandomSettle>
  static constexpr auto fields() {
    return std::tuple{
        field("dilute_fraction", &Self::dilute_fraction,
              Number{left_open_range(0, densest_dilution)}, "Packing fraction of the dilute box"),
        field("drop_height", &Self::drop_height, Number{closed_range(0, highest_drop), "diameters"},
              "Height of the dilute box's foot above the floor", {.unless_default = true})};
  }
};

enum class Lattice { hcp, fcc };
inline constexpr NameTable<Lattice, 2> lattices{{{"hcp", Lattice::hcp}, {"fcc", Lattice::fcc}}};

/// A close-packed crystal on the floor, filled layer by layer and row by row from below. hcp:
/// layers parallel to the floor at z = 1/2 + k sqrt(2/3), footprint n x m sqrt(3)/2 with m even.
/// fcc: (100) layers at z = 1/2 + k / sqrt(2), footprint n x m. Any other footprint (too large by
/// more than 1e-9 of it, or too small by more than rounding) is an error that names the two
/// nearest, unless `stretch`, which spaces the rows out to the footprint; the layers then sink
/// until they touch. In a fully periodic box the height must be a whole even number of layers as
/// well. Between walls and in a tube the perfect lattice loses the sites that do not fit: no
/// footprint is refused, and `stretch` is an error. Rosato et al. 2010, sec. II.
struct Crystal {
  Lattice lattice = Lattice::hcp;
  bool stretch = false;
  bool operator==(const Crystal&) const = default;

  static constexpr const char* of_equal_spheres = "a crystal";
  static constexpr bool may_move = false;
  std::optional<std::string> container_fault(const Container& container) const;
  std::vector<Vec3> place(const Placing& placing) const;

  static constexpr Description description{
      "crystal",
      "A close-packed crystal, filled layer by layer from the floor; between walls and in a "
      "cylinder without the sites that do not fit",
      "Crystal"};
  template <class Self = Crystal>
  static constexpr auto fields() {
    return std::tuple{field("lattice", &Self::lattice, word(lattices),
                            "hcp: layers parallel to the floor. fcc: on its (100) face",
                            {.required = "one of the strings hcp, fcc"}),
                      field("stretch", &Self::stretch, Flag{},
                            "Stretch the lattice where a periodic footprint is not commensurate")};
  }
};

/// Sweeps of a growth, at most.
inline constexpr std::uint64_t most_growth_sweeps = 1'000'000'000;
/// Spheres that grow without order jam beyond this packing fraction.
inline constexpr double densest_growth = 0.64;

/// Random points whose diameters grow by Monte Carlo, those of a mixture each by a factor of its
/// own, within 5 %, until the spheres fill the fully periodic box; at most packing fraction 0.64.
/// From 0.61 on it grows slowly and may leave a residue after `max_sweeps`, an error.
struct Grow {
  std::uint64_t max_sweeps = 1'000'000;
  bool operator==(const Grow&) const = default;

  static constexpr const char* of_equal_spheres = nullptr;
  static constexpr bool may_move = false;
  std::optional<std::string> container_fault(const Container& container) const;
  std::vector<Vec3> place(const Placing& placing) const;

  static constexpr Description description{
      "grow", "Random points that grow to spheres; fully_periodic containers only", "Grow"};
  template <class Self = Grow>
  static constexpr auto fields() {
    return std::tuple{field("max_sweeps", &Self::max_sweeps, Whole{1, most_growth_sweeps},
                            "Sweeps of the growth, at most")};
  }
};

/// A packing read from a file: [n_spheres] centres, brought into the box where it is periodic.
/// Overlaps beyond overlap_bound and `most_overlap`, with each other or the container, are an
/// error.
struct GivenPacking {
  std::shared_ptr<const std::vector<Vec3>> centres;
  double most_overlap = 0;                       // diameters; above 0 for discrete elements alone
  std::shared_ptr<const Sizes> sizes = nullptr;  // null: all of diameter 1
  bool operator==(const GivenPacking&) const = default;

  static constexpr const char* of_equal_spheres = nullptr;
  static constexpr bool may_move = false;
  std::optional<std::string> container_fault(const Container& container) const;
  std::vector<Vec3> place(const Placing& placing) const;
};

using Start =
    std::variant<SteepestDescentPour, FittedPour, RandomSettle, Crystal, Grow, GivenPacking>;

/// Packings of discrete elements may be given with such overlaps: deeper ones end a tap.
inline constexpr double deepest_given_overlap = 0.1;

/// Returns the numbers of the spheres in the order in which they are poured, [n]: placed ones
/// first, then the others in their order; of equal diameters the lower number first. Equal spheres
/// are poured as they are numbered. Only PourOrder::random takes numbers from the stream.
std::vector<std::uint32_t> pour_sequence(const StartSpheres& spheres, RandomStream& random);

/// Returns why the start cannot place spheres of several sizes, or nothing.
std::optional<std::string> mixture_fault(const Start& start);

/// Why the container, however many spheres it is to hold, cannot be filled in this way; nothing if
/// it can. Without floor and gravity only growth, a crystal and a given packing do; growth does
/// nowhere else; a fitted pour needs walls more than 2 diameters apart; rows are stretched to a
/// period only.
std::optional<std::string> start_fault(const Start& start, const Container& container);

/// Why so many spheres cannot start so in the container; nothing if they may. `solid_volume`, in
/// diameters cubed, is that of a mixture.
std::optional<std::string> n_spheres_fault(const Start& start, const Container& container,
                                           std::uint32_t n_spheres,
                                           std::optional<double> solid_volume = std::nullopt);

/// Why it makes no sense to relax this start before tap 0: it is at rest. Nothing if it may move.
std::optional<std::string> settling_fault(const Start& start);

/// Builds the starting packing, before any relaxation. Throws StartError where the start does not
/// suit the container or the spheres do not fit, and StartStopped soon after `stop` returns true,
/// within a sweep or the pour of a sphere; never hangs. A fitted pour leaves in `before_fitting`,
/// where given, what was poured with periodic sides.
Packing make_start(const Start& start, const Container& container, std::uint32_t n_spheres,
                   RandomStream& random, const StopAsked& stop = {},
                   Packing* before_fitting = nullptr);
/// Makes a start of spheres of several sizes, which the packing then has. A given packing must have
/// the same sizes.
Packing make_start(const Start& start, const Container& container, const StartSpheres& spheres,
                   RandomStream& random, const StopAsked& stop = {},
                   Packing* before_fitting = nullptr);

}  // namespace jostle::inline engine
