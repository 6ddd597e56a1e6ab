#pragma once

#include <memory>
#include <string_view>

#include "fitting/models/model.hpp"

// The laws of Philippe & Bideau 2001 (Phys. Rev. E 63, 051304, "PB") and Rosato et al. 2010 (Phys.
// Rev. E 81, 061301, "DR"). t: number of taps unless said otherwise.
namespace jostle::inline fitting {

/// X(t) = X_inf - dX / (1 + B ln(1 + t/tau)); parameters X_inf, dX = X_inf - X(0), B > 0, tau > 0.
/// PB eq. 3, after Knight et al. 1995.
class InverseLog final : public Model {
 public:
  std::string name() const override { return "inverse_log"; }
  std::string formula() const override { return "X_inf - dX / (1 + B ln(1 + t/tau))"; }
  std::string source() const override;
  const std::vector<Parameter>& parameters() const override;
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  std::string refusal(const Curve& curve) const override;
  std::vector<ParameterValues> starts(const Curve& curve, std::span<const double> fixed,
                                      std::size_t n) const override;
  std::vector<Combination> combinations() const override;
};

/// Z(t) = Z_inf (1 + B ln(1 + t/tau)) / (Z_inf/Z_0 + B ln(1 + t/tau)): the inverse log for 1/Z, so
/// Z is measured from the floor; parameters Z_inf, Z_0, B, tau, all > 0. PB eq. 4.
class InverseLogHeight final : public Model {
 public:
  std::string name() const override { return "inverse_log_height"; }
  std::string formula() const override {
    return "Z_inf (1 + B ln(1 + t/tau)) / (Z_inf/Z_0 + B ln(1 + t/tau))";
  }
  std::string source() const override;
  const std::vector<Parameter>& parameters() const override;
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  std::string refusal(const Curve& curve) const override;
  std::vector<ParameterValues> starts(const Curve& curve, std::span<const double> fixed,
                                      std::size_t n) const override;
  std::vector<Combination> combinations() const override;
};

/// Z(t) = Z_inf + a1 exp(-t/tau1) + a2 exp(-t/tau2), tau1 <= tau2. PB sec. IV.
class TwoExponentials final : public Model {
 public:
  std::string name() const override { return "two_exponentials"; }
  std::string formula() const override { return "Z_inf + a1 exp(-t/tau1) + a2 exp(-t/tau2)"; }
  std::string source() const override;
  const std::vector<Parameter>& parameters() const override;
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  std::vector<ParameterValues> starts(const Curve& curve, std::span<const double> fixed,
                                      std::size_t n) const override;
  ParameterValues canonical(const ParameterValues& p) const override;
};

/// rho(n) = rho_inf - (rho_inf - rho_0) exp(-(n/tau)^beta), Kohlrausch-Williams-Watts; rho_0 is
/// free unless it is fixed; tau > 0, beta > 0 (above 1 it is compressed, and said so). DR.
class StretchedExponential final : public Model {
 public:
  std::string name() const override { return "kww"; }
  std::string formula() const override { return "rho_inf - (rho_inf - rho_0) exp(-(t/tau)^beta)"; }
  std::string source() const override;
  const std::vector<Parameter>& parameters() const override;
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  std::string refusal(const Curve& curve) const override;
  std::vector<ParameterValues> starts(const Curve& curve, std::span<const double> fixed,
                                      std::size_t n) const override;
};

/// A(t) = A_inf (1 - 1 / (1 + B ln(1 + t/tau))), t the lag. PB eq. 6.
class Ageing final : public Model {
 public:
  std::string name() const override { return "ageing"; }
  std::string formula() const override { return "A_inf (1 - 1 / (1 + B ln(1 + t/tau)))"; }
  std::string source() const override;
  const std::vector<Parameter>& parameters() const override;
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  std::string refusal(const Curve& curve) const override;
  std::vector<ParameterValues> starts(const Curve& curve, std::span<const double> fixed,
                                      std::size_t n) const override;
  std::vector<Combination> combinations() const override;
};

/// Phi(z) = (Phi_0 - alpha z) / (1 + exp(beta (z - z_star))), t = height z in R; beta > 0. PB
/// eq. 7.
class DensityProfile final : public Model {
 public:
  std::string name() const override { return "profile"; }
  std::string formula() const override {
    return "(Phi_0 - alpha t) / (1 + exp(beta (t - z_star)))";
  }
  std::string source() const override;
  const std::vector<Parameter>& parameters() const override;
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  std::vector<std::vector<double>> candidates(const Curve& curve) const override;
};

/// rho_v = A exp(-v/v0), t = pore volume v; v0 > 0. PB sec. VI.
class PoreTail final : public Model {
 public:
  std::string name() const override { return "pore_tail"; }
  std::string formula() const override { return "A exp(-t/v0)"; }
  std::string source() const override;
  const std::vector<Parameter>& parameters() const override;
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  std::vector<std::vector<double>> candidates(const Curve& curve) const override;
};

/// P(f) = A f^-s, t = frequency f > 0, fitted in ln P: s is minus the log-log slope. PB sec. IV.
class PowerLaw final : public Model {
 public:
  std::string name() const override { return "power_law"; }
  std::string formula() const override { return "A t^-s"; }
  std::string source() const override;
  const std::vector<Parameter>& parameters() const override;
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  ResidualScale residual_scale() const override { return ResidualScale::logarithmic; }
  std::string refusal(const Curve& curve) const override;
  std::vector<ParameterValues> starts(const Curve& curve, std::span<const double> fixed,
                                      std::size_t n) const override;
};

/// N(x) = area / (width sqrt(2 pi)) exp(-(x - mean)^2 / (2 width^2)), t = x; width > 0. DR fig. 8.
class Normal final : public Model {
 public:
  std::string name() const override { return "normal"; }
  std::string formula() const override {
    return "area / (width sqrt(2 pi)) exp(-(t - mean)^2 / (2 width^2))";
  }
  std::string source() const override;
  const std::vector<Parameter>& parameters() const override;
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  std::vector<std::vector<double>> candidates(const Curve& curve) const override;
};

/// G(x) = area k^k / Gamma(k) x^(k - 1) / mean^k exp(-k x / mean), the k-gamma distribution of what
/// cells have above the least that they can, x = t > 0; k > 0, mean > 0. Aste & Di Matteo 2008.
class KGamma final : public Model {
 public:
  std::string name() const override { return "k_gamma"; }
  std::string formula() const override {
    return "area k^k / Gamma(k) t^(k - 1) / mean^k exp(-k t / mean)";
  }
  std::string source() const override;
  const std::vector<Parameter>& parameters() const override;
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  std::string refusal(const Curve& curve) const override;
  std::vector<std::vector<double>> candidates(const Curve& curve) const override;
};

/// Every model above, in this order.
std::vector<std::unique_ptr<Model>> all_models();
/// The model of that name, or null.
std::unique_ptr<Model> make_model(std::string_view name);

}  // namespace jostle::inline fitting
