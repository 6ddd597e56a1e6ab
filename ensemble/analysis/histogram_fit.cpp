#include "ensemble/analysis/histogram_fit.hpp"

#include <algorithm>
#include <cmath>

#include "engine/numbers.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "ensemble/statistics/jackknife.hpp"
#include "ensemble/statistics/student_tests.hpp"
#include "fitting/intervals/distributions.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr double least_expected = 5;  // least expected of a bin, for chi2
constexpr double least_scatter =
    0.01;  // least scatter of counts, in Poisson's: less is none of counts
constexpr double doubted = significance_level;  // p below which the law is called wrong

struct Groups {
  std::vector<double> expected;  // over all realizations, [n_groups]
  std::vector<double> counts;    // [n_groups, n_realizations]
};

// Neighbouring bins joined until enough is expected in each; what is left over at the end joins
// the last.
Groups groups_of(const Histogram& histogram, const std::vector<double>& expected) {
  const std::uint32_t m = histogram.realizations;
  Groups groups;
  bool open = false;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    if (!open && (k == 0 || groups.expected.back() >= least_expected)) {
      groups.expected.push_back(0);
      groups.counts.resize(groups.counts.size() + m, 0.0);
    }
    groups.expected.back() += m * expected[k];
    double* const target = groups.counts.data() + groups.counts.size() - m;
    for (std::uint32_t r = 0; r < m; ++r) target[r] += histogram.counts[k * m + r];
    open = groups.expected.back() < least_expected;
  }
  if (groups.expected.size() > 1 && groups.expected.back() < least_expected) {
    groups.expected[groups.expected.size() - 2] += groups.expected.back();
    groups.expected.pop_back();
    const std::size_t last = groups.counts.size() - m;
    for (std::uint32_t r = 0; r < m; ++r) groups.counts[last - m + r] += groups.counts[last + r];
    groups.counts.resize(last);
  }
  return groups;
}

struct Goodness {
  double p = not_a_number;
  std::size_t bins = 0;
};

Goodness goodness(const Histogram& histogram, const std::vector<double>& expected,
                  std::size_t n_parameters) {
  const Groups groups = groups_of(histogram, expected);
  const std::size_t n = groups.expected.size();
  const std::uint32_t m = histogram.realizations;
  if (n <= n_parameters) return {};
  std::vector<double> totals(m, 0.0);
  double all = 0;
  for (std::size_t g = 0; g < n; ++g) {
    for (std::uint32_t r = 0; r < m; ++r) totals[r] += groups.counts[g * m + r];
  }
  for (const double total : totals) all += total;
  double between_groups = 0, within_groups = 0;
  for (std::size_t g = 0; g < n; ++g) {
    const double* const counts = groups.counts.data() + g * m;
    double sum = 0;
    for (std::uint32_t r = 0; r < m; ++r) sum += counts[r];
    between_groups += (sum - groups.expected[g]) * (sum - groups.expected[g]) / groups.expected[g];
    // Shares: the total count of a realization is independent of the law.
    for (std::uint32_t r = 0; r < m; ++r) {
      const double share = totals[r] / all, deviation = counts[r] - share * sum;
      within_groups += deviation * deviation / (groups.expected[g] * share);
    }
  }
  const auto dof = static_cast<double>(n - n_parameters);
  if (m < 2) return {chi_squared_tail(between_groups, dof), n};
  const double dof_within = static_cast<double>(n - 1) * (m - 1);
  const double scatter = std::max(within_groups / dof_within, least_scatter);
  return {fisher_tail(between_groups / dof / scatter, dof, dof_within), n};
}

std::string verdict(const std::string& law, const Goodness& found, std::uint32_t realizations) {
  if (std::isnan(found.p)) return law + " fitted; too few counts to test the law";
  const std::string test = finite_text("{} test over {} bins, {}", realizations > 1 ? "F" : "chi2",
                                       found.bins, p_text(found.p));
  return law + (found.p < doubted ? " does not hold: " : " is not rejected: ") + test;
}

// The mean over realizations, all or all but one.
std::vector<double> mean_counts(const Histogram& histogram, std::uint32_t left_out) {
  const std::uint32_t m = histogram.realizations;
  std::vector<double> mean;
  for (std::size_t k = 0; k < histogram.bins.size(); ++k) {
    double sum = 0;
    for (std::uint32_t r = 0; r < m; ++r) sum += r == left_out ? 0 : histogram.counts[k * m + r];
    mean.push_back(sum / (left_out < m ? m - 1 : m));
  }
  return mean;
}

// Jackknife errors, where every fit without a realization settles.
void add_errors(const Model& law, const Histogram& histogram, HistogramFit& found) {
  const std::uint32_t m = histogram.realizations;
  std::vector<std::vector<double>> left_out(found.values.size());
  for (std::uint32_t r = 0; r < m; ++r) {
    const CountsFit reduced_fit =
        fit_counts(law, histogram.bins, mean_counts(histogram, r), found.values);
    if (!reduced_fit.fault.empty()) {
      found.status += "; no errors: without one of the realizations " + reduced_fit.fault;
      return;
    }
    for (std::size_t j = 0; j < left_out.size(); ++j) left_out[j].push_back(reduced_fit.values[j]);
  }
  for (std::size_t j = 0; j < left_out.size(); ++j) found.errors[j] = jackknife_error(left_out[j]);
}

}  // namespace

HistogramFit fit_histogram(const Model& law, const Histogram& histogram) {
  const std::uint32_t m = histogram.realizations;
  const std::size_t n = law.parameters().size();
  HistogramFit found{std::vector(n, not_a_number), std::vector(n, not_a_number), not_a_number, ""};
  if (m == 0) return found.status = "no packing", found;
  const std::vector<double> counts = mean_counts(histogram, m);
  const auto filled = std::ranges::count_if(counts, [](double count) { return count != 0; });
  if (static_cast<std::size_t>(filled) <= n) {
    return found.status = "too few places that hold anything", found;
  }
  CountsFit best = fit_counts(law, histogram.bins, counts);
  if (!best.fault.empty()) return found.status = best.fault, found;
  found.values = std::move(best.values);
  const Goodness good = goodness(histogram, best.expected, n);
  found.p = good.p;
  found.status = verdict("the law " + law.name(), good, m);
  if (m >= 2) add_errors(law, histogram, found);
  return found;
}

}  // namespace jostle::inline ensemble
