// A model of one's own: a power-law approach to the final density, fitted without a guess.
#include <cmath>
#include <iostream>
#include <jostle/fit.hpp>

class PowerApproach final : public jostle::Model {
 public:
  std::string name() const override { return "power_approach"; }
  std::string formula() const override { return "X_inf - dX (1 + t/tau)^-s"; }
  const std::vector<jostle::Parameter>& parameters() const override {
    using jostle::ParameterUnit;
    static const std::vector<jostle::Parameter> list = {
        {.name = "X_inf", .meaning = "final value", .unit = ParameterUnit::value, .linear = true},
        {.name = "dX", .meaning = "X_inf - X(0)", .unit = ParameterUnit::value, .linear = true},
        {.name = "tau", .meaning = "first taps", .unit = ParameterUnit::time, .lower = 0},
        {.name = "s", .meaning = "exponent", .lower = 0}};
    return list;
  }
  double value(double t, const double* p) const override {
    return p[0] - p[1] * std::pow(1 + t / p[2], -p[3]);
  }
};

int main() {
  jostle::Curve curve;
  for (int tap = 1; tap <= 4000; tap += 7) {
    curve.t.push_back(tap);
    curve.x.push_back(0.63 - 0.05 * std::pow(1 + tap / 20.0, -0.4) + 1e-4 * std::sin(1.7 * tap));
  }
  const auto result = jostle::fit(PowerApproach(), curve);
  if (const auto* refusal = std::get_if<jostle::Refusal>(&result)) {
    std::cerr << refusal->message << '\n';
    return 1;
  }
  const jostle::Fit& fit = std::get<jostle::Fit>(result);
  std::cout << describe(fit);
  return fit.estimates[0].intervals[1].closed() ? 0 : 1;
}
