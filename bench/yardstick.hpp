#pragma once

#include <array>
#include <cstdint>
#include <vector>

// The yardstick of the trial loop: a plain loop, kept as it is. Scalar doubles, one Verlet list,
// the lower neighbours first, xoshiro256+ in eight lanes, proposals in batches of 1024, prefetch.
// It shares nothing with the engine, has periodic sides only, and promises no reproducible bits:
// rates of the engine are quoted as ratios to it. Do not improve it.
namespace jostle::bench {

enum class YardstickMove { polar, metropolis_cold, metropolis_free };

class Yardstick {
 public:
  /// Centres [n], diameters; height > 0 makes the box periodic in z as well.
  Yardstick(const std::vector<std::array<double, 3>>& centres, double width_x, double width_y,
            double height, YardstickMove move, double max_step);

  void run(std::uint64_t n_trials);

  std::uint64_t trials = 0, accepted = 0, distance_tests = 0, list_rebuilds = 0;

 private:
  static constexpr int lanes = 8, batch = 1024;
  struct Point {
    double x, y, z, unused;
  };

  double image(double d, int axis) const;
  double wrapped(double x, int axis) const;
  void next(std::array<std::uint64_t, lanes>& out);
  void propose();
  void rebuild();
  bool blocked(std::uint32_t i, const Point& q);

  std::vector<Point> at_, origin_;
  std::array<double, 3> width_;  // 0: not periodic
  YardstickMove move_;
  double max_step_, skin_;
  std::array<std::array<std::uint64_t, lanes>, 4> state_{};
  std::vector<double> theta_;  // quarter turns at equal probabilities
  std::array<std::uint32_t, batch> sphere_{};
  std::array<double, batch> dx_{}, dy_{}, dz_{};
  int used_ = batch;
  std::vector<std::uint32_t> first_, neighbours_;
};

}  // namespace jostle::bench
