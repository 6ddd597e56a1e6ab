#include "structure/order/bond_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace jostle::inline structure {
namespace {

using Complex = std::complex<double>;

// Exact up to 22!, more than 3j symbols of l = 6 need.
double factorial(int n) {
  double product = 1;
  for (int k = 2; k <= n; ++k) product *= k;
  return product;
}

// q_l0 .. q_ll; those of negative m follow: q_l-m = (-1)^m conj(q_lm).
template <int l>
using Multipole = std::array<Complex, l + 1>;

template <int l>
double norm_squared(const Multipole<l>& q) {
  double sum = 0;
  for (int m = l; m > 0; --m) sum += 2 * std::norm(q[m]);
  return sum + std::norm(q[0]);
}

// Y_lm(x, y, z) = (x + i y)^m P_lm(z) on the unit sphere, P_lm being a polynomial of z^2, times z
// where l - m is odd: the m-th derivative of Legendre's, with the factors of Y_lm.
template <int l>
class Harmonics {
 public:
  Harmonics() {
    for (int m = 0; m <= l; ++m) {
      const double scale = (m % 2 == 0 ? 1 : -1) * std::sqrt((2 * l + 1) / (4 * std::numbers::pi) *
                                                             factorial(l - m) / factorial(l + m));
      // P_l = 2^-l sum_k (-1)^k (2l - 2k)! / (k! (l - k)! (l - 2k)!) z^(l - 2k), m times derived.
      for (int k = 0; l - 2 * k - m >= 0; ++k) {
        const double coefficient =
            factorial(2 * l - 2 * k) / (factorial(k) * factorial(l - k) * factorial(l - 2 * k - m));
        descending_[m][k] = (k % 2 == 0 ? 1 : -1) * scale * std::ldexp(coefficient, -l);
      }
    }
  }

  void add(Vec3 direction, Multipole<l>& q) const {
    const double square = direction.z * direction.z;
    double real_part = 1, across = 0;  // (x + i y)^m
    for (int m = 0; m <= l; ++m) {
      double polynomial = 0;
      for (int k = 0; k <= (l - m) / 2; ++k) polynomial = polynomial * square + descending_[m][k];
      if ((l - m) % 2 != 0) polynomial *= direction.z;
      q[m] += Complex{polynomial * real_part, polynomial * across};
      const double turned = real_part * direction.x - across * direction.y;
      across = real_part * direction.y + across * direction.x;
      real_part = turned;
    }
  }

 private:
  std::array<std::array<double, l / 2 + 1>, l + 1> descending_{};
};

// (l l l; a b -a-b) by Racah's formula.
double wigner_3j(int l, int a, int b) {
  const int c = -a - b;
  const double triangle = std::pow(factorial(l), 3) / factorial(3 * l + 1);
  const double norm = triangle * factorial(l + a) * factorial(l - a) * factorial(l + b) *
                      factorial(l - b) * factorial(l + c) * factorial(l - c);
  double sum = 0;
  for (int k = std::max({0, -a, b}); k <= std::min({l, l - a, l + b}); ++k) {
    const double term = factorial(k) * factorial(a + k) * factorial(k - b) * factorial(l - k) *
                        factorial(l - a - k) * factorial(l + b - k);
    sum += (k % 2 == 0 ? 1 : -1) / term;
  }
  return (c % 2 == 0 ? 1 : -1) * std::sqrt(norm) * sum;
}

template <int l>
class Invariants {
 public:
  Invariants() {
    for (int a = -l; a <= l; ++a) {
      for (int b = std::max(-l, -l - a); b <= std::min(l, l - a); ++b) {
        couplings_[a + l][b + l] = wigner_3j(l, a, b);
      }
    }
  }

  double q(const Multipole<l>& q_lm) const {
    return std::sqrt(4 * std::numbers::pi / (2 * l + 1) * norm_squared<l>(q_lm));
  }

  // The sum is real: turning all m's signs conjugates its terms.
  double w(const Multipole<l>& q_lm) const {
    constexpr double rounding = 1e-26;
    const double square = norm_squared<l>(q_lm);
    if (square < rounding) return 0;
    std::array<Complex, 2 * l + 1> all;
    for (int m = 0; m <= l; ++m) {
      all[l + m] = q_lm[m];
      all[l - m] = m % 2 == 0 ? std::conj(q_lm[m]) : -std::conj(q_lm[m]);
    }
    double sum = 0;
    for (int a = -l; a <= l; ++a) {
      double re = 0, im = 0;
      for (int b = std::max(-l, -l - a); b <= std::min(l, l - a); ++b) {
        const Complex& first_factor = all[l + b];
        const Complex& second_factor = all[l - a - b];
        const double coupling = couplings_[a + l][b + l];
        re += coupling * (first_factor.real() * second_factor.real() -
                          first_factor.imag() * second_factor.imag());
        im += coupling * (first_factor.real() * second_factor.imag() +
                          first_factor.imag() * second_factor.real());
      }
      sum += all[l + a].real() * re - all[l + a].imag() * im;
    }
    return sum / (square * std::sqrt(square));
  }

 private:
  std::array<std::array<double, 2 * l + 1>, 2 * l + 1> couplings_{};
};

struct Multipoles {
  Multipole<4> four{};
  Multipole<6> six{};
};

template <std::size_t n>
void add(std::array<Complex, n>& sum, const std::array<Complex, n>& term) {
  for (std::size_t m = 0; m < n; ++m) sum[m] += term[m];
}

void scale(Multipoles& multipoles, double factor) {
  for (Complex& q : multipoles.four) q *= factor;
  for (Complex& q : multipoles.six) q *= factor;
}

// Means over the bonds of each sphere, [n]; NaN without any.
std::vector<Multipoles> bond_multipoles(const NeighbourTable& table) {
  const Harmonics<4> fourth;
  const Harmonics<6> sixth;
  std::vector<Multipoles> all(table.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    for (const Neighbour& neighbour : table.neighbours_of(i)) {
      const Vec3 direction = (1 / std::sqrt(neighbour.distance_squared)) * neighbour.way;
      fourth.add(direction, all[i].four);
      sixth.add(direction, all[i].six);
    }
    scale(all[i], 1 / static_cast<double>(table.neighbours_of(i).size()));
  }
  return all;
}

std::vector<BondOrder> invariants(const std::vector<Multipoles>& multipoles) {
  const Invariants<4> fourth;
  const Invariants<6> sixth;
  std::vector<BondOrder> orders;
  orders.reserve(multipoles.size());
  for (const Multipoles& q : multipoles) {
    orders.push_back({fourth.q(q.four), sixth.q(q.six), fourth.w(q.four), sixth.w(q.six)});
  }
  return orders;
}

}  // namespace

std::vector<BondOrder> bond_order(const NeighbourTable& neighbours) {
  return invariants(bond_multipoles(neighbours));
}

}  // namespace jostle::inline structure
