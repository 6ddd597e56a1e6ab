#pragma once

#include <memory>

#include "fitting/models.hpp"

namespace jostle {

/// Several ageing curves with one B: parameters B, then A_inf and tau of every curve, tau > 0. The
/// argument t numbers the points of all curves, 0 .. n - 1, so that one fit holds them all: a
/// collapse of A/A_inf against t/tau exists only for a common B.
class SharedAgeing final : public Model {
 public:
  struct Point {
    std::size_t curve;  // 0 .. n_curves - 1
    double lag;
  };

  /// Every curve has at least one point.
  explicit SharedAgeing(std::vector<Point> points);

  std::string name() const override { return "shared_ageing"; }
  std::string formula() const override { return "A_inf(t_W) (1 - 1 / (1 + B ln(1 + t/tau(t_W))))"; }
  std::string source() const override { return Ageing().source(); }
  const std::vector<Parameter>& parameters() const override { return parameters_; }
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  /// From fits of every curve with B held: at most `n` values of B over the decades in which eq. 6
  /// is more than a straight line.
  std::vector<ParameterValues> starts(const Curve& curve, std::span<const double> fixed,
                                      std::size_t n) const override;

  static std::size_t a_inf_index(std::size_t curve) { return 1 + 2 * curve; }
  static std::size_t tau_index(std::size_t curve) { return 2 + 2 * curve; }

 private:
  const Point& point(double t) const { return points_[static_cast<std::size_t>(t)]; }
  std::size_t n_curves() const { return (parameters_.size() - 1) / 2; }

  std::vector<Point> points_;
  std::vector<Parameter> parameters_;
};

}  // namespace jostle
