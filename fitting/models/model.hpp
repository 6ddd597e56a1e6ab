#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fitting/curve.hpp"

namespace jostle::inline fitting {

/// Units of a parameter.
enum class ParameterUnit { none, value, time, value_per_time, value_time, per_time };

struct Parameter {
  std::string name;     // X_inf
  std::string meaning;  // "value after infinitely many taps"
  ParameterUnit unit = ParameterUnit::none;
  double lower = -std::numeric_limits<double>::infinity();  // exclusive
  double upper = std::numeric_limits<double>::infinity();   // exclusive
  bool linear = false;    // the model is linear in it (plus what does not depend on it)
  bool of_power = false;  // factor of a power of t: wide by the ratio of its limits
};

/// For two parameters: kept * other^power, by their indices.
struct Combination {
  std::string name;     // B/tau
  std::string meaning;  // "first slope of the logarithm"
  ParameterUnit unit = ParameterUnit::none;
  std::size_t kept = 0, partner = 0;
  int power = 1;
};

/// Residuals are differences of X, or of ln X. A curve with given errors of X alone is fitted in X
/// by every law: ln X has no error that is independent of its noise.
enum class ResidualScale { linear, logarithmic };

/// A starting point, or candidates for the nonlinear parameters: [n_parameters] values.
using ParameterValues = std::vector<double>;

class Model;
struct Limit;

/// A law with other parameters that draws this curves.
struct Equivalent {
  std::shared_ptr<const Model> law;
  /// Returns the parameters of `law` for the curve of these; they may be outside its bounds.
  ParameterValues (*restate)(const ParameterValues&) = nullptr;
  /// [n_parameters of `law`]: the parameter of the first law that is equal, by its index, if any.
  std::vector<std::optional<std::size_t>> equal = {};
};

/// A curve with parameters that can be fitted. To make one's own, derive and give `name`,
/// `parameters` and `value`; the rest has defaults. Nothing in a model changes after construction.
class Model {
 public:
  virtual ~Model() = default;

  virtual std::string name() const = 0;
  virtual std::string formula() const { return ""; }
  virtual std::string source() const { return ""; }
  /// [n_parameters], always the same.
  virtual const std::vector<Parameter>& parameters() const = 0;

  /// The model at t. p: [n_parameters], within their bounds.
  virtual double value(double t, const double* p) const = 0;
  /// The value, and its derivatives by the parameters in gradient [n_parameters]. By default
  /// fourth-order differences of `value`, good to about 10 digits.
  virtual double value_and_gradient(double t, const double* p, double* gradient) const;

  virtual ResidualScale residual_scale() const { return ResidualScale::linear; }
  /// Why the model has no meaning for this curve ("t must not be negative"), or "". The curve is
  /// free of `faults`.
  virtual std::string refusal(const Curve& curve) const;

  /// Candidates for each nonlinear parameter of a curve, [n_parameters][any], ascending; entries of
  /// linear ones are ignored. By default 13 decades about 1 for a positive parameter (times the
  /// range of t for a time), and 0 and +-1 otherwise.
  virtual std::vector<std::vector<double>> candidates(const Curve& curve) const;
  /// Starting points, at most `n`: by default those combinations of candidates that are better than
  /// their neighbours, best first, then the best of the others; the linear parameters are solved
  /// for (variable projection). A parameter with a finite value in `fixed` [n_parameters] keeps it;
  /// NaN marks those that are free.
  virtual std::vector<ParameterValues> starts(const Curve& curve, std::span<const double> fixed,
                                              std::size_t n) const;
  /// Pairs of positive parameters that can diverge together, and what a curve then determines.
  virtual std::vector<Combination> combinations() const { return {}; }
  /// The laws that it becomes where some of its parameters are 0 or infinite, fewest parameters
  /// first (fitting/models/limit.hpp).
  virtual std::vector<Limit> limits() const;
  /// The law that draws this curves with other parameters, if there is one.
  virtual std::optional<Equivalent> equivalent() const { return std::nullopt; }
  /// The curve with its parameters in standard order (as tau1 <= tau2).
  virtual ParameterValues canonical(const ParameterValues& p) const { return p; }
};

/// Returns true if the law is fitted to the curve in ln X: without errors, or with realizations.
bool is_fitted_in_logarithms(const Model& model, const Curve& curve);

/// `n` values from first to last in geometric progression. Requires 0 < first, 0 < last, n >= 2.
std::vector<double> geometric(double first, double last, std::size_t n);

}  // namespace jostle::inline fitting
