#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <variant>
#include <vector>

#include "engine/bed/mixture.hpp"
#include "engine/bed/packing.hpp"
#include "engine/bed/window.hpp"
#include "engine/column.hpp"
#include "engine/fields.hpp"

// Measurements of the packing after every tap. Each observable is a small aggregate; a scene's
// list of them is all that is computed.
namespace jostle::inline structure {

/// <Z>, mean height of the centres, diameters. Philippe & Bideau 2001.
struct MeanHeight {
  bool operator==(const MeanHeight&) const = default;

  static constexpr Description description{
      .name = "mean_height", .text = "<Z>, mean height of the centres, diameters", .symbol = "⟨Z⟩"};
  static constexpr auto fields() { return std::tuple{}; }
};

/// Phi_b, packing fraction between z = 0 and 4 R = 2 diameters. Philippe & Bideau 2001, sec. III.
struct BottomFraction {
  bool operator==(const BottomFraction&) const = default;

  static constexpr Description description{
      .name = "bottom_fraction",
      .text = "Phi_b, packing fraction between the floor and 2 diameters",
      .symbol = "Φ_b"};
  static constexpr auto fields() { return std::tuple{}; }
};

/// <Phi_c>, packing fraction from the floor to h = `depth` x 2<Z> ("approximately 90 %" of the
/// packing, Philippe & Bideau 2001, sec. III; <Z> is that of the same packing, so the window
/// follows the bed as it compacts), with the solid volume between z = 0 and R multiplied by 16/11,
/// the deficit that a plane wall makes: (V(0, h) + 5/11 V(0, R)) / (footprint area x h), V being
/// the volume of spheres between two heights. It corrects for the floor alone, not for the sides.
/// `depth` in (0, 1].
struct CorrectedFraction {
  double depth = 0.9;
  bool operator==(const CorrectedFraction&) const = default;

  static constexpr Description description{
      .name = "corrected_fraction",
      .text = "<Phi_c>, packing fraction up to depth x 2<Z>, corrected at the floor by 16/11",
      .symbol = "⟨Φ_c⟩"};
  template <class Self = CorrectedFraction>
  static constexpr auto fields() {
    return std::tuple{field("depth", &Self::depth, Number{left_open_range(0, 1)})};
  }
};

/// Packing fraction between two heights, or two height quantiles of the starting packing.
/// Rosato et al. 2010 ("bulk solids fraction"). `taper`, diameters, at least 0: over what height
/// its edges rise and fall (tapered_solids_fraction); 0 cuts layers sharply, as the paper.
struct BulkFraction {
  std::string name = "bulk_fraction";
  Window window = QuantileWindow{};
  double taper = 0;
  bool operator==(const BulkFraction&) const = default;

  static constexpr Description description{
      .name = "bulk_fraction", .text = "Packing fraction between two heights or height quantiles"};
  template <class Self = BulkFraction>
  static constexpr auto fields() {
    return std::tuple{
        field(
            "name", &Self::name,
            Text{"a-z", "a-z0-9_", 64,
                 "expected lower-case letters, digits and underscores, a letter first, at most 64 "
                 "of them"}),
        alternative(&Self::window),
        field("taper", &Self::taper, Number{closed_range(0, 10)},
              "Height over which each edge of the window is spread, diameters; 0: sharp edges. "
              "With a "
              "layer spacing, 0.8165, the value of a close-packed bed does not depend on the place "
              "of the edges",
              {.unless_default = true})};
  }
};

/// Share of fcc and hcp spheres in the bulk (bulk_of() in measure.hpp): equal to fcc + hcp of
/// structure's part "order" where no region is set. In [0, 1]; NaN without spheres there.
struct CrystallineFraction {
  bool operator==(const CrystallineFraction&) const = default;

  static constexpr Description description{"crystalline_fraction",
                                           "Fraction of fcc and hcp spheres in the bulk"};
  static constexpr auto fields() { return std::tuple{}; }
};

/// Number of ordered layers from the floor up: structure's `grown_layers`, by the same rule with
/// its default settings (density/layers.hpp).
struct GrownLayers {
  bool operator==(const GrownLayers&) const = default;

  static constexpr Description description{
      "grown_layers", "Ordered layers from the floor up to the first that is not"};
  static constexpr auto fields() { return std::tuple{}; }
};

/// Height of the ordered front, diameters: structure's `ordered_height` (order/ordered_front.hpp).
struct OrderedHeight {
  bool operator==(const OrderedHeight&) const = default;

  static constexpr Description description{
      "ordered_height",
      "Height up to which half of the spheres, layer by layer, are fcc or hcp, diameters"};
  static constexpr auto fields() { return std::tuple{}; }
};

/// The name of a kind of spheres; empty: as the observable chooses.
inline constexpr Text kind_name_form{
    "A-Za-z", "A-Za-z0-9_", longest_kind_name,
    "expected the name of a kind: letters, digits and underscores, a letter first, at most 40 of "
    "them"};

/// Mean height of the spheres of a kind, diameters, each weighted by its volume (kind_height() in
/// mixing.hpp). For a kind of one sphere it is the height of an intruder.
struct KindHeight {
  std::string kind;
  bool operator==(const KindHeight&) const = default;

  static constexpr Description description{
      .name = "kind_height",
      .text =
          "Mean height of the centres of a kind, weighted by volume, diameters. For a kind "
          "of one sphere it is the height of an intruder. Stored as height_KIND"};
  template <class Self = KindHeight>
  static constexpr auto fields() {
    return std::tuple{field("kind", &Self::kind, kind_name_form, "Name of the kind",
                            {.required = "the name of a kind of spheres"})};
  }
};

/// S = 2 (z_L - z_S)/H (segregation() in mixing.hpp). Without names: the kinds of the largest and
/// of the smallest mean diameter.
struct Segregation {
  std::optional<std::string> large = std::nullopt, small = std::nullopt;
  bool operator==(const Segregation&) const = default;

  static constexpr Description description{
      .name = "segregation",
      .text =
          "S = 2 (z_L - z_S)/H of two kinds, H being twice the mean height: 1 where the first "
          "fills the upper half and the second the lower",
      .symbol = "S"};
  template <class Self = Segregation>
  static constexpr auto fields() {
    return std::tuple{field("large", &Self::large, kind_name_form,
                            "Kind L; absent: the one of the largest mean diameter"),
                      field("small", &Self::small, kind_name_form,
                            "Kind S; absent: the one of the smallest mean diameter")};
  }
};

/// Lacey's mixing index of a kind among all others, on cells (lacey_index() in mixing.hpp).
struct LaceyIndex {
  double cell = 3;  // diameters
  std::optional<std::string> kind = std::nullopt;
  bool operator==(const LaceyIndex&) const = default;

  static constexpr Description description{
      .name = "lacey_index",
      .text =
          "Lacey's mixing index on cells: 0 where kinds are apart, 1 on average where spheres "
          "are labelled at random",
      .symbol = "M"};
  template <class Self = LaceyIndex>
  static constexpr auto fields() {
    return std::tuple{
        field("cell", &Self::cell, Number{closed_range(0.5, 1000), "diameters"},
              "Edge of a cell: sides of the container are divided into whole numbers of cells of "
              "about this size"),
        field("kind", &Self::kind, kind_name_form,
              "The kind that is counted; absent: the one of the largest mean diameter")};
  }
};

using Observable =
    std::variant<MeanHeight, BottomFraction, CorrectedFraction, BulkFraction, CrystallineFraction,
                 GrownLayers, OrderedHeight, KindHeight, Segregation, LaceyIndex>;

/// Why it cannot be measured in the container; nothing if it can. All are measured from a floor.
std::optional<std::string> observable_fault(const Observable& observable,
                                            const Container& container);

/// Why it cannot be measured of a mixture of the named kinds; nothing if it can.
std::optional<std::string> mixture_fault(const Observable& observable,
                                         const std::vector<std::string>& kinds);
/// Why it cannot be measured of equal spheres; nothing if it can.
std::optional<std::string> equal_spheres_fault(const Observable& observable);

/// How an observable is stored; its name is also that in scenes.
Column label(const Observable& observable, Spheres spheres = Spheres::equal);

/// The symbol on axes of the observable that is stored under the name; empty where it has none.
std::string_view observable_symbol(std::string_view name);

/// The observables with the kinds that they leave open, chosen by the mean diameters of the laws of
/// a mixture, so that all of its beds have the same kinds: of equal means the first is called
/// largest and the last smallest. Without kinds the same observables.
std::vector<Observable> with_kinds(std::vector<Observable> observables,
                                   const std::vector<MixtureKind>& kinds);

/// The observables of a scene with their windows resolved once, on the starting packing.
class Observer {
 public:
  /// `start` gives the heights of quantile windows, [n_observables] windows in order.
  Observer(const std::vector<Observable>& observables, const Packing& start);
  /// With windows resolved earlier (from a checkpoint), as `windows()` gave them.
  Observer(const std::vector<Observable>& observables, std::vector<HeightWindow> windows);

  /// One value an observable, in order.
  std::vector<double> operator()(const Packing& packing) const;
  const std::vector<HeightWindow>& windows() const { return windows_; }

 private:
  std::vector<Observable> observables_;
  std::vector<HeightWindow> windows_;  // [n_observables]; unused entries are {0, 0}
};

}  // namespace jostle::inline structure
