#pragma once

#include <Eigen/Core>

// Nonlinear least squares by Levenberg-Marquardt, after More 1978 (Lecture Notes in Mathematics
// 630, 105): a trust region scaled by the columns of the Jacobian, its size ruled by the ratio of
// actual to predicted gain, every step from a QR decomposition of the augmented Jacobian.
namespace jostle::inline fitting {

/// The vector r(x) whose squared length is minimised.
class Residuals {
 public:
  virtual ~Residuals() = default;
  virtual Eigen::Index n_residuals() const = 0;
  virtual Eigen::Index n_variables() const = 0;
  /// x: [n_variables]. Fills r [n_residuals]. Values that are not finite are allowed: the solver
  /// keeps away from there.
  virtual void values(const Eigen::VectorXd& x, Eigen::VectorXd& r) const = 0;
  /// Fills r [n_residuals] and J [n_residuals, n_variables], J_ij = dr_i / dx_j.
  virtual void values_and_jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                   Eigen::MatrixXd& jacobian) const = 0;
};

/// How steps are measured: by the largest column norms of the Jacobian so far (More), by those at
/// the start, or by those of now.
enum class StepScaling { largest, first, current };

/// The budget of all descents of a fit together: evaluations of the residuals, a Jacobian counted
/// as one for every variable, and a search of starts as what it is worth.
struct EvaluationBudget {
  long long left = 0, used = 0;
  bool spent() const { return left <= 0; }
  void spend(long long n) {
    used += n;
    left -= n;
  }
};

struct SolverOptions {
  /// Cosine of the angle between r and the columns of the Jacobian.
  double gradient_tolerance = 1e-12;
  /// Length of a step relative to x, both scaled.
  double step_tolerance = 1e-14;
  /// Predicted gain of a step, relative to the cost.
  double cost_tolerance = 1e-15;
  /// Residuals this small against `data_norm` are rounding.
  double exact_tolerance = 1e-15;
  /// |data|, what the residuals are a difference of; 0 where there is no such scale.
  double data_norm = 0;
  int max_iterations = 1000;
  /// Shared by all descents of a fit, on one thread; without one only max_iterations end them.
  EvaluationBudget* budget = nullptr;
  StepScaling scaling = StepScaling::largest;
  /// First trust region, in units of the scaled length of x.
  double first_radius = 1;
  /// Adds the second-order correction of Transtrum & Sethna 2012 (arXiv:1201.5885) to every step
  /// where it is short against the step itself: one evaluation more a step, a fifth fewer over the
  /// NIST sets, and half the Jacobians.
  bool geodesic_acceleration = true;
  /// Where steps lead nowhere or to infinity: begin again from the given x with other scalings.
  bool fallbacks = true;
  /// True if a minimum is refined until its gradient is rounding: 10 digits instead of 7.
  bool polish = true;
};

/// Why a fit ended. The first four are minima.
enum class EndReason {
  gradient,         // the residuals are orthogonal to the Jacobian
  step,             // the step is too short to matter
  cost,             // the gain is too small to matter
  exact,            // the residuals are rounding: the curve is met exactly
  no_progress,      // no step, however short, lowers the cost
  iteration_limit,  // max_iterations
  budget,           // the evaluations of the whole fit are used up
  not_finite        // r or J is not finite at the start
};
const char* describe(EndReason reason);
bool is_minimum(EndReason reason);

struct Minimum {
  Eigen::VectorXd x;         // [n_variables]
  Eigen::VectorXd r;         // [n_residuals], at x
  Eigen::MatrixXd jacobian;  // [n_residuals, n_variables], at x
  double cost = 0;           // |r|^2
  EndReason reason = EndReason::not_finite;
  int iterations = 0;            // Jacobians factorised
  int evaluations = 0;           // evaluations of r, including those with a Jacobian
  int jacobian_evaluations = 0;  // jacobian evaluations of J
  int fallback = 0;              // 0: the first attempt; else which of the other scalings
};

/// Descends from `start`. x is finite if `start` is, whatever the reason. Requires at least one
/// variable and one residual; fewer residuals than variables are allowed.
Minimum minimise(const Residuals& residuals, const Eigen::VectorXd& start,
                 const SolverOptions& options = {});

}  // namespace jostle::inline fitting
