#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "ensemble/analysis/table.hpp"
#include "results/file/results_file.hpp"

namespace jostle::inline study {

/// half_width() of 68 % intervals, with Student's factors that are computed once each.
class HalfWidths {
 public:
  double operator()(double error, double dof);

 private:
  std::map<double, double> factors_;
};

/// Half the 68 % interval of the mean over realizations after each tap, [n_taps].
std::vector<double> half_widths(const EnsembleSeries& series);

/// "0.5591(14)": the mean over realizations after a tap, with half its 68 % interval.
std::string mean_text(const EnsembleSeries& series, std::size_t tap);

/// The table as people read it: where a quantity x has the standard error x_error and its degrees
/// of freedom x_dof (along the same axes, or one for all), x_half_width replaces both: half the
/// width of the 68 % interval by Student's t. A note describes errors and intervals.
Table with_half_widths(Table table);

}  // namespace jostle::inline study
