#include "fitting/report.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace jostle::inline fitting {

namespace {

std::string number(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  std::ostringstream text;
  text << std::setprecision(digits) << value;
  return text.str();
}

// "0.5841 +- 0.0012", "(2.05 +- 0.74)e-06": two digits of the error, as many decimals of the value.
std::string with_error(double value, double error) {
  if (!(error > 0) || !std::isfinite(error)) return number(value, 6);
  const double size = std::max(std::abs(value), error);
  const int power = static_cast<int>(std::floor(std::log10(size)));
  const int last = static_cast<int>(std::floor(std::log10(error))) - 1;  // digit of the error
  const bool plain = power >= -3 && power <= 5 && last >= -12 && last <= 0;
  std::ostringstream text;
  const double scale = plain ? 1 : std::pow(10.0, -power);
  text << std::fixed << std::setprecision(std::max(plain ? -last : power - last, 0));
  if (!plain) text << '(';
  text << value * scale << " +- " << error * scale;
  if (!plain) text << ")e" << power;
  return text.str();
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
      const std::string& header = rows.front()[c];
      const bool words = c == 0 || header == "meaning" || header == "verdict";
      text << (c == 0 ? "  " : "   ") << (words ? std::left : std::right);
      text << std::setw(c + 1 < row.size() ? width : 0) << row[c];
    }
    text << '\n';
  }
  return text.str();
}

std::string value_text(const Estimate& estimate) {
  if (estimate.identifiability == Identifiability::fixed) {
    return number(estimate.value, 6) + " fixed";
  }
  if (!estimate.has_value()) return "-";
  if (!estimate.intervals[0].closed()) return number(estimate.value, 4) + ", error unknown";
  return with_error(estimate.value, estimate.half_width());
}

const char* verdict_text(Identifiability identifiability) {
  switch (identifiability) {
    case Identifiability::fixed:
      return "fixed";
    case Identifiability::not_examined:
      return "not examined";
    case Identifiability::identified:
      return "identified";
    case Identifiability::wide:
      return "wide";
    case Identifiability::bounded_below:
      return "only a lower limit";
    case Identifiability::bounded_above:
      return "only an upper limit";
    case Identifiability::not_identifiable:
      return "not identifiable";
  }
  return "";
}

std::string parameter_table(const Fit& fit, ReportDetail detail) {
  const bool full = detail == ReportDetail::full;
  std::vector<std::vector<std::string>> rows = {{"", "value +- error", "95 %", "verdict"}};
  if (full) rows[0].insert(rows[0].end(), {"68 %", "linear error"});
  rows[0].push_back("meaning");
  std::vector<Estimate> shown = fit.estimates;
  shown.insert(shown.end(), fit.combinations.begin(), fit.combinations.end());
  for (const Estimate& e : shown) {
    const bool examined = e.identifiability > Identifiability::not_examined;
    rows.push_back({e.parameter.name, value_text(e), examined ? ends(e.intervals[1]) : "-",
                    verdict_text(e.identifiability)});
    if (full) {
      rows.back().push_back(examined ? ends(e.intervals[0]) : "-");
      rows.back().push_back(number(e.standard_error, 2));
    }
    rows.back().push_back(e.parameter.meaning);
  }
  return table(rows);
}

// What the errors rest on.
std::string basis_of_errors(const Fit& fit) {
  std::ostringstream text;
  text << fit.n_points << " points";
  if (fit.n_bins > 0) text << " fitted as " << fit.n_bins << " means over at most 1 % of t";
  text << "; errors at 68 %, from ";
  if (fit.n_realizations > 0) {
    text << "the scatter of " << fit.n_realizations << " realizations";
  } else {
    text << (fit.sigma_given ? "the errors given" : "the scatter about the law");
  }
  if (fit.error_dof < 100) {
    text << ", Student's t of " << number(std::max(fit.error_dof, 0.0), 3) << " degrees of freedom";
  }
  return text.str();
}

std::string statistics(const Fit& fit) {
  std::ostringstream text;
  text << "  " << fit.n_free << " free parameters; ended by " << describe(fit.reason) << " ("
       << fit.iterations << " iterations)\n";
  text << "  " << (fit.sigma_given ? "chi2 " : "residual sum ") << number(fit.residual_sum, 5)
       << ", AIC " << number(fit.aic, 6) << ", BIC " << number(fit.bic, 6) << "; for "
       << number(fit.effective_size, 4) << " independent points AIC "
       << number(fit.aic_effective, 6) << ", BIC " << number(fit.bic_effective, 6) << "; by weight "
       << number(fit.weighted_size, 4) << " points\n";
  text << "  condition " << number(fit.condition, 3) << ", " << fit.runs.runs << " runs ("
       << number(fit.runs.expected, 4) << " expected, p = " << number(fit.runs.p, 2) << ")\n";
  return text.str();
}

}  // namespace

std::string describe(const Fit& fit, ReportDetail detail) {
  std::ostringstream text;
  text << fit.model << ": " << (fit.logarithmic ? "ln X = ln of " : "X = ") << fit.formula;
  if (!fit.source.empty()) text << "  [" << fit.source << "]";
  text << '\n'
       << parameter_table(fit, detail) << "  " << basis_of_errors(fit) << "; reduced "
       << (fit.sigma_given ? "chi2 " : "residual sum ") << number(fit.reduced_chi2, 3) << ", R2 "
       << number(fit.r2, 4) << '\n';
  if (detail == ReportDetail::full) text << statistics(fit);
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

}  // namespace jostle::inline fitting
