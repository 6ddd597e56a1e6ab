#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

// The sizes of the spheres of a mixture. A packing without sizes holds equal spheres of diameter 1
// and mass 1, and pays nothing for mixtures.
namespace jostle::inline engine {

/// Diameters of spheres, and the largest over the smallest of a packing.
inline constexpr double least_diameter = 0.2, greatest_diameter = 10, greatest_size_ratio = 10;
/// Densities, relative to that of a sphere of diameter 1 and mass 1.
inline constexpr double least_density = 1e-3, greatest_density = 1e3;

inline constexpr std::size_t longest_kind_name = 40;

/// A kind of spheres: its name, and the density that its spheres share.
struct SphereKind {
  std::string name;
  double density = 1;
  bool operator==(const SphereKind&) const = default;
};

/// Returns why these are not the sizes of a packing, or nothing: each diameter is a finite number
/// in [0.2, 10], the largest at most 10 times the smallest; every sphere has a kind that exists,
/// and every kind a density in [1e-3, 1e3] and a name of its own. `kinds`: [n_spheres], indices of
/// `of_kinds`.
std::optional<std::string> sizes_fault(std::span<const double> diameters,
                                       std::span<const std::uint32_t> kinds,
                                       std::span<const SphereKind> of_kinds);

/// Radius, mass and kind of every sphere: immutable, shared by all copies of a packing.
class Sizes {
 public:
  /// Throws std::invalid_argument with the text of sizes_fault() where there is a fault.
  Sizes(std::span<const double> diameters, std::vector<std::uint32_t> kinds,
        std::vector<SphereKind> of_kinds);
  /// Spheres of one kind, named "spheres", of density 1.
  explicit Sizes(std::span<const double> diameters);

  std::size_t size() const { return radii_.size(); }
  double radius(std::size_t sphere) const { return radii_[sphere]; }
  double diameter(std::size_t sphere) const { return 2 * radii_[sphere]; }
  /// In masses of a sphere of diameter 1 and density 1: density x diameter^3.
  double mass(std::size_t sphere) const { return masses_[sphere]; }
  std::uint32_t kind(std::size_t sphere) const { return kind_of_[sphere]; }

  const std::vector<double>& radii() const { return radii_; }
  const std::vector<double>& masses() const { return masses_; }
  const std::vector<std::uint32_t>& kind_of() const { return kind_of_; }
  const std::vector<SphereKind>& kinds() const { return kinds_; }
  /// 0 without spheres.
  double smallest_radius() const { return smallest_; }
  double largest_radius() const { return largest_; }

  bool operator==(const Sizes&) const = default;

 private:
  std::vector<double> radii_, masses_;  // [n_spheres]
  std::vector<std::uint32_t> kind_of_;  // [n_spheres]
  std::vector<SphereKind> kinds_;
  double smallest_ = 0, largest_ = 0;
};

/// [n_spheres], diameters.
std::vector<double> diameters_of(const Sizes& sizes);

}  // namespace jostle::inline engine
