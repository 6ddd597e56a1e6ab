// The solver against GSL and Ceres: digits and time, in turn, from the same starts with the same
// residuals and Jacobians. Then a bootstrap of an ensemble.
#include <ceres/ceres.h>
#include <fmt/format.h>
#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit_nlinear.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "bench/stopwatch.hpp"
#include "ensemble/statistics/resampled_fit.hpp"
#include "fitting/models/models.hpp"
#include "fitting/solver/curve_residuals.hpp"
#include "tests/fitting/nist_sets.hpp"

namespace jostle::bench {
namespace {

struct Solution {
  Eigen::VectorXd x;
  int iterations = 0, evaluations = 0, fallback = 0;
};
using Solver = std::function<Solution(const Residuals&, const Eigen::VectorXd&, double)>;

Solution solve_ours(const Residuals& residuals, const Eigen::VectorXd& start, double data_norm) {
  const Minimum minimum = minimise(residuals, start, {.data_norm = data_norm});
  return {minimum.x, minimum.iterations, minimum.evaluations, minimum.fallback};
}

Eigen::VectorXd copied(const gsl_vector* source) {
  Eigen::VectorXd copy(static_cast<Eigen::Index>(source->size));
  for (std::size_t i = 0; i < source->size; ++i) {
    copy[static_cast<Eigen::Index>(i)] = gsl_vector_get(source, i);
  }
  return copy;
}

// Tolerances at rounding: all solvers are asked for all the digits there are.
Solution solve_gsl(const Residuals& residuals, const Eigen::VectorXd& start, double) {
  const auto n = static_cast<std::size_t>(residuals.n_residuals());
  const auto p = static_cast<std::size_t>(residuals.n_variables());
  gsl_multifit_nlinear_parameters settings = gsl_multifit_nlinear_default_parameters();
  settings.trs = gsl_multifit_nlinear_trs_lmaccel;
  auto* work = gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &settings, n, p);
  gsl_multifit_nlinear_fdf function{};
  function.n = n;
  function.p = p;
  function.params = const_cast<Residuals*>(&residuals);
  function.f = [](const gsl_vector* x, void* parameters, gsl_vector* f) {
    const auto& r = *static_cast<const Residuals*>(parameters);
    Eigen::VectorXd values(r.n_residuals());
    r.values(copied(x), values);
    for (std::size_t i = 0; i < f->size; ++i) {
      gsl_vector_set(f, i, values[static_cast<Eigen::Index>(i)]);
    }
    return int{GSL_SUCCESS};
  };
  function.df = [](const gsl_vector* x, void* parameters, gsl_matrix* j) {
    const auto& r = *static_cast<const Residuals*>(parameters);
    Eigen::VectorXd values(r.n_residuals());
    Eigen::MatrixXd jacobian(r.n_residuals(), r.n_variables());
    r.values_and_jacobian(copied(x), values, jacobian);
    for (std::size_t i = 0; i < j->size1; ++i) {
      for (std::size_t k = 0; k < j->size2; ++k) {
        gsl_matrix_set(j, i, k,
                       jacobian(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)));
      }
    }
    return int{GSL_SUCCESS};
  };
  const auto view = gsl_vector_const_view_array(start.data(), p);
  Solution solution{start, 0, 0, 0};
  if (gsl_multifit_nlinear_init(&view.vector, &function, work) == GSL_SUCCESS) {
    int info = 0;
    gsl_multifit_nlinear_driver(2000, 1e-14, 1e-15, 0, nullptr, nullptr, &info, work);
    solution.x = copied(gsl_multifit_nlinear_position(work));
    solution.iterations = static_cast<int>(gsl_multifit_nlinear_niter(work));
    solution.evaluations = static_cast<int>(function.nevalf);
  }
  gsl_multifit_nlinear_free(work);
  return solution;
}

class CeresCost final : public ceres::CostFunction {
 public:
  explicit CeresCost(const Residuals& residuals) : residuals_(residuals) {
    set_num_residuals(static_cast<int>(residuals.n_residuals()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(residuals.n_variables()));
  }
  bool Evaluate(double const* const* parameters, double* values,
                double** jacobians) const override {
    const Eigen::Index n = residuals_.n_residuals(), p = residuals_.n_variables();
    const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(parameters[0], p);
    Eigen::VectorXd r(n);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::MatrixXd jacobian(n, p);
      residuals_.values_and_jacobian(x, r, jacobian);
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
          jacobians[0], n, p) = jacobian;
    } else {
      residuals_.values(x, r);
    }
    Eigen::Map<Eigen::VectorXd>(values, n) = r;
    return r.allFinite();
  }

 private:
  const Residuals& residuals_;
};

Solution solve_ceres(const Residuals& residuals, const Eigen::VectorXd& start, double) {
  Solution solution{start, 0, 0, 0};
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  CeresCost cost(residuals);
  ceres::Problem problem(ownership);
  problem.AddResidualBlock(&cost, nullptr, solution.x.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 2000;
  options.function_tolerance = 1e-16;
  options.gradient_tolerance = 1e-16;
  options.parameter_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  solution.iterations = static_cast<int>(summary.iterations.size());
  solution.evaluations = summary.num_residual_evaluations;
  return solution;
}

const std::array<std::pair<const char*, Solver>, 3> solvers = {
    {{"jostle", solve_ours}, {"GSL", solve_gsl}, {"Ceres", solve_ceres}}};

double digits(const Eigen::VectorXd& x, const std::vector<double>& certified) {
  double least = 16;
  for (std::size_t k = 0; k < certified.size(); ++k) {
    const double relative =
        std::abs(x[static_cast<Eigen::Index>(k)] - certified[k]) / std::abs(certified[k]);
    least = std::min(least, std::isfinite(relative) ? -std::log10(std::max(relative, 1e-16)) : -1);
  }
  return std::max(least, 0.0);
}

struct Measured {
  Solution solution;
  double seconds = 0;  // seconds of processor time, the median
};

// The solvers in turn, each for about a millisecond a turn.
std::array<Measured, 3> measure(const Residuals& residuals, const Eigen::VectorXd& start,
                                double data_norm) {
  std::array<Measured, 3> measured;
  std::array<std::vector<double>, 3> seconds;
  for (int turn = 0; turn < 7; ++turn) {
    for (std::size_t s = 0; s < solvers.size(); ++s) {
      const double began = thread_seconds();
      int times = 0;
      do {
        measured[s].solution = solvers[s].second(residuals, start, data_norm);
        ++times;
      } while (thread_seconds() - began < 1e-3);
      seconds[s].push_back((thread_seconds() - began) / times);
    }
  }
  for (std::size_t s = 0; s < solvers.size(); ++s) {
    std::ranges::sort(seconds[s]);
    measured[s].seconds = seconds[s][seconds[s].size() / 2];
  }
  return measured;
}

// Times of the others over ours, where they found the minimum to 4 digits at least.
struct Ratios {
  std::vector<double> by_solver[3];
  int missed[3] = {0, 0, 0};
};

void print_row(const std::string& label, const std::array<Measured, 3>& measured,
               const std::vector<double>& certified, Ratios& ratios) {
  fmt::print("{:<18}", label);
  for (std::size_t s = 0; s < measured.size(); ++s) {
    const double found = digits(measured[s].solution.x, certified);
    fmt::print("{:6.1f} {:5} {:5} {:8.1f}", found, measured[s].solution.iterations,
               measured[s].solution.evaluations, 1e6 * measured[s].seconds);
    if (found < 4) {
      ++ratios.missed[s];
    } else {
      ratios.by_solver[s].push_back(measured[s].seconds / measured[0].seconds);
    }
  }
  fmt::print("{}\n", measured[0].solution.fallback > 0 ? "  fallback" : "");
}

void print_summary(Ratios& ratios) {
  for (std::size_t s = 1; s < solvers.size(); ++s) {
    auto& ratio_list = ratios.by_solver[s];
    std::ranges::sort(ratio_list);
    double product = 0;
    for (const double ratio : ratio_list) product += std::log(ratio);
    fmt::print(
        "{}: {:.2f} times our time in the geometric mean ({:.2f} to {:.2f}), fewer than 4 "
        "digits on {} of 54\n",
        solvers[s].first, std::exp(product / static_cast<double>(ratio_list.size())),
        ratio_list.front(), ratio_list.back(), ratios.missed[s]);
  }
  fmt::print("jostle: fewer than 4 digits on {} of 54\n\n", ratios.missed[0]);
}

void print_header() {
  fmt::print("{:<18}", "set, start");
  for (const auto& [name, solver] : solvers) {
    fmt::print("{:>6} {:>5} {:>5} {:>8}", name, "iter", "eval", "us");
  }
  fmt::print("\n");
}

void nist_sets() {
  Ratios ratios;
  print_header();
  for (const auto& [name, model] : nist_models()) {
    const NistSet set = read_nist_set(NIST_SETS, name, model);
    const NistResiduals residuals(set);
    for (const int start : {1, 0}) {
      const Eigen::VectorXd b =
          Eigen::Map<const Eigen::VectorXd>(set.starts[start].data(), residuals.n_variables());
      print_row(fmt::format("{}, {}", name, start + 1), measure(residuals, b, set.y.norm()),
                set.parameters, ratios);
    }
  }
  print_summary(ratios);
}

// A deterministic scatter of deviation 1 that is no signal of the law.
double scatter(double t) {
  return std::sqrt(2.0) * std::sin(12.9898 * t * t + 78.233 * t);
}

double inverse_log(double t) {
  return 0.64 - 0.056 / (1 + 0.3 * std::log1p(t / 10));
}

void long_curve() {
  Curve curve;
  for (int t = 1; t <= 4000; ++t) {
    curve.t.push_back(t);
    curve.x.push_back(inverse_log(t) + 3e-4 * scatter(t));
  }
  const auto model = make_model("inverse_log");
  const ParameterValues start = {0.6, 0.03, 1, 50};
  const CurveResiduals residuals(*model, curve, start, {true, true, true, true});
  const Eigen::VectorXd u = residuals.to_variables(start);
  const auto measured = measure(residuals, u, residuals.data_norm());
  const Eigen::VectorXd best = measured[0].solution.x;
  Ratios ratios;
  print_header();
  print_row("inverse_log, 4000", measured, {best.data(), best.data() + best.size()}, ratios);
  for (std::size_t s = 0; s < solvers.size(); ++s) {
    Eigen::VectorXd r(residuals.n_residuals());
    residuals.values(measured[s].solution.x, r);
    fmt::print("  {}: residual sum {:.15e}, {:.2f} times our time\n", solvers[s].first,
               r.squaredNorm(), measured[s].seconds / measured[0].seconds);
  }
  fmt::print("\n");
}

void bootstrap() {
  RealizationCurves curves;
  curves.realizations = 200;
  for (int t = 1; t <= 4000; ++t) {
    curves.t.push_back(t);
    for (int r = 0; r < 200; ++r) {
      const double own = scatter(0.37 * r + 1e-4 * t);
      curves.values.push_back(inverse_log(t) + 2e-3 * own + 1e-3 * scatter(t + 5000.0 * r));
    }
  }
  const auto model = make_model("inverse_log");
  const auto found = fit(*model, mean_curve(curves), {.profiles = false});
  for (const int threads : {1, 2}) {
    const auto began = std::chrono::steady_clock::now();
    const ResampledErrors errors =
        resample(*model, curves, std::get<Fit>(found),
                 {.kind = Resampling::bootstrap, .count = 1000, .threads = threads});
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - began;
    fmt::print("bootstrap of 1000, 200 realizations x 4000 taps, {} threads: {:.2f} s, {} failed\n",
               threads, seconds.count(), errors.failed);
  }
}

}  // namespace
}  // namespace jostle::bench

int main() {
  gsl_set_error_handler_off();
  jostle::bench::nist_sets();
  jostle::bench::long_curve();
  jostle::bench::bootstrap();
}
