#include "engine/monte_carlo/theta_table.hpp"

#include <algorithm>
#include <bit>
#include <numbers>

#include "engine/bed/elementary.hpp"

namespace jostle::inline engine {

namespace {

constexpr double half_pi = std::numbers::pi / 2;

double density(const PolarMove& move, double theta) {
  const double x = theta / move.theta0;
  switch (move.law) {
    case ThetaLaw::gaussian:
      return exponential(-(x * x));
    case ThetaLaw::exponential:
      return exponential(-x);
    case ThetaLaw::linear:
      return std::max(0.0, 1 - x);
  }
  return 0;
}

// Beyond this angle less than 1e-20 of the law remains.
double largest_angle(const PolarMove& move) {
  switch (move.law) {
    case ThetaLaw::gaussian:
      return std::min(half_pi, 7 * move.theta0);
    case ThetaLaw::exponential:
      return std::min(half_pi, 60 * move.theta0);
    case ThetaLaw::linear:
      return std::min(half_pi, move.theta0);
  }
  return half_pi;
}

// Gauss-Legendre with five points: abscissae and weights on [-1, 1].
double integral(const PolarMove& move, double low, double high) {
  constexpr double x[] = {0, 0.538469310105683091036, 0.906179845938663992798};
  constexpr double w[] = {0.568888888888888888889, 0.478628670499366468041,
                          0.236926885056189087514};
  const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
  double sum = w[0] * density(move, middle);
  for (int k = 1; k < 3; ++k) {
    sum += w[k] * (density(move, middle - half * x[k]) + density(move, middle + half * x[k]));
  }
  return half * sum;
}

// Newton's method for integral(theta, high) = target with theta in [low, high], kept in a bracket.
double angle_with_integral(const PolarMove& move, double low, double high, double target) {
  double left = low, right = high, theta = 0.5 * (low + high);
  for (int step = 0; step < 100; ++step) {
    const double excess = integral(move, theta, high) - target;
    (excess > 0 ? left : right) = theta;
    const double slope = density(move, theta);
    double next = slope > 0 ? theta + excess / slope : left;
    if (!(next > left && next < right)) next = 0.5 * (left + right);
    const double change = next - theta;
    theta = next;
    if (change * change <= 1e-30 * theta * theta) break;
  }
  return theta;
}

std::vector<double> integrate_theta_table(const PolarMove& move) {
  constexpr int intervals = 2048;
  const double width = largest_angle(move) / intervals;
  // tail[k]: weight of the law beyond k x width, summed from the small end.
  std::vector<double> tail(intervals + 1, 0.0);
  for (int k = intervals - 1; k >= 0; --k) {
    tail[k] = tail[k + 1] + integral(move, k * width, (k + 1) * width);
  }
  std::vector<double> table(theta_table::size);
  int interval = intervals - 1;
  for (int node = 0; node < theta_table::size; ++node) {
    const auto bits = (theta_table::first + static_cast<std::uint64_t>(node)) << theta_table::shift;
    const double wanted = std::bit_cast<double>(bits) * tail[0];
    while (interval > 0 && tail[interval] < wanted) --interval;
    const double theta = angle_with_integral(move, interval * width, (interval + 1) * width,
                                             wanted - tail[interval + 1]);
    table[node] = std::clamp(0.5 * theta, 0.0, 0.5 * half_pi);
  }
  table.back() = 0;
  return table;
}

}  // namespace

// It takes as long as 20 000 trials, and all realizations of a scene have one law: every thread
// keeps the table that it made last.
std::vector<double> make_theta_table(const PolarMove& move) {
  struct Kept {
    ThetaLaw law{};
    double theta0 = 0;
    std::vector<double> table;
  };
  thread_local Kept kept;
  if (kept.table.empty() || kept.law != move.law || kept.theta0 != move.theta0)
    kept = {move.law, move.theta0, integrate_theta_table(move)};
  return kept.table;
}

}  // namespace jostle::inline engine
