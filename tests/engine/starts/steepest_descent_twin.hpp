#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/bed/boundary.hpp"
#include "engine/bed/geometry.hpp"
#include "engine/bed/packing.hpp"

// The steepest descent of one sphere among others of any size, by brute force: constraints g(p) >=
// 0 of all spheres (all images), sides and the floor; at each step the weight is projected on the
// motions that they leave open, a step is taken along it and brought back to the active constraints
// by Newton's method, and events are found by bisection. No cells, no circles, no formula of the
// engine.
namespace jostle {

class SteepestDescentTwin {
 public:
  SteepestDescentTwin(const Packing& bed, double radius) : boundary_(bed.container) {
    const Vec3 periods = boundary_.periods();
    for (std::size_t k = 0; k < bed.centres.size(); ++k) {
      for (int i = -1; i <= 1; ++i) {
        for (int j = -1; j <= 1; ++j) {
          if ((i != 0 && periods.x == 0) || (j != 0 && periods.y == 0)) continue;
          const Vec3 shift = {i * periods.x, j * periods.y, 0};
          balls_.push_back({bed.centres[k] + shift, radius + bed.radius(k)});
        }
      }
    }
    for (const Face& face : Faces(boundary_)) faces_.push_back(face);
    radius_ = radius;
  }

  /// Where a centre that falls from p, outside everything, comes to rest; nothing if it meets an
  /// exact balance, from which it may tip to either side.
  std::optional<Vec3> rest(Vec3 p) const {
    for (;;) {
      if (p.z <= radius_ + 1e-9) return into_periods(boundary_, {p.x, p.y, radius_});
      std::vector<std::size_t> touched;
      double room = 0.05;
      for (std::size_t c = 0; c < size(); ++c) {
        const double free = gap(c, p);
        if (free < contact) touched.push_back(c);
        room = std::min(room, free);
      }
      const std::vector<std::size_t> active = active_set(touched, p);
      if (active.size() == 3) return into_periods(boundary_, on_constraints(active, p));
      const Vec3 m = motion(active, p);
      if (norm_squared(m) < 1e-24) return std::nullopt;
      const Vec3 start = p;
      p = advanced(p, active, std::max(0.9 * room, 2e-3));
      // Beside a tube a path may have a lowest point.
      if (active == active_set(active, p) && dot(m, motion(active, p)) <= 0)
        return into_periods(boundary_, lowest(start, p, active));
      // Into the box: images reach one period beyond it.
      p = into_periods(boundary_, p);
    }
  }

 private:
  static constexpr double contact = 1e-9, overlap = -1e-11, faultless = 1e-11;
  struct Ball {
    Vec3 anchor;
    double reach;
  };

  std::size_t size() const { return balls_.size() + faces_.size(); }
  double gap(std::size_t c, Vec3 p) const {
    if (c < balls_.size()) return std::sqrt(norm_squared(p - balls_[c].anchor)) - balls_[c].reach;
    return faces_[c - balls_.size()].distance(p) - radius_;
  }
  Vec3 normal(std::size_t c, Vec3 p) const {
    if (c >= balls_.size()) return faces_[c - balls_.size()].normal(p);
    const Vec3 displacement = p - balls_[c].anchor;
    return (1 / std::sqrt(norm_squared(displacement))) * displacement;
  }

  /// Gaussian elimination with pivoting of a symmetric system of up to 3 equations; false where it
  /// is singular.
  static bool solve(std::array<std::array<double, 4>, 3>& a, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      std::size_t pivot = i;
      for (std::size_t k = i + 1; k < n; ++k)
        if (std::abs(a[k][i]) > std::abs(a[pivot][i])) pivot = k;
      std::swap(a[i], a[pivot]);
      if (std::abs(a[i][i]) < 1e-12) return false;
      for (std::size_t k = 0; k < n; ++k) {
        if (k == i) continue;
        const double f = a[k][i] / a[i][i];
        for (std::size_t m = i; m < 4; ++m) a[k][m] -= f * a[i][m];
      }
    }
    for (std::size_t i = 0; i < n; ++i) a[i][3] /= a[i][i];
    return true;
  }
  /// The multipliers x with sum_j (n_i . n_j) x_j = right_i.
  template <class Right>
  std::optional<std::array<double, 3>> multipliers(const std::vector<std::size_t>& set, Vec3 p,
                                                   const Right& right) const {
    std::array<std::array<double, 4>, 3> a{};
    for (std::size_t i = 0; i < set.size(); ++i) {
      for (std::size_t j = 0; j < set.size(); ++j)
        a[i][j] = dot(normal(set[i], p), normal(set[j], p));
      a[i][3] = right(set[i]);
    }
    if (!solve(a, set.size())) return std::nullopt;
    return std::array{a[0][3], a[1][3], a[2][3]};
  }
  /// The forces by which the set carries the weight across the motion that it leaves.
  std::optional<std::array<double, 3>> forces(const std::vector<std::size_t>& set, Vec3 p) const {
    return multipliers(set, p, [&](std::size_t c) { return normal(c, p).z; });
  }
  Vec3 motion(const std::vector<std::size_t>& set, Vec3 p) const {
    Vec3 m = {0, 0, -1};
    if (const auto f = forces(set, p))
      for (std::size_t i = 0; i < set.size(); ++i) m = m + (*f)[i] * normal(set[i], p);
    return m;
  }

  /// The contacts that carry: none of them pulls, and the motion enters no other.
  std::vector<std::size_t> active_set(const std::vector<std::size_t>& touched, Vec3 p) const {
    std::vector<std::vector<std::size_t>> sets = {{}};
    for (std::size_t a : touched) sets.push_back({a});
    for (std::size_t i = 0; i < touched.size(); ++i)
      for (std::size_t j = i + 1; j < touched.size(); ++j) sets.push_back({touched[i], touched[j]});
    for (std::size_t i = 0; i < touched.size(); ++i)
      for (std::size_t j = i + 1; j < touched.size(); ++j)
        for (std::size_t k = j + 1; k < touched.size(); ++k)
          sets.push_back({touched[i], touched[j], touched[k]});
    std::vector<std::size_t> best;
    double least = 1;
    for (const auto& set : sets) {
      const auto f = forces(set, p);
      if (!f) continue;
      const Vec3 m = motion(set, p);
      // How far the set is from the conditions of the projection.
      double fault = 0;
      for (std::size_t i = 0; i < set.size(); ++i) fault = std::max(fault, -(*f)[i]);
      for (const std::size_t c : touched) fault = std::max(fault, -dot(m, normal(c, p)));
      if (fault < least) {
        least = fault;
        best = set;
      }
      if (fault < faultless) return set;
    }
    return best;
  }

  Vec3 on_constraints(const std::vector<std::size_t>& set, Vec3 p) const {
    for (int round = 0; round < 8 && !set.empty(); ++round) {
      const auto x = multipliers(set, p, [&](std::size_t c) { return -gap(c, p); });
      if (!x) return p;
      Vec3 step;
      for (std::size_t i = 0; i < set.size(); ++i) step = step + (*x)[i] * normal(set[i], p);
      p = p + step;
    }
    return p;
  }
  bool allowed(const std::vector<std::size_t>& active, Vec3 p) const {
    for (std::size_t c = 0; c < size(); ++c) {
      if (std::ranges::find(active, c) == active.end() && gap(c, p) < overlap) return false;
    }
    const auto f = forces(active, p);
    if (!f) return true;
    for (std::size_t i = 0; i < active.size(); ++i)
      if ((*f)[i] < -2 * faultless) return false;
    return true;
  }
  /// Where the motion changes its sign on the path of the active constraints.
  Vec3 lowest(Vec3 start, Vec3 end, const std::vector<std::size_t>& active) const {
    const Vec3 m = motion(active, start);
    for (int i = 0; i < 60; ++i) {
      const Vec3 middle = on_constraints(active, 0.5 * (start + end));
      (dot(m, motion(active, middle)) > 0 ? start : end) = middle;
    }
    return start;
  }
  /// A step of the length along the motion, or up to where something is met or lost.
  Vec3 advanced(Vec3 p, const std::vector<std::size_t>& active, double length) const {
    const Vec3 m = motion(active, p);
    const Vec3 direction = (1 / std::sqrt(norm_squared(m))) * m;
    const auto point_at = [&](double s) { return on_constraints(active, p + s * direction); };
    const Vec3 next = point_at(length);
    if (allowed(active, next)) return next;
    double low = 0, high = length;
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (allowed(active, point_at(middle)) ? low : high) = middle;
    }
    return point_at(high);
  }

  Boundary boundary_;
  std::vector<Ball> balls_;
  std::vector<Face> faces_;
  double radius_ = 0;
};

}  // namespace jostle
