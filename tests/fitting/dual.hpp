#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace jostle {

/// A value with its derivatives by up to nine parameters: forward differentiation.
struct Dual {
  double v = 0;
  std::array<double, 9> d{};

  Dual() = default;
  Dual(double value) : v(value) {}

  static Dual variable(double value, std::size_t index) {
    Dual x(value);
    x.d[index] = 1;
    return x;
  }
};

/// f(x) with derivative `slope`.
inline Dual chain(const Dual& x, double value, double slope) {
  Dual y(value);
  for (std::size_t i = 0; i < y.d.size(); ++i) y.d[i] = slope * x.d[i];
  return y;
}

inline Dual combine(const Dual& a, const Dual& b, double value, double by_a, double by_b) {
  Dual y(value);
  for (std::size_t i = 0; i < y.d.size(); ++i) y.d[i] = by_a * a.d[i] + by_b * b.d[i];
  return y;
}

inline Dual operator+(const Dual& a, const Dual& b) {
  return combine(a, b, a.v + b.v, 1, 1);
}
inline Dual operator-(const Dual& a, const Dual& b) {
  return combine(a, b, a.v - b.v, 1, -1);
}
inline Dual operator*(const Dual& a, const Dual& b) {
  return combine(a, b, a.v * b.v, b.v, a.v);
}
inline Dual operator/(const Dual& a, const Dual& b) {
  return combine(a, b, a.v / b.v, 1 / b.v, -a.v / (b.v * b.v));
}
inline Dual operator-(const Dual& a) {
  return chain(a, -a.v, -1);
}
inline Dual exp(const Dual& x) {
  return chain(x, std::exp(x.v), std::exp(x.v));
}
inline Dual log(const Dual& x) {
  return chain(x, std::log(x.v), 1 / x.v);
}
inline Dual sin(const Dual& x) {
  return chain(x, std::sin(x.v), std::cos(x.v));
}
inline Dual cos(const Dual& x) {
  return chain(x, std::cos(x.v), -std::sin(x.v));
}
inline Dual atan(const Dual& x) {
  return chain(x, std::atan(x.v), 1 / (1 + x.v * x.v));
}
inline Dual pow(const Dual& a, const Dual& b) {
  const double value = std::pow(a.v, b.v);
  return combine(a, b, value, b.v * std::pow(a.v, b.v - 1), value * std::log(a.v));
}
inline Dual square(const Dual& x) {
  return x * x;
}
inline double square(double x) {
  return x * x;
}

}  // namespace jostle
