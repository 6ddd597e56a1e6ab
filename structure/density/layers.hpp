#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "engine/bed/packing.hpp"
#include "engine/fields.hpp"

// Close-packed layers growing upwards from the floor. Rosato et al. 2010, figs. 6 and 13: n(z)
// (height_histogram) beside the heights of hcp layers. Lengths in diameters.
namespace jostle::inline structure {

/// Height of the centres of layer k = 0, 1, .. of an hcp crystal on the floor, 1/2 + k sqrt(2/3);
/// of layers of an fcc crystal along (111) as well.
double hcp_layer_height(std::size_t k);

/// When a layer counts as grown. Ours: the papers draw layers and do not count them.
struct LayerRule {
  /// Its height is within `tolerance` of the place that the layer below points to, and of the
  /// centres between the mid-planes to the layers below and above at least `least_share` lie within
  /// `tolerance` of that height. Centres at even heights have a share of 0.245.
  double tolerance = 0.1;
  double least_share = 0.6;
  /// And they are at least this part of a close-packed layer on the area that centres can reach:
  /// in narrow containers a layer in the holes of a full one has fewer places. Keeps a partial top
  /// layer out.
  double least_filling = 0.7;
  bool operator==(const LayerRule&) const = default;

  template <class Self = LayerRule>
  static constexpr auto fields() {
    return std::tuple{
        field("tolerance", &Self::tolerance, Number{left_open_range(0, 0.4), "diameters"},
              "Distance of a centre from its layer's height"),
        field("least_share", &Self::least_share, Number{closed_range(0, 1)},
              "Share of a layer's centres within the tolerance"),
        field("least_filling", &Self::least_filling, Number{closed_range(0, 1)},
              "Filling of a full layer")};
  }
};

/// The spheres between two mid-planes. Layers of a bed are closer than those of hcp, as spheres are
/// a little farther apart within them: each is therefore sought from the one found below it.
struct Layer {
  double height = 0;  // height of a layer of hcp
  double found = 0;   // mean height of the centres near the place that the layer below points to
  /// Number of centres between mid-planes over that of a full layer: 2/sqrt(3) per unit of area of
  /// a periodic footprint. Between walls the most places of a close-packed layer with rows along a
  /// wall; in a tube the most over places of its axis in the layer.
  double filling = 0;
  double share = 0;  // share within the tolerance of `found`; 0 without spheres
};

/// The layers from the floor up to the highest centre, at most `most`. Throws std::invalid_argument
/// for a fully periodic box, which has no floor.
std::vector<Layer> layers(const Packing& packing, double tolerance = LayerRule{}.tolerance,
                          std::size_t most = std::numeric_limits<std::size_t>::max());

/// The number of layers grown from the floor: those below the first that the rule refuses.
std::size_t grown_layers(const Packing& packing, const LayerRule& rule = {});

}  // namespace jostle::inline structure
