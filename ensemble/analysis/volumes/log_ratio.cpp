#include "ensemble/analysis/volumes/log_ratio.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "fitting/solver/decompositions.hpp"

namespace jostle::inline ensemble {

namespace {

/// ln(1 + exp(u)), for any u.
double softplus(double u) {
  return std::max(u, 0.0) + std::log1p(std::exp(-std::abs(u)));
}

/// Coefficients of a polynomial of n terms in (V - centre) / scale by Newton's method; the
/// likelihood has one maximum, and steps are halved where they would lower it.
Eigen::VectorXd fitted(Eigen::Index n, std::span<const double> first,
                       std::span<const double> second, const VolumeBins& bins, double centre,
                       double scale) {
  constexpr int most_steps = 60;
  const auto terms = [&](std::size_t k) {
    Eigen::VectorXd x = Eigen::VectorXd::Ones(n);
    for (Eigen::Index i = 1; i < n; ++i) x[i] = x[i - 1] * (bins.middle(k) - centre) / scale;
    return x;
  };
  const auto log_likelihood = [&](const Eigen::VectorXd& c) {
    double sum = 0;
    for (std::size_t k = 0; k < first.size(); ++k) {
      if (first[k] + second[k] == 0) continue;
      const double u = c.dot(terms(k));
      sum -= second[k] * softplus(-u) + first[k] * softplus(u);
    }
    return sum;
  };
  Eigen::VectorXd c = Eigen::VectorXd::Zero(n);
  double best = log_likelihood(c);
  for (int step = 0; step < most_steps; ++step) {
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
    Eigen::MatrixXd curvature = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t k = 0; k < first.size(); ++k) {
      const double all = first[k] + second[k];
      if (all == 0) continue;
      const Eigen::VectorXd x = terms(k);
      const double p = 1 / (1 + std::exp(-c.dot(x)));
      gradient += (second[k] - all * p) * x;
      curvature += all * p * (1 - p) * x * x.transpose();
    }
    Eigen::VectorXd move = least_squares(curvature, gradient);
    double reached = log_likelihood(c + move);
    for (int halved = 0; halved < 30 && !(reached >= best); ++halved) {
      move *= 0.5;
      reached = log_likelihood(c + move);
    }
    if (!(reached >= best)) break;
    c += move;
    best = reached;
    if (move.cwiseAbs().maxCoeff() < 1e-10) break;
  }
  return c;
}

}  // namespace

LogRatio log_ratio(std::span<const double> first, std::span<const double> second,
                   const VolumeBins& bins, double centre, double scale) {
  return {fitted(2, first, second, bins, centre, scale)[1] / scale,
          2 * fitted(3, first, second, bins, centre, scale)[2] / scale};
}

double shared(std::span<const double> first, std::span<const double> second) {
  double sum = 0;
  for (std::size_t k = 0; k < first.size(); ++k) sum += std::min(first[k], second[k]);
  return sum;
}

}  // namespace jostle::inline ensemble
