#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "engine/bed/container.hpp"
#include "engine/monte_carlo/kernel/packed_geometry.hpp"
#include "engine/monte_carlo/rejection_free/rejection_free_kernels.hpp"

namespace jostle::inline engine {

/// The grid on which bounds see the centres: integers modulo 2^32, 2^32 of them across a periodic
/// side. Differences modulo 2^32 then point to the nearest image without a comparison.
class PlaceGrid {
 public:
  template <class Box>
  explicit PlaceGrid(const Box& box)
      : units_{Box::shape().periodic_x ? box.extent().x * 0x1p-32 : open_unit,
               Box::shape().periodic_y ? box.extent().y * 0x1p-32 : open_unit, open_unit} {}

  GridPlace operator()(const PackedCentre& centre) const {
    return {{rounded(centre.xy[0] / units_[0]), rounded(centre.xy[1] / units_[1]),
             rounded(centre.z / units_[2]), 0}};
  }

  /// Diameters along x, y or z: 0, 1, 2.
  double unit(int axis) const { return units_[axis]; }
  double coarsest() const { return *std::ranges::max_element(units_); }

 private:
  // Along a direction that is not periodic: spheres within 32 diameters of each other are
  // distinguished.
  static constexpr double open_unit = 0x1p-26;

  static std::int32_t rounded(double value) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(value)));
  }

  std::array<double, 3> units_;
};

}  // namespace jostle::inline engine
