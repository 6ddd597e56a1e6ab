#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fitting/models/model.hpp"

// The laws of Philippe & Bideau 2001 (Phys. Rev. E 63, 051304, "PB") and Rosato et al. 2010 (Phys.
// Rev. E 81, 061301, "DR"). t: number of taps unless stated otherwise.
namespace jostle::inline fitting {

/// A law as it is published: what it is called, how it reads, where it is from.
class PublishedLaw : public Model {
 public:
  std::string name() const final { return name_; }
  std::string formula() const final { return formula_; }
  std::string source() const final { return source_; }
  const std::vector<Parameter>& parameters() const final { return parameters_; }

 protected:
  PublishedLaw(std::string name, std::string formula, std::string source,
               std::vector<Parameter> parameters)
      : name_(std::move(name)),
        formula_(std::move(formula)),
        source_(std::move(source)),
        parameters_(std::move(parameters)) {}

 private:
  std::string name_, formula_, source_;
  std::vector<Parameter> parameters_;
};

/// X(t) = X_inf - dX / (1 + B ln(1 + t/tau)); parameters X_inf, dX = X_inf - X(0), B > 0, tau > 0.
/// PB eq. 3, after Knight et al. 1995.
class InverseLog final : public PublishedLaw {
 public:
  InverseLog();
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  std::string refusal(const Curve& curve) const override;
  std::vector<ParameterValues> starts(const Curve& curve, std::span<const double> fixed,
                                      std::size_t n) const override;
  std::vector<Combination> combinations() const override;
  std::optional<Equivalent> equivalent() const override;
  std::vector<Limit> limits() const override;
};

/// Z(t) = Z_inf (1 + B ln(1 + t/tau)) / (Z_inf/Z_0 + B ln(1 + t/tau)): the inverse log for 1/Z, so
/// Z is measured from the floor; parameters Z_inf, Z_0, B, tau, all > 0. PB eq. 4. It is eq. 3 with
/// X_inf = Z_inf, dX = Z_inf - Z_0 and B Z_0 / Z_inf for its B.
class InverseLogHeight final : public PublishedLaw {
 public:
  InverseLogHeight();
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  std::string refusal(const Curve& curve) const override;
  std::vector<ParameterValues> starts(const Curve& curve, std::span<const double> fixed,
                                      std::size_t n) const override;
  std::vector<Combination> combinations() const override;
  std::optional<Equivalent> equivalent() const override;
  std::vector<Limit> limits() const override;
};

/// Z(t) = Z_inf + a1 exp(-t/tau1) + a2 exp(-t/tau2), tau1 <= tau2. PB sec. IV.
class TwoExponentials final : public PublishedLaw {
 public:
  TwoExponentials();
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  std::vector<ParameterValues> starts(const Curve& curve, std::span<const double> fixed,
                                      std::size_t n) const override;
  ParameterValues canonical(const ParameterValues& p) const override;
  std::vector<Limit> limits() const override;
};

/// rho(n) = rho_inf - (rho_inf - rho_0) exp(-(n/tau)^beta), Kohlrausch-Williams-Watts; rho_0 is
/// free unless it is fixed; tau > 0, beta > 0 (above 1 it is reported as compressed). DR.
class StretchedExponential final : public PublishedLaw {
 public:
  StretchedExponential();
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  std::string refusal(const Curve& curve) const override;
  std::vector<ParameterValues> starts(const Curve& curve, std::span<const double> fixed,
                                      std::size_t n) const override;
  std::vector<Limit> limits() const override;
};

/// A(t) = A_inf (1 - 1 / (1 + B ln(1 + t/tau))), t the lag. PB eq. 6.
class Ageing final : public PublishedLaw {
 public:
  Ageing();
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  std::string refusal(const Curve& curve) const override;
  std::vector<ParameterValues> starts(const Curve& curve, std::span<const double> fixed,
                                      std::size_t n) const override;
  std::vector<Combination> combinations() const override;
  std::vector<Limit> limits() const override;
};

/// Phi(z) = (Phi_0 - alpha z) / (1 + exp(beta (z - z_star))), t = height z in R; beta > 0. PB
/// eq. 7.
class DensityProfile final : public PublishedLaw {
 public:
  DensityProfile();
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  std::vector<std::vector<double>> candidates(const Curve& curve) const override;
};

/// rho_v = A exp(-v/v0), t = pore volume v; v0 > 0. PB sec. VI.
class PoreTail final : public PublishedLaw {
 public:
  PoreTail();
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  std::vector<std::vector<double>> candidates(const Curve& curve) const override;
};

/// P(f) = A f^-s, t = frequency f > 0, fitted in ln P: s is minus the log-log slope. PB sec. IV.
class PowerLaw final : public PublishedLaw {
 public:
  PowerLaw();
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  ResidualScale residual_scale() const override { return ResidualScale::logarithmic; }
  std::string refusal(const Curve& curve) const override;
  std::vector<ParameterValues> starts(const Curve& curve, std::span<const double> fixed,
                                      std::size_t n) const override;
};

/// N(x) = area / (width sqrt(2 pi)) exp(-(x - mean)^2 / (2 width^2)), t = x; width > 0. DR fig. 8.
class Normal final : public PublishedLaw {
 public:
  Normal();
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  std::vector<std::vector<double>> candidates(const Curve& curve) const override;
};

/// G(x) = area k^k / Gamma(k) x^(k - 1) / mean^k exp(-k x / mean), the k-gamma distribution of what
/// cells have above the least that they can, x = t > 0; k > 0, mean > 0. Aste & Di Matteo 2008.
class KGamma final : public PublishedLaw {
 public:
  KGamma();
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
