#pragma once

#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fitting/models/model.hpp"

namespace jostle::inline study {

/// Between which a parameter stays, both ends exclusive.
struct ParameterBounds {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// A law that a user writes down: "X0 + a*log(1 + t/tau)" of t and of parameters with any names.
struct OwnLaw {
  std::string name = "own";
  std::string formula;
  /// Where every parameter begins, in the order in which they are reported.
  std::vector<std::pair<std::string, double>> start;
  std::map<std::string, ParameterBounds> bounds = {};
};

/// The law as a model. Its first starting point is the one given, further ones lie about it.
/// Parameters in which it is linear, and the units of all, are found from its values. Derivatives
/// are differences of fourth order, good to about 10 digits. Throws BadInput, naming every fault:
/// what cannot be read, functions that there are not, parameters without a start, a law without t.
std::unique_ptr<Model> make_own_law(const OwnLaw& law);

/// The functions that a formula may use, in alphabetic order.
std::vector<std::string> functions_of_laws();

}  // namespace jostle::inline study
