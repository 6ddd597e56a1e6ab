#include "bench/yardstick.hpp"

#include <algorithm>
#include <cmath>

namespace jostle::bench {

namespace {

constexpr int theta_nodes = 4096;

// Inverse of the Gaussian law of theta, theta0 = pi/4, on [0, pi/2], by bisection.
std::vector<double> theta_inverse() {
  const double theta0 = std::atan(1.0), whole = std::erf(2.0);
  std::vector<double> table(theta_nodes + 1);
  for (int k = 0; k <= theta_nodes; ++k) {
    double low = 0, high = 2 * theta0;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (low + high);
      (std::erf(middle / theta0) < whole * k / theta_nodes ? low : high) = middle;
    }
    table[k] = low;
  }
  return table;
}

// Taylor polynomials, good to 1e-8 on [-pi/2, pi/2].
inline double sine(double x) {
  const double z = x * x;
  return x *
         (1 + z * (-1.0 / 6 + z * (1.0 / 120 + z * (-1.0 / 5040 +
                                                    z * (1.0 / 362880 + z * (-1.0 / 39916800))))));
}
inline double cosine(double x) {
  const double z = x * x;
  return 1 +
         z * (-1.0 / 2 +
              z * (1.0 / 24 + z * (-1.0 / 720 + z * (1.0 / 40320 + z * (-1.0 / 3628800 +
                                                                        z * (1.0 / 479001600))))));
}

}  // namespace

Yardstick::Yardstick(const std::vector<std::array<double, 3>>& centres, double width_x,
                     double width_y, double height, YardstickMove move, double max_step,
                     YardstickLists lists)
    : width_{width_x, width_y, height},
      move_(move),
      lists_(lists),
      max_step_(max_step),
      theta_(theta_inverse()) {
  for (const auto& c : centres) position_.push_back({c[0], c[1], c[2], 0});
  if (height > 0) {
    skin_ = 1.0;
  } else {
    skin_ = move == YardstickMove::polar ? std::max(0.3, 2 * max_step)
                                         : 0.3 + 2 * std::sqrt(3.0) * max_step;
  }
  std::uint64_t seed = 12345;
  for (auto& word : state_) {
    for (auto& lane : word) {
      seed += 0x9e3779b97f4a7c15;
      std::uint64_t h = (seed ^ (seed >> 30)) * 0xbf58476d1ce4e5b9;
      h = (h ^ (h >> 27)) * 0x94d049bb133111eb;
      lane = h ^ (h >> 31);
    }
  }
  rebuild();
}

double Yardstick::image(double d, int axis) const {
  const double w = width_[axis];
  if (w == 0) return d;
  return d > 0.5 * w ? d - w : (d < -0.5 * w ? d + w : d);
}

double Yardstick::wrapped(double x, int axis) const {
  const double w = width_[axis];
  if (w == 0) return x;
  return x < 0 ? x + w : (x >= w ? x - w : x);
}

void Yardstick::next(std::array<std::uint64_t, lanes>& numbers) {
  for (int l = 0; l < lanes; ++l) {
    numbers[l] = state_[0][l] + state_[3][l];
    const std::uint64_t t = state_[1][l] << 17;
    state_[2][l] ^= state_[0][l];
    state_[3][l] ^= state_[1][l];
    state_[1][l] ^= state_[2][l];
    state_[0][l] ^= state_[3][l];
    state_[2][l] ^= t;
    state_[3][l] = (state_[3][l] << 45) | (state_[3][l] >> 19);
  }
}

// Two 64-bit numbers per trial, each cut into two of 32 bits.
void Yardstick::propose() {
  constexpr double pi = 3.14159265358979323846;
  const auto n = static_cast<std::uint64_t>(position_.size());
  std::array<std::uint64_t, lanes> a, b;
  for (int k = 0; k < batch; k += lanes) {
    next(a);
    next(b);
    for (int l = 0; l < lanes; ++l) {
      sphere_[k + l] = static_cast<std::uint32_t>(((a[l] >> 32) * n) >> 32);
      dx_[k + l] = static_cast<double>(static_cast<std::int64_t>(a[l] & 0xffffffff)) * 0x1p-32;
      dy_[k + l] = static_cast<double>(static_cast<std::int64_t>(b[l] >> 32)) * 0x1p-32;
      dz_[k + l] = static_cast<double>(static_cast<std::int64_t>(b[l] & 0xffffffff)) * 0x1p-32;
    }
  }
  used_ = 0;
  if (move_ != YardstickMove::polar) {
    for (int k = 0; k < batch; ++k) {
      dx_[k] = max_step_ * (1 - 2 * dx_[k]);
      dy_[k] = max_step_ * (1 - 2 * dy_[k]);
      dz_[k] = max_step_ * (1 - 2 * dz_[k]);
    }
    return;
  }
  const double* const table = theta_.data();
  for (int k = 0; k < batch; ++k) {
    const double place = dy_[k] * theta_nodes;
    const int node = static_cast<int>(place);
    dy_[k] = table[node] + (table[node + 1] - table[node]) * (place - node);
  }
  for (int k = 0; k < batch; ++k) {
    // The azimuth from its half: sin and cos of 2x by the addition theorem.
    const double half = pi * (dx_[k] - 0.5), length = max_step_ * dz_[k];
    const double s = sine(half), c = cosine(half), theta = dy_[k];
    const double sideways = length * sine(theta);
    dx_[k] = sideways * (1 - 2 * s * s);
    dy_[k] = sideways * 2 * s * c;
    dz_[k] = -length * cosine(theta);
  }
}

void Yardstick::sort_into_cells(double reach) {
  double top = 1;
  for (const Point& p : position_) top = std::max(top, p.z);
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = width_[axis] > 0 ? width_[axis] : top + 1e-9;
    cells_[axis] = std::max(1, static_cast<int>(extent / reach));
    per_length_[axis] = cells_[axis] / extent;
  }
  const auto n = static_cast<std::uint32_t>(position_.size());
  cell_first_.assign(cells_[0] * cells_[1] * cells_[2] + 1, 0);
  cell_of_.resize(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    const int x = std::min(cells_[0] - 1, static_cast<int>(position_[i].x * per_length_[0]));
    const int y = std::min(cells_[1] - 1, static_cast<int>(position_[i].y * per_length_[1]));
    const int z = std::min(cells_[2] - 1, static_cast<int>(position_[i].z * per_length_[2]));
    cell_of_[i] = {x, y, z};
    ++cell_first_[(z * cells_[1] + y) * cells_[0] + x + 1];
  }
  for (std::size_t c = 1; c < cell_first_.size(); ++c) cell_first_[c] += cell_first_[c - 1];
  in_cells_.resize(n);
  std::vector<std::uint32_t> next(cell_first_.begin(), cell_first_.end() - 1);
  for (std::uint32_t i = 0; i < n; ++i) {
    const auto& c = cell_of_[i];
    in_cells_[next[(c[2] * cells_[1] + c[1]) * cells_[0] + c[0]]++] = i;
  }
}

// The spheres within `reach` of sphere i, in the order of their cells.
void Yardstick::append_neighbours(std::uint32_t i, double reach) {
  const Point p = position_[i];
  for (int dz = -1; dz <= 1; ++dz) {
    int z = cell_of_[i][2] + dz;
    if (z < 0 || z >= cells_[2]) {
      if (width_[2] == 0) continue;
      z += z < 0 ? cells_[2] : -cells_[2];
    }
    for (int dy = -1; dy <= 1; ++dy) {
      int y = cell_of_[i][1] + dy;
      y += y < 0 ? cells_[1] : (y >= cells_[1] ? -cells_[1] : 0);
      for (int dx = -1; dx <= 1; ++dx) {
        int x = cell_of_[i][0] + dx;
        x += x < 0 ? cells_[0] : (x >= cells_[0] ? -cells_[0] : 0);
        const int cell = (z * cells_[1] + y) * cells_[0] + x;
        for (std::uint32_t k = cell_first_[cell]; k < cell_first_[cell + 1]; ++k) {
          const std::uint32_t j = in_cells_[k];
          const double ax = image(p.x - position_[j].x, 0), ay = image(p.y - position_[j].y, 1);
          const double az = image(p.z - position_[j].z, 2);
          if (j != i && ax * ax + ay * ay + az * az < reach * reach) neighbours_.push_back(j);
        }
      }
    }
  }
}

void Yardstick::rebuild() {
  const auto n = static_cast<std::uint32_t>(position_.size());
  const double reach = 1 + skin_;
  sort_into_cells(reach);
  first_.assign(1, 0);
  neighbours_.clear();
  for (std::uint32_t i = 0; i < n; ++i) {
    append_neighbours(i, reach);
    lists_ == YardstickLists::sorted ? sort_neighbours(i) : put_near_first(i);
    first_.push_back(static_cast<std::uint32_t>(neighbours_.size()));
  }
  origin_ = position_;
  ++list_rebuilds;
}

// Those that a step is likely to meet before the rest.
void Yardstick::put_near_first(std::uint32_t i) {
  constexpr double near = 1.1;
  std::partition(neighbours_.begin() + first_.back(), neighbours_.end(), [&](std::uint32_t j) {
    const double x = image(position_[i].x - position_[j].x, 0),
                 y = image(position_[i].y - position_[j].y, 1);
    const double z = image(position_[i].z - position_[j].z, 2);
    return x * x + y * y + z * z < near * near;
  });
}

// The nearest first, under gravity those below before those above.
void Yardstick::sort_neighbours(std::uint32_t i) {
  const auto distance = [&](std::uint32_t j) {
    const double x = image(position_[i].x - position_[j].x, 0),
                 y = image(position_[i].y - position_[j].y, 1);
    const double z = image(position_[i].z - position_[j].z, 2);
    return x * x + y * y + z * z + (width_[2] == 0 && z < 0 ? 10 : 0);
  };
  std::sort(neighbours_.begin() + first_.back(), neighbours_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return distance(a) < distance(b); });
}

bool Yardstick::blocked(std::uint32_t i, const Point& q) {
  for (std::uint32_t k = first_[i]; k < first_[i + 1]; ++k) {
    const Point& p = position_[neighbours_[k]];
    ++distance_tests;
    const double x = image(q.x - p.x, 0), y = image(q.y - p.y, 1), z = image(q.z - p.z, 2);
    if (x * x + y * y + z * z < 1) return true;
  }
  return false;
}

void Yardstick::run(std::uint64_t n_trials) {
  for (; n_trials > 0; --n_trials) {
    if (used_ == batch) propose();
    const int t = used_++;
    const std::uint32_t soon = sphere_[std::min(batch - 1, t + 12)];
    __builtin_prefetch(&position_[soon]);
    __builtin_prefetch(&first_[soon]);
    __builtin_prefetch(&neighbours_[first_[sphere_[std::min(batch - 1, t + 6)]]]);
    ++trials;
    if (move_ == YardstickMove::metropolis_cold && dz_[t] > 0) continue;
    const std::uint32_t i = sphere_[t];
    const Point q = {wrapped(position_[i].x + dx_[t], 0), wrapped(position_[i].y + dy_[t], 1),
                     wrapped(position_[i].z + dz_[t], 2), 0};
    if (width_[2] == 0 && q.z < 0.5) continue;
    if (blocked(i, q)) continue;
    const double x = image(q.x - origin_[i].x, 0), y = image(q.y - origin_[i].y, 1);
    const double z = image(q.z - origin_[i].z, 2);
    if (x * x + y * y + z * z > 0.25 * skin_ * skin_) {
      rebuild();
      if (blocked(i, q)) continue;
    }
    position_[i] = q;
    ++accepted;
  }
}

}  // namespace jostle::bench
