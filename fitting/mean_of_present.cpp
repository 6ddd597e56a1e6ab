#include "fitting/mean_of_present.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "fitting/solver/decompositions.hpp"

namespace jostle::inline fitting {

namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// A two-way layout, [n, m], 0 where there is no value.
struct Layout {
  Rows present;            // 1 or 0
  Eigen::VectorXd count;   // count of realizations at a t, [n]
  Eigen::MatrixXd normal;  // normal matrix of the offsets, with sum 0, [m, m]
};

Layout layout_of(const Rows& present) {
  Layout layout{present, present.rowwise().sum(), {}};
  const Eigen::Index m = present.cols();
  const Rows shares = layout.count.cwiseInverse().asDiagonal() * present;
  layout.normal = -(present.transpose() * shares);
  layout.normal.diagonal() += present.colwise().sum().transpose();
  layout.normal.array() += 1.0 / static_cast<double>(m);
  return layout;
}

// Deviations [n, m] of a mean and of offsets, 0 where there is no value: the offsets [m] and the
// means [n] that the values of one column set give.
struct Effects {
  Eigen::VectorXd mean, offset;
};

Effects effects(const Layout& layout, const Rows& values) {
  const Eigen::VectorXd plain = values.rowwise().sum().cwiseQuotient(layout.count);
  const Eigen::VectorXd right =
      values.colwise().sum().transpose() - layout.present.transpose() * plain;
  const Eigen::VectorXd offset = least_squares(layout.normal, right);
  return {plain - (layout.present * offset).cwiseQuotient(layout.count), offset};
}

// Noise, enlarged by the share of it that the mean of its t took, and without a sum over t.
Rows enlarged_noise(const Layout& layout, const Rows& values, const Effects& found) {
  const auto m = static_cast<double>(values.cols());
  Rows noise = values;
  noise.colwise() -= found.mean;
  noise.rowwise() -= found.offset.transpose();
  for (Eigen::Index i = 0; i < noise.rows(); ++i) {
    const double n = layout.count[i];
    noise.row(i) *= std::sqrt(n / (n - 1) * (m - 1) / m);
  }
  noise = noise.cwiseProduct(layout.present);
  const Eigen::VectorXd means =
      noise.colwise().sum().transpose().cwiseQuotient(layout.present.colwise().sum().transpose());
  noise.rowwise() -= means.transpose();
  return noise.cwiseProduct(layout.present);
}

// n_realizations times the change of the mean where the weight of a realization grows, [n, m]: what
// its noise does to means and offsets, and its own offset.
Rows influences(const Layout& layout, const Rows& noise, const Eigen::VectorXd& offset) {
  const auto m = static_cast<double>(noise.cols());
  const Rows shares = layout.count.cwiseInverse().asDiagonal() * noise;
  const Eigen::MatrixXd moved =
      least_squares_of_columns(layout.normal, -(layout.present.transpose() * shares));
  Rows influence = layout.count.cwiseInverse().asDiagonal() * (layout.present * moved);
  influence = m * (shares - influence);
  influence.rowwise() += offset.transpose();
  const Eigen::VectorXd means = influence.rowwise().mean();
  influence.colwise() -= means;
  return influence;
}

// A matrix without one of its columns.
Rows without_column(const Rows& all, Eigen::Index left_out) {
  const Eigen::Index n_after = all.cols() - 1 - left_out;
  Rows kept(all.rows(), all.cols() - 1);
  kept.leftCols(left_out) = all.leftCols(left_out);
  kept.rightCols(n_after) = all.rightCols(n_after);
  return kept;
}

// Like influences(), by leaving each realization out (the jackknife): offsets of realizations that
// remember take part in the noise that the mean of those which stay has, and their influence is
// larger than for a small change of weight.
Rows jackknife_influences(const Rows& present, const Rows& values, const Effects& found) {
  Rows influence(values.rows(), values.cols());
  for (Eigen::Index r = 0; r < values.cols(); ++r) {
    const Effects reduced_effects =
        effects(layout_of(without_column(present, r)), without_column(values, r));
    influence.col(r) = static_cast<double>(values.cols() - 1) * (found.mean - reduced_effects.mean);
  }
  const Eigen::VectorXd means = influence.rowwise().mean();
  influence.colwise() -= means;
  return influence;
}

// Above, both influences differ by few percent, and leaving out takes long.
constexpr Eigen::Index most_left_out = 20;

}  // namespace

std::vector<std::vector<std::size_t>> linked_groups(const std::vector<double>& values,
                                                    std::size_t n_realizations) {
  std::vector<std::size_t> group(n_realizations);
  for (std::size_t r = 0; r < n_realizations; ++r) group[r] = r;
  for (std::size_t begin = 0; begin < values.size(); begin += n_realizations) {
    std::size_t first = n_realizations;
    for (std::size_t r = 0; r < n_realizations; ++r) {
      if (std::isnan(values[begin + r])) continue;
      if (first == n_realizations) first = r;
      if (group[r] == group[first]) continue;
      const std::size_t joined = group[r];
      std::replace(group.begin(), group.end(), joined, group[first]);
    }
  }
  std::vector<std::vector<std::size_t>> groups(n_realizations);
  for (std::size_t r = 0; r < n_realizations; ++r) groups[group[r]].push_back(r);
  std::erase_if(groups, [](const auto& element) { return element.empty(); });
  return groups;
}

namespace {

// True if the offsets of the others are known from each other whichever realization is left out.
bool links_without_any(const std::vector<double>& values, std::size_t n_realizations) {
  for (std::size_t left_out = 0; left_out < n_realizations; ++left_out) {
    std::vector<double> remaining;
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (k % n_realizations != left_out) remaining.push_back(values[k]);
    }
    if (linked_groups(remaining, n_realizations - 1).size() > 1) return false;
  }
  return true;
}

}  // namespace

Curve mean_of_present(std::vector<double> t, std::vector<double> values,
                      std::size_t n_realizations) {
  const auto is_missing = [](double value) { return std::isnan(value); };
  if (std::none_of(values.begin(), values.end(), is_missing)) {
    return mean_curve(std::move(t), std::move(values), n_realizations);
  }
  const auto n = static_cast<Eigen::Index>(t.size()), m = static_cast<Eigen::Index>(n_realizations);
  // Differences from one value keep the digits of small fluctuations.
  const double base = *std::find_if_not(values.begin(), values.end(), is_missing);
  Rows present(n, m), given(n, m);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index r = 0; r < m; ++r) {
      const double value = values[static_cast<std::size_t>(i * m + r)];
      present(i, r) = std::isnan(value) ? 0 : 1;
      given(i, r) = std::isnan(value) ? 0 : value - base;
    }
  }
  const Layout layout = layout_of(present);
  const Effects found = effects(layout, given);
  const bool leaves_out = m <= most_left_out && links_without_any(values, n_realizations);
  const Rows influence =
      leaves_out ? jackknife_influences(present, given, found)
                 : influences(layout, enlarged_noise(layout, given, found), found.offset);
  Curve curve{.t = std::move(t), .x = {}, .values = std::move(values)};
  curve.n_realizations = n_realizations;
  curve.offsets.assign(found.offset.begin(), found.offset.end());
  for (Eigen::Index i = 0; i < n; ++i) {
    curve.x.push_back(base + found.mean[i]);
    for (Eigen::Index r = 0; r < m; ++r) {
      const auto place = static_cast<std::size_t>(i * m + r);
      curve.present.push_back(present(i, r) > 0);
      curve.values[place] = curve.x.back() + influence(i, r);
    }
  }
  return curve;
}

}  // namespace jostle::inline fitting
