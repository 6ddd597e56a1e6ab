#include "fitting/intervals/memory.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/models/model.hpp"
#include "fitting/solver/decompositions.hpp"

namespace jostle::inline fitting {

namespace {

// Distance to the point before; points at one t are taken for neighbours.
std::vector<double> gaps_of(const std::vector<double>& t) {
  std::vector<double> gaps(t.size(), 0);
  double least = t.back() - t.front();
  for (std::size_t i = 1; i < t.size(); ++i) {
    gaps[i] = t[i] - t[i - 1];
    if (gaps[i] > 0) least = std::min(least, gaps[i]);
  }
  for (std::size_t i = 1; i < t.size(); ++i) gaps[i] = std::max(gaps[i], least);
  return gaps;
}

// Columns [n, any] divided by the root of the correlation matrix, by the innovations of a Kalman
// filter (Jones 1980, Technometrics 22, 389). Returns the log determinant of the matrix.
double whiten(const std::vector<double>& gaps, double time, double share,
              Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>& columns) {
  Eigen::RowVectorXd state = Eigen::RowVectorXd::Zero(columns.cols());
  double variance = share, determinant = 0;
  for (Eigen::Index i = 0; i < columns.rows(); ++i) {
    if (i > 0) {
      const double kept = std::exp(-gaps[static_cast<std::size_t>(i)] / time);
      state *= kept;
      variance = kept * kept * variance + share * (1 - kept * kept);
    }
    const double spread = variance + 1 - share;
    const Eigen::RowVectorXd surprise = columns.row(i) - state;
    state += variance / spread * surprise;
    variance *= (1 - share) / spread;
    columns.row(i) = surprise / std::sqrt(spread);
    determinant += std::log(spread);
  }
  return determinant;
}

struct Likelihood {
  double logarithm = 0, variance = 0;
};

// Restricted, with the variance at its most likely value.
Likelihood restricted(const std::vector<double>& gaps, double time, double share,
                      const Eigen::VectorXd& residuals, const Eigen::MatrixXd& basis) {
  const Eigen::Index n = basis.rows(), p = basis.cols();
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> columns(n, p + 1);
  columns << basis, residuals;
  const double determinant = share > 0 ? whiten(gaps, time, share, columns) : 0;
  const Eigen::MatrixXd normal = columns.leftCols(p).transpose() * columns.leftCols(p);
  const Eigen::VectorXd moment = columns.leftCols(p).transpose() * columns.col(p);
  const SymmetricSolution solution = solve_symmetric(normal, moment);
  const auto dof = static_cast<double>(n - p);
  const double squares = columns.col(p).squaredNorm() - moment.dot(solution.x);
  const double variance = std::max(squares / dof, 1e-300);
  const double information = solution.diagonal.array().abs().max(1e-300).log().sum();
  return {-0.5 * (determinant + information + dof * std::log(variance)), variance};
}

}  // namespace

Eigen::MatrixXd correlated(const std::vector<double>& t, const Memory& memory,
                           const Eigen::MatrixXd& vectors) {
  if (!(memory.time > 0)) return vectors;
  const std::vector<double> gaps = gaps_of(t);
  // The memory of earlier points, and of later points.
  Eigen::MatrixXd forward = vectors, backward = vectors;
  for (Eigen::Index i = 1; i < vectors.rows(); ++i) {
    forward.row(i) +=
        std::exp(-gaps[static_cast<std::size_t>(i)] / memory.time) * forward.row(i - 1);
  }
  for (Eigen::Index i = vectors.rows() - 1; i-- > 0;) {
    backward.row(i) +=
        std::exp(-gaps[static_cast<std::size_t>(i + 1)] / memory.time) * backward.row(i + 1);
  }
  return memory.share * (forward + backward - vectors) + (1 - memory.share) * vectors;
}

Memory residual_memory(const std::vector<double>& t, const Eigen::VectorXd& residuals,
                       const Eigen::MatrixXd& basis) {
  constexpr double evidence = 10;  // twice the gain of the likelihood
  const std::vector<double> gaps = gaps_of(t);
  const auto n = static_cast<double>(t.size());
  const Likelihood white = restricted(gaps, 0, 0, residuals, basis);
  Memory best{.variance = white.variance, .effective_size = n};
  if (t.size() < 3) return best;
  const double least = *std::min_element(gaps.begin() + 1, gaps.end());
  const double range = t.back() - t.front();
  if (!(least > 0) || !(range > 0)) return best;
  double highest = white.logarithm + 0.5 * evidence;
  const auto search = [&](double first, double last, std::size_t times,
                          std::initializer_list<double> shares) {
    for (const double time : geometric(first, last, times)) {
      for (const double share : shares) {
        const Likelihood likelihood = restricted(gaps, time, share, residuals, basis);
        if (!(likelihood.logarithm > highest)) continue;
        highest = likelihood.logarithm;
        best = {.time = time, .share = share, .variance = likelihood.variance, .effective_size = n};
      }
    }
  };
  search(0.3 * least, 10 * range, 20, {1, 0.6, 0.2, 0.05});
  if (!(best.time > 0)) return best;
  search(0.5 * best.time, 2 * best.time, 5, {1, 0.9, 0.75, 0.5, 0.35, 0.15, 0.1, 0.03});
  const Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(residuals.size(), 1);
  best.effective_size = n * n / (ones.transpose() * correlated(t, best, ones)).value();
  return best;
}

}  // namespace jostle::inline fitting
