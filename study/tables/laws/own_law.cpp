#include "study/tables/laws/own_law.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "ensemble/statistics/finite_text.hpp"
#include "fitting/models/models.hpp"
#include "fitting/solver/grid.hpp"
#include "fitting/solver/projection.hpp"
#include "study/bad_input.hpp"
#include "study/tables/laws/law_formula.hpp"
#include "study/tables/laws/law_traits.hpp"

namespace jostle::inline study {

namespace {

constexpr double step = 1e-4;  // relative rounding of a difference

std::vector<std::string> names_of(const OwnLaw& law) {
  std::vector<std::string> names;
  for (const auto& [name, value] : law.start) names.push_back(name);
  return names;
}

std::string listed(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

// A name that a formula reads as one word.
bool is_word(const std::string& name) {
  const std::vector<FormulaName> words = names_in(name);
  return words.size() == 1 && words[0].text == name;
}

bool is_parameter(const FormulaName& name) {
  return !name.is_function && name.text != "t" && name.text != "pi" &&
         !contains(functions_of_laws(), name.text);
}

// Throws BadInput for a formula of known functions that cannot be read.
void require_readable(const std::string& formula) {
  std::vector<std::string> parameters;
  for (const FormulaName& name : names_in(formula)) {
    if (name.is_function != contains(functions_of_laws(), name.text)) return;
    if (is_parameter(name)) parameters.push_back(name.text);
  }
  const LawFormula read(formula, parameters);
}

std::vector<std::string> faults_of_the_formula(const OwnLaw& law) {
  std::vector<std::string> faults;
  const std::vector<std::string> known = functions_of_laws(), parameters = names_of(law);
  bool has_t = false;
  std::vector<std::string> without_start;
  for (const FormulaName& name : names_in(law.formula)) {
    if (name.is_function && !contains(known, name.text)) {
      faults.push_back(fmt::format("there is no function {}; there are {}{}", name.text,
                                   listed(known),
                                   contains(parameters, name.text) ? "; a product needs a *" : ""));
    } else if (!name.is_function && name.text == "t") {
      has_t = true;
    } else if (!name.is_function && contains(known, name.text)) {
      faults.push_back(
          fmt::format("the function {0} needs parentheses with its argument: {0}(...)", name.text));
    } else if (is_parameter(name) && !contains(parameters, name.text)) {
      without_start.push_back(name.text);
    }
  }
  if (without_start.size() == 1) {
    faults.push_back(
        fmt::format("the parameter {0} has no start: give a value, as {0}=1, from "
                    "which the search begins",
                    without_start[0]));
  } else if (!without_start.empty()) {
    faults.push_back(
        fmt::format("the parameters {} have no start: give values, as {}=1, from which the search "
                    "begins",
                    listed(without_start), fmt::join(without_start, "=1,")));
  }
  if (!has_t) faults.push_back("there is no t in it: a law is a function of t");
  return faults;
}

std::vector<std::string> faults_of_the_names(const OwnLaw& law) {
  std::vector<std::string> faults;
  std::vector<std::string> words;
  for (const FormulaName& name : names_in(law.formula)) {
    if (!name.is_function) words.push_back(name.text);
  }
  if (law.start.empty() && std::ranges::none_of(names_in(law.formula), is_parameter)) {
    faults.push_back("it has no parameter to fit: name at least one, with its start");
  }
  std::set<std::string> seen;
  for (const auto& [name, value] : law.start) {
    if (!is_word(name)) {
      faults.push_back(fmt::format(
          "\"{}\" is no name of a parameter: letters, digits and _, a letter first", name));
    } else if (name == "t" || name == "pi" || contains(functions_of_laws(), name)) {
      faults.push_back(fmt::format("no parameter can be called {}: that is {}", name,
                                   name == "t"    ? "the curve's t"
                                   : name == "pi" ? "the number pi"
                                                  : "a function"));
    } else if (!contains(words, name)) {
      faults.push_back(fmt::format("{} has a start, but is not in the law", name));
    }
    if (!seen.insert(name).second) faults.push_back(fmt::format("{} has two starts", name));
    if (!std::isfinite(value)) faults.push_back(fmt::format("the start of {} is not finite", name));
  }
  for (const auto& [name, bounds] : law.bounds) {
    const auto found = std::ranges::find(law.start, name, &std::pair<std::string, double>::first);
    if (found == law.start.end()) {
      faults.push_back(fmt::format("{} has bounds, but no start", name));
    } else if (!(found->second > bounds.lower && found->second < bounds.upper)) {
      faults.push_back(fmt::format("{} begins at {}, which is not between its bounds {} and {}",
                                   name, found->second, bounds.lower, bounds.upper));
    }
  }
  if (!is_word(law.name) || make_model(law.name) || law.name == "all") {
    faults.push_back(fmt::format("the law cannot be called \"{}\": {}", law.name,
                                 is_word(law.name)
                                     ? "docs/reference/laws.md uses this name; choose another"
                                     : "a name has letters, digits and _, a letter first"));
  }
  return faults;
}

class FormulaModel final : public Model {
 public:
  explicit FormulaModel(const OwnLaw& law);

  std::string name() const override { return law_.name; }
  std::string formula() const override { return law_.formula; }
  std::string source() const override { return "own law"; }
  const std::vector<Parameter>& parameters() const override { return parameters_; }
  double value(double t, const double* p) const override { return evaluator()(t, p); }
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  std::string refusal(const Curve& curve) const override;
  std::vector<std::vector<double>> candidates(const Curve& curve) const override;
  std::vector<ParameterValues> starts(const Curve& curve, std::span<const double> fixed,
                                      std::size_t n) const override;

 private:
  LawFormula& evaluator() const;
  double difference_step(std::size_t j, double p) const;

  OwnLaw law_;
  std::shared_ptr<const int> identity_ = std::make_shared<const int>(0);
  ParameterValues start_;
  std::vector<Parameter> parameters_;
};

FormulaModel::FormulaModel(const OwnLaw& law) : law_(law) {
  for (const auto& [name, value] : law.start) {
    const auto found = law.bounds.find(name);
    const ParameterBounds bounds = found == law.bounds.end() ? ParameterBounds{} : found->second;
    parameters_.push_back({.name = name,
                           .meaning = finite_text("begun at {}", value),
                           .lower = bounds.lower,
                           .upper = bounds.upper});
    start_.push_back(value);
  }
  const bool has_units =
      find_traits([this](double t, const double* p) { return value(t, p); }, parameters_);
  for (Parameter& parameter : parameters_) {
    if (has_units || parameter.unit != ParameterUnit::none) continue;
    parameter.meaning += " (the formula does not determine its unit)";
  }
}

// A formula is evaluated in memory of its own, and fits of one model run on many threads: each
// keeps a parser of the law that it was last at.
LawFormula& FormulaModel::evaluator() const {
  thread_local std::shared_ptr<const int> owner;
  thread_local std::optional<LawFormula> kept;
  if (owner != identity_) {
    kept.emplace(law_.formula, names_of(law_));
    owner = identity_;
  }
  return *kept;
}

// A share of the parameter, or of its distance from a bound; where it passes through 0, of its
// start.
double FormulaModel::difference_step(std::size_t j, double p) const {
  const double room = std::min(p - parameters_[j].lower, parameters_[j].upper - p);
  if (std::isfinite(room)) return step * room;
  const double start = start_[j] == 0 ? 1 : std::abs(start_[j]);
  return step * std::max(std::abs(p), parameters_[j].linear ? start : 1e-3 * start);
}

double FormulaModel::value_and_gradient(double t, const double* p, double* gradient) const {
  LawFormula& law = evaluator();
  ParameterValues moved(p, p + parameters_.size());
  for (std::size_t j = 0; j < moved.size(); ++j) {
    const double h = difference_step(j, p[j]);
    const auto value_at = [&](double steps) {
      moved[j] = p[j] + steps * h;
      return law(t, moved.data());
    };
    gradient[j] = (8 * (value_at(1) - value_at(-1)) - (value_at(2) - value_at(-2))) / (12 * h);
    moved[j] = p[j];
  }
  return law(t, p);
}

std::string FormulaModel::refusal(const Curve& curve) const {
  for (double t : curve.t) {
    if (std::isfinite(value(t, start_.data()))) continue;
    return fmt::format(
        "the law is not finite where it starts, at t = {}: begin with other values, or leave such "
        "t out",
        t);
  }
  return "";
}

// About the start on both sides, by factors up to 1000; the fewer values, the more parameters have
// to be combined.
std::vector<std::vector<double>> FormulaModel::candidates(const Curve&) const {
  const auto nonlinear = std::ranges::count(parameters_, false, &Parameter::linear);
  constexpr std::size_t sizes[] = {25, 25, 13, 7, 5};
  const std::size_t n = nonlinear < 5 ? sizes[nonlinear] : 3;
  std::vector<std::vector<double>> all;
  for (std::size_t j = 0; j < parameters_.size(); ++j) {
    std::vector<double> values = {-1, 0, 1};
    if (start_[j] != 0) {
      values = geometric(1e-3 * std::abs(start_[j]), 1e3 * std::abs(start_[j]), n);
      if (start_[j] < 0) {
        std::ranges::reverse(values);
        for (double& value : values) value = -value;
      }
    }
    std::erase_if(values, [&](double value) {
      return !(value > parameters_[j].lower && value < parameters_[j].upper);
    });
    if (values.empty()) values = {start_[j]};
    all.push_back(std::move(values));
  }
  return all;
}

// The start as it is given, then with the linear parameters solved for, then those about it.
std::vector<ParameterValues> FormulaModel::starts(const Curve& curve, std::span<const double> fixed,
                                                  std::size_t n) const {
  ParameterValues first = start_;
  for (std::size_t j = 0; j < first.size(); ++j) {
    if (!std::isnan(fixed[j])) first[j] = fixed[j];
  }
  std::vector<ParameterValues> all = {first};
  const Curve sample = thinned(curve, 128);
  if (std::isfinite(Projection(*this, sample, fixed)(first)) && n > 1) all.push_back(first);
  if (n <= all.size()) return all;
  for (ParameterValues& p :
       best_of_grid(*this, sample, fixed, {.axes = candidates(sample)}, n - all.size())) {
    all.push_back(std::move(p));
  }
  return all;
}

}  // namespace

std::unique_ptr<Model> make_own_law(const OwnLaw& law) {
  require_readable(law.formula);
  std::vector<std::string> faults = faults_of_the_formula(law);
  for (std::string& fault : faults_of_the_names(law)) faults.push_back(std::move(fault));
  if (!faults.empty()) {
    throw BadInput(fmt::format("the law {}: {}", law.formula, fmt::join(faults, "; ")));
  }
  return std::make_unique<FormulaModel>(law);
}

}  // namespace jostle::inline study
