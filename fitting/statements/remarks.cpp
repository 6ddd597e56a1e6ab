#include "fitting/statements/remarks.hpp"

#include <sstream>
#include <string>

namespace jostle::inline fitting {

void remark_on_end(const FitOptions& options, Fit& fit) {
  if (!is_minimum(fit.reason) && fit.reason != EndReason::budget) {
    fit.remarks.push_back(std::string("The fit did not settle: ") + describe(fit.reason) + ".");
  }
  if (fit.dof == 0) {
    fit.remarks.push_back(std::string("The law has as many parameters as there are points: ") +
                          (fit.sigma_given ? "nothing tests it." : "errors cannot be estimated."));
  }
  if (options.profiles && fit.dof > 0 && fit.residual_sum == 0 && !fit.sigma_given) {
    fit.remarks.push_back(
        "The law meets every point exactly: without scatter there are no errors or intervals.");
  }
}

void remark_on_order(const Model& model, const ParameterValues& values, Fit& fit) {
  const ParameterValues canonical = model.canonical(values);
  if (canonical == values) return;
  std::ostringstream text;
  text.precision(4);
  text << "A fixed parameter keeps the others from the order of this law. In that order the same "
          "curve has";
  for (std::size_t j = 0; j < canonical.size(); ++j) {
    text << (j == 0 ? " " : ", ") << model.parameters()[j].name << " = " << canonical[j];
  }
  text << "; meanings of parameters that assume the order do not apply.";
  fit.remarks.push_back(text.str());
}

void remark_on_budget(long long allowed, std::size_t few_parameters, const FitOptions& options,
                      Fit& fit) {
  std::ostringstream text;
  text << "The fit stopped at its limit of evaluations (" << fit.total_evaluations
       << " evaluations of the law over the curve, for " << fit.n_points
       << (fit.n_bins > 0 ? " points in " + std::to_string(fit.n_bins) + " bins" : " points")
       << " and " << fit.n_free << (fit.n_free == 1 ? " parameter): " : " parameters): ")
       << (is_minimum(fit.reason) ? "unfinished intervals are open" : "no minimum was reached")
       << ". ";
  if (allowed < options.max_evaluations) {
    text << "For more than " << few_parameters << " parameters the limit is below "
         << options.max_evaluations << ", by the work of an evaluation. ";
  }
  text << "Fix parameters, or choose a law of fewer.";
  fit.remarks.push_back(text.str());
}

}  // namespace jostle::inline fitting
