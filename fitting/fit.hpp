#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "fitting/curve.hpp"
#include "fitting/intervals/diagnostics.hpp"
#include "fitting/intervals/distributions.hpp"
#include "fitting/intervals/memory.hpp"
#include "fitting/models/model.hpp"
#include "fitting/solver/levenberg_marquardt.hpp"

namespace jostle::inline fitting {

struct FitOptions {
  /// The first start tried, [n_parameters]; without one, starts come from the data.
  std::optional<ParameterValues> start = std::nullopt;
  /// True if further starts from the data are tried after the first.
  bool multi_start = true;
  /// Parameters that keep a value, by name.
  std::map<std::string, double> fixed = {};
  /// True if intervals are computed: some hundred fits with one parameter held.
  bool profiles = true;
  /// True if a curve without realizations may have a memory, which is then found in its residuals.
  /// Not for points that are known to be independent.
  bool memory = true;
  /// Unit of t in remarks, such as "taps"; empty: not known.
  std::string t_unit = {};
  /// True if the law's limits are fitted too, and one reported where the law has reached it. Needs
  /// profiles.
  bool limits = true;
  /// Evaluations of the law over the curve, in all: searches and intervals. A derivative by one
  /// parameter is one. Fewer are allowed where their work would exceed max_work. A fit that reaches
  /// the end of them is marked as not settled, or has open intervals.
  long long max_evaluations = 200000;
  /// A law of more than 5 parameters has this limit of evaluations x points x parameters^2. An
  /// evaluation of such a law at a point takes as long as it has parameters, and so does a step.
  double max_work = 2e9;
  SolverOptions solver = {};
};

/// A confidence interval; an infinite end means that the data set no limit on this side (or not
/// within a factor 10^6 for a bounded parameter, 100 values or ranges of X for a value, else 10^4
/// errors), or that no settled fit closes it.
struct Interval {
  double lower = 0, upper = 0;
  bool closed() const;
};

/// Constraint of the data on a parameter, from its 95 % interval.
enum class Identifiability {
  fixed,             // by the user
  not_examined,      // no intervals asked for, or no degree of freedom left
  unfinished,        // open, because the fit stopped at its limit of evaluations
  identified,        // closed
  wide,              // closed, but long by the rule of docs/reference/laws.md
  bounded_below,     // no upper limit
  bounded_above,     // no lower limit, or none but the parameter's own bound
  not_identifiable,  // no limit at all
};

/// "identified", "bounded_below", ...: as JSON and tables have it.
const char* name_of(Identifiability identifiability);

struct Estimate {
  Parameter parameter;
  /// Infinite where a limit of the law that was fitted leaves none.
  double value = 0;
  /// For a linear problem whose points are independent; infinite without degrees of freedom, 0 for
  /// a fixed parameter.
  double standard_error = 0;
  /// Standard error with dependence: from the scatter of realizations, else from the memory of the
  /// residuals. For Student's t of the fit's error_dof, which makes half the 68 % interval of it;
  /// without intervals that of the linear problem.
  double error = 0;
  Interval intervals[2];  // at interval_levels, profiled or Student's; the value itself if fixed
  Identifiability identifiability = Identifiability::not_examined;
  std::string statement;  // this in words

  /// True if the data give it a value: fixed, or the 68 % interval is closed, or no interval was
  /// looked for. Other end points of least squares, at the limit of the search, are no measurement.
  bool has_value() const;
  /// Half of the 68 % interval, 0 if fixed; infinite where it is open or there is none.
  double half_width() const;
};

/// The law that another becomes where some of its parameters are 0 or infinite, as it was fitted.
struct LimitingFit {
  std::string name, formula;
  std::string statement;  // the limit, and the parameters that the data determine
  std::shared_ptr<const Model> law;
  std::vector<Estimate> estimates;  // [n_parameters of that law]
};

/// This fit in the parameters of another law that draws equal curves.
struct RestatedFit {
  std::string model, formula, source;
  std::vector<Estimate> estimates;  // [n_parameters of that law]
};

/// A fit and its statistics. No number is NaN; missing numbers are infinite.
struct Fit {
  std::string model, formula, source;
  std::vector<Estimate> estimates;  // [n_parameters]
  /// Finds combinations of two parameters that have both limits where neither parameter has.
  std::vector<Estimate> combinations;
  /// In the parameters of the equivalent law, where there is one and it has the curve.
  std::optional<RestatedFit> restated;
  /// The fitted law, where the least squares are at a limit of the law. Statistics, fitted values
  /// and errors refer to this law, and other parameters of the law have no value.
  std::optional<LimitingFit> limit;
  /// [n_parameters, n_parameters]; rows and columns of fixed parameters are 0. Scaled by the
  /// residual variance where no errors were given, absolute where they were.
  Eigen::MatrixXd covariance, correlation;

  std::size_t n_points = 0, n_free = 0, dof = 0;
  std::size_t n_realizations = 0;  // whose scatter gives the errors; 0: the residuals do
  double error_dof = 0;  // error dof of errors and intervals; infinite where errors are known
  /// True if realizations differ in shape: the intervals of all parameters, also restated and
  /// combined ones, are Student's t instead of profiles.
  bool has_student_intervals = false;
  std::size_t n_bins = 0;    // means that a long curve was fitted as; 0: its points
  bool sigma_given = false;  // by the curve, or by its realizations
  bool logarithmic = false;  // residuals are those of ln X
  double residual_sum = 0;   // residual sum of squares, weighted: chi2 where errors were given
  double reduced_chi2 = 0;   // residual_sum / dof; infinite without dof
  double r2 = 0;             // 1 - residual_sum / weighted sum about the weighted mean
  double condition = 0;      // condition of J^T J for columns of J of unit length
  /// [n_parameters]: variance of each over that with the others held (variance inflation factor); 0
  /// where it is fixed, or the curve does not depend on it.
  std::vector<double> variance_inflation;
  /// Ratio of errors by the scatter around the law to those by the errors given, which are taken as
  /// exact; 1 where chi2 is not significantly above 1, or errors come from elsewhere.
  double scatter_ratio = 1;
  RunsTest runs;             // runs of the residuals in order of t
  double weighted_size = 0;  // points of equal weight that would weigh as much: (sum w)^2 / sum w^2
  Memory memory;             // memory of the residuals; not sought with realizations
  double effective_size = 0;  // points that independent residuals would be worth
  double error_factor = 1;    // sqrt(n_points / effective_size): honest errors are longer

  std::vector<double> fitted;     // [n_points], the model at t
  std::vector<double> residuals;  // [n_points], X - fitted (ln X - ln fitted), unweighted
  EndReason reason = EndReason::not_finite;
  /// Diagnostics of the best minimum; `fallback` as in Minimum; `start`: the number of its start.
  int iterations = 0, evaluations = 0, jacobian_evaluations = 0, fallback = 0, start = 0;
  int starts_tried = 0;
  long long total_evaluations =
      0;  // evaluations of the law over the curve, in all descents of the fit
  std::vector<std::string> remarks;  // whatever a reader must know, a sentence each

  ParameterValues values() const;
};

enum class RefusalKind {
  bad_curve,
  bad_options,
  too_few_points,
  constant_curve,
  bad_domain,
  gaps,  // realizations have gaps that the law cannot do with
  no_start
};

/// Why there is no fit.
struct Refusal {
  RefusalKind kind = RefusalKind::bad_curve;
  std::string message;
};

/// Fits a model to a curve by least squares, weighted where the curve has errors.
std::variant<Fit, Refusal> fit(const Model& model, const Curve& curve,
                               const FitOptions& options = {});

/// fit() with the errors of a curve as they are given, also if they were computed from X.
std::variant<Fit, Refusal> fit_as_given(const Model& model, const Curve& curve,
                                        const FitOptions& options);

}  // namespace jostle::inline fitting
