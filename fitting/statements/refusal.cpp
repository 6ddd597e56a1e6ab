#include "fitting/statements/refusal.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace jostle::inline fitting {

namespace {

bool inside(const Parameter& parameter, double value) {
  return std::isfinite(value) && value > parameter.lower && value < parameter.upper;
}

// "B = -1 is outside its range (0, inf)"
std::string out_of_range(const Parameter& parameter, double value) {
  std::ostringstream text;
  text << parameter.name << " = " << value << " is outside its range (" << parameter.lower << ", "
       << parameter.upper << ")";
  return text.str();
}

}  // namespace

std::optional<Refusal> refuse_options(const Model& model, const FitOptions& options) {
  const std::vector<Parameter>& parameters = model.parameters();
  for (const auto& [name, value] : options.fixed) {
    const auto found = std::find_if(parameters.begin(), parameters.end(),
                                    [&](const Parameter& p) { return p.name == name; });
    if (found == parameters.end()) {
      std::string names;
      for (const Parameter& p : parameters) names += (names.empty() ? "" : ", ") + p.name;
      return Refusal{RefusalKind::bad_options,
                     model.name() + " has no parameter " + name + " (it has " + names + ")"};
    }
    if (!inside(*found, value))
      return Refusal{RefusalKind::bad_options, out_of_range(*found, value)};
  }
  if (!options.start) return std::nullopt;
  if (options.start->size() != parameters.size()) {
    return Refusal{RefusalKind::bad_options, "a start needs one value for each parameter"};
  }
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    if (!inside(parameters[j], (*options.start)[j])) {
      return Refusal{RefusalKind::bad_options, out_of_range(parameters[j], (*options.start)[j])};
    }
  }
  return std::nullopt;
}

std::optional<Refusal> refuse_curve(const Model& model, const Curve& curve, std::size_t n_free) {
  std::string text;
  for (const std::string& fault : faults(curve)) text += (text.empty() ? "" : "; ") + fault;
  if (!text.empty()) return Refusal{RefusalKind::bad_curve, text};
  const std::size_t places = std::set<double>(curve.t.begin(), curve.t.end()).size();
  if (places < n_free) {
    std::ostringstream few;
    few << curve.t.size() << (curve.t.size() == 1 ? " point" : " points") << " at " << places
        << " different t cannot determine " << n_free
        << " parameters: fix some, or use a wider range";
    return Refusal{RefusalKind::too_few_points, few.str()};
  }
  const auto [low, high] = std::minmax_element(curve.x.begin(), curve.x.end());
  if (*high - *low <= 1e-14 * std::max(std::abs(*low), std::abs(*high))) {
    std::ostringstream constant;
    constant << "X is constant (" << *low << "): it determines no law, only its own value";
    return Refusal{RefusalKind::constant_curve, constant.str()};
  }
  if (model.residual_scale() == ResidualScale::logarithmic && !curve.present.empty()) {
    return Refusal{RefusalKind::gaps,
                   "realizations have gaps, and their levels are taken in X, but " + model.name() +
                       " is fitted in ln X: leave out the rows with gaps"};
  }
  text = model.refusal(curve);
  if (!text.empty()) return Refusal{RefusalKind::bad_domain, text};
  return std::nullopt;
}

}  // namespace jostle::inline fitting
