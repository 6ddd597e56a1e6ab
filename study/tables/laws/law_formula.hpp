#pragma once

#include <memory>
#include <string>
#include <vector>

namespace jostle::inline study {

/// A word of a formula: a function where a parenthesis follows, else t, pi or a parameter.
struct FormulaName {
  std::string text;
  bool is_function = false;
};
/// The words of a formula, each once, in their order.
std::vector<FormulaName> names_in(const std::string& formula);

/// A formula of t and parameters, ready to be evaluated. For one thread: evaluating writes to it.
class LawFormula {
 public:
  /// Throws BadInput where the formula cannot be read. Its words must be t, pi, parameters, and
  /// functions_of_laws().
  LawFormula(const std::string& formula, const std::vector<std::string>& parameters);
  ~LawFormula();

  /// p: [n_parameters]. Not finite where the formula is not.
  double operator()(double t, const double* p);

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace jostle::inline study
