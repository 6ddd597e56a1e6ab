#pragma once

#include <algorithm>
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
      : unit_{Box::shape().periodic_x ? box.extent().x * 0x1p-32 : open_unit,
              Box::shape().periodic_y ? box.extent().y * 0x1p-32 : open_unit, open_unit} {}

  template <class Spheres>
  GridPlace place(const PackedCentre& centre) const {
    return {rounded(centre.xy[0] / unit_.x), rounded(centre.xy[1] / unit_.y),
            rounded(centre.z / unit_.z),
            Spheres::several ? static_cast<float>(centre.radius) : 0.0f};
  }

  /// Diameters per step of the grid.
  Vec3 unit() const { return unit_; }
  double coarsest() const { return std::max({unit_.x, unit_.y, unit_.z}); }

 private:
  // Along a direction that is not periodic: spheres within 32 diameters of each other are
  // distinguished.
  static constexpr double open_unit = 0x1p-26;

  static std::int32_t rounded(double value) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(value)));
  }

  Vec3 unit_;
};

}  // namespace jostle::inline engine
