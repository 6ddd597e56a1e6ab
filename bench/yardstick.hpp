#pragma once

#include <array>
#include <cstdint>
#include <vector>

// The yardstick of the trial loop: a plain loop, kept as it is. Scalar doubles, one Verlet list,
// the lower neighbours first, xoshiro256+ in eight lanes, proposals in batches of 1024, prefetch.
// It shares nothing with the engine, has periodic sides only, and promises no reproducible bits:
// rates of the engine are quoted as ratios to it. Do not improve it.
//
// It stands for a prototype that made 57 million trials/s in a settled tapped bed, 32 in a dense
// disordered state of 0.60, 14 in a fluid of 0.55 and 5 in one of 0.45, on a quiet core. On a busy
// machine of the same kind (AMD EPYC, family 25 model 17) the yardstick made 56, 27 to 29, 12.5 and
// 4 to 4.5 in its own states; sorting all lists gives 9 and 2.2 in the fluids, a skin of 0.65
// diameters 7 and 2. Steps are uniform in a cube of half width 0.1 diameters; where the peer that
// the targets come from accepts 0.40 at 0.45, this is the acceptance of a half width of 0.0775.
namespace jostle::bench {

enum class YardstickMove { polar, metropolis_cold, metropolis_free };

/// True if lists are sorted at a rebuild, which pays in beds and glasses, or only split into near
/// and far, which pays in fluids.
enum class YardstickLists { sorted, split };

class Yardstick {
 public:
  /// Centres [n], diameters; height > 0 makes the box periodic in z as well.
  Yardstick(const std::vector<std::array<double, 3>>& centres, double width_x, double width_y,
            double height, YardstickMove move, double max_step, YardstickLists lists);

  void run(std::uint64_t n_trials);
  double n_spheres() const { return static_cast<double>(position_.size()); }

  std::uint64_t trials = 0, accepted = 0, distance_tests = 0, list_rebuilds = 0;

 private:
  static constexpr int lanes = 8, batch = 1024;
  struct Point {
    double x, y, z, unused;
  };

  double image(double d, int axis) const;
  double wrapped(double x, int axis) const;
  void next(std::array<std::uint64_t, lanes>& numbers);
  void propose();
  void rebuild();
  void sort_into_cells(double reach);
  void append_neighbours(std::uint32_t i, double reach);
  void sort_neighbours(std::uint32_t i);
  void put_near_first(std::uint32_t i);
  bool blocked(std::uint32_t i, const Point& q);

  std::vector<Point> position_, origin_;
  std::array<double, 3> width_;  // 0: not periodic
  YardstickMove move_;
  YardstickLists lists_;
  double max_step_, skin_;
  std::array<std::array<std::uint64_t, lanes>, 4> state_{};
  std::vector<double> theta_;  // quarter turns at equal probabilities
  std::array<std::uint32_t, batch> sphere_{};
  std::array<double, batch> dx_{}, dy_{}, dz_{};
  int used_ = batch;
  std::vector<std::uint32_t> first_, neighbours_;
  std::array<int, 3> cells_{};
  std::array<double, 3> per_length_{};
  std::vector<std::uint32_t> cell_first_, in_cells_;
  std::vector<std::array<int, 3>> cell_of_;
};

}  // namespace jostle::bench
