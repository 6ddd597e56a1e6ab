#include "fitting/report.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace jostle {

namespace {

std::string number(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  std::ostringstream text;
  text << std::setprecision(digits) << value;
  return text.str();
}

// As many digits as an error of this size leaves, and two more.
std::string with_error(double value, double error) {
  int digits = 6;
  if (error > 0 && std::isfinite(error) && value != 0) {
    digits =
        std::clamp(static_cast<int>(std::ceil(std::log10(std::abs(value) / error))) + 2, 2, 12);
  }
  return number(value, digits);
}

std::string ends(const Interval& interval) {
  if (!std::isfinite(interval.lower) && !std::isfinite(interval.upper)) return "open";
  const auto end = [](double value) {
    return std::isfinite(value) ? number(value, 5) : std::string("open");
  };
  return end(interval.lower) + " .. " + end(interval.upper);
}

// Columns as wide as their longest cell; texts to the left, numbers to the right.
std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::ostringstream text;
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      const int width = static_cast<int>(widths[c]);
      const bool words = c == 0 || rows.front()[c] == "meaning";
      text << (c == 0 ? "  " : "   ") << (words ? std::left : std::right);
      text << std::setw(c + 1 < row.size() ? width : 0) << row[c];
    }
    text << '\n';
  }
  return text.str();
}

std::string parameter_table(const Fit& fit) {
  std::vector<std::vector<std::string>> rows = {{"", "value", "error", "68 %", "95 %", "meaning"}};
  for (const Estimate& e : fit.estimates) {
    const bool fixed = e.identifiability == Identifiability::fixed;
    const bool examined = e.identifiability != Identifiability::not_examined && !fixed;
    rows.push_back({e.parameter.name, with_error(e.value, e.standard_error),
                    fixed ? "fixed" : number(e.standard_error, 2),
                    examined ? ends(e.intervals[0]) : "-", examined ? ends(e.intervals[1]) : "-",
                    e.parameter.meaning});
  }
  return table(rows);
}

}  // namespace

std::string describe(const Fit& fit) {
  std::ostringstream text;
  text << fit.model << ": " << (fit.logarithmic ? "ln X = ln of " : "X = ") << fit.formula;
  if (!fit.source.empty()) text << "  [" << fit.source << "]";
  text << '\n' << parameter_table(fit);
  text << "  " << fit.n_points << " points, " << fit.n_free << " free parameters, "
       << (fit.sigma_given ? "errors given" : "errors from the scatter") << "; ended by "
       << describe(fit.reason) << " (" << fit.iterations << " iterations)\n";
  text << "  " << (fit.sigma_given ? "chi2 " : "residual sum ") << number(fit.residual_sum, 5)
       << ", reduced " << number(fit.reduced_chi2, 5) << ", R2 " << number(fit.r2, 6) << ", AIC "
       << number(fit.aic, 6) << ", BIC " << number(fit.bic, 6) << "; for "
       << number(fit.effective_size, 4) << " independent points AIC "
       << number(fit.aic_effective, 6) << ", BIC " << number(fit.bic_effective, 6) << ", errors x "
       << number(fit.error_factor, 3) << '\n';
  text << "  condition " << number(fit.condition, 3) << ", " << fit.runs.runs << " runs ("
       << number(fit.runs.expected, 4) << " expected, p = " << number(fit.runs.p, 2) << ")\n";
  for (const Estimate& estimate : fit.estimates) {
    if (estimate.identifiability > Identifiability::identified) {
      text << "  ! " << estimate.statement << '\n';
    }
  }
  for (const std::string& remark : fit.remarks) text << "  ! " << remark << '\n';
  return text.str();
}

std::string compare(const std::vector<Fit>& fits) {
  if (fits.empty()) return "";
  std::vector<const Fit*> order;
  for (const Fit& fit : fits) order.push_back(&fit);
  std::stable_sort(order.begin(), order.end(),
                   [](const Fit* a, const Fit* b) { return a->aic < b->aic; });
  std::vector<std::vector<std::string>> rows = {
      {"model", "free", "reduced chi2", "R2", "AIC", "above best", "BIC", "runs p"}};
  for (const Fit* fit : order) {
    // Likelihoods of X and of ln X are not on one scale.
    rows.push_back({fit->model + (fit->logarithmic ? " (ln X)" : ""), std::to_string(fit->n_free),
                    number(fit->reduced_chi2, 4), number(fit->r2, 6), number(fit->aic, 6),
                    number(fit->aic - order.front()->aic, 3), number(fit->bic, 6),
                    number(fit->runs.p, 2)});
  }
  return table(rows);
}

}  // namespace jostle
