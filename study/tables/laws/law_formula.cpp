#include "study/tables/laws/law_formula.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include "study/bad_input.hpp"
#include "study/tables/laws/own_law.hpp"

namespace jostle::inline study {

namespace {

using Function = double (*)(double);
struct NamedFunction {
  const char* name;
  Function function;
};

// ln and log are both the natural logarithm: the papers write one, programs the other.
constexpr NamedFunction functions[] = {{"abs", [](double x) { return std::abs(x); }},
                                       {"acos", [](double x) { return std::acos(x); }},
                                       {"asin", [](double x) { return std::asin(x); }},
                                       {"atan", [](double x) { return std::atan(x); }},
                                       {"cbrt", [](double x) { return std::cbrt(x); }},
                                       {"cos", [](double x) { return std::cos(x); }},
                                       {"cosh", [](double x) { return std::cosh(x); }},
                                       {"erf", [](double x) { return std::erf(x); }},
                                       {"erfc", [](double x) { return std::erfc(x); }},
                                       {"exp", [](double x) { return std::exp(x); }},
                                       {"expm1", [](double x) { return std::expm1(x); }},
                                       {"gamma", [](double x) { return std::tgamma(x); }},
                                       {"ln", [](double x) { return std::log(x); }},
                                       {"log", [](double x) { return std::log(x); }},
                                       {"log10", [](double x) { return std::log10(x); }},
                                       {"log1p", [](double x) { return std::log1p(x); }},
                                       {"log2", [](double x) { return std::log2(x); }},
                                       {"sin", [](double x) { return std::sin(x); }},
                                       {"sinh", [](double x) { return std::sinh(x); }},
                                       {"sqrt", [](double x) { return std::sqrt(x); }},
                                       {"tan", [](double x) { return std::tan(x); }},
                                       {"tanh", [](double x) { return std::tanh(x); }}};

bool begins_word(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

// Past the number that begins at `i`: 12, 1.5, 2e-3.
std::size_t end_of_number(const std::string& text, std::size_t i) {
  while (i < text.size() && (is_digit(text[i]) || text[i] == '.')) ++i;
  if (i >= text.size() || (text[i] != 'e' && text[i] != 'E')) return i;
  std::size_t exponent = i + 1;
  if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
  if (exponent >= text.size() || !is_digit(text[exponent])) return i;
  while (exponent < text.size() && is_digit(text[exponent])) ++exponent;
  return exponent;
}

// An equals sign that compares nothing: the parser would take it for an assignment.
bool assigns(const std::string& formula) {
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (formula[i] != '=') continue;
    if (i + 1 < formula.size() && formula[i + 1] == '=') {
      ++i;
    } else if (i == 0 || std::string("<>!").find(formula[i - 1]) == std::string::npos) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<std::string> functions_of_laws() {
  std::vector<std::string> names;
  for (const NamedFunction& function : functions) names.emplace_back(function.name);
  return names;
}

std::vector<FormulaName> names_in(const std::string& formula) {
  std::vector<FormulaName> names;
  for (std::size_t i = 0; i < formula.size();) {
    if (is_digit(formula[i]) || formula[i] == '.') {
      i = end_of_number(formula, i);
      continue;
    }
    const std::size_t begin = i++;
    if (!begins_word(formula[begin])) continue;
    while (i < formula.size() && (begins_word(formula[i]) || is_digit(formula[i]))) ++i;
    const std::size_t next = formula.find_first_not_of(' ', i);
    FormulaName name{formula.substr(begin, i - begin),
                     next != std::string::npos && formula[next] == '('};
    const bool known = std::ranges::any_of(names, [&](const FormulaName& known_name) {
      return known_name.text == name.text && known_name.is_function == name.is_function;
    });
    if (!known) names.push_back(std::move(name));
  }
  return names;
}

struct LawFormula::Parser {
  mu::Parser parser;
  double t = 1;
  std::vector<double> p;
};

LawFormula::LawFormula(const std::string& formula, const std::vector<std::string>& parameters)
    : parser_(std::make_unique<Parser>()) {
  if (assigns(formula)) {
    throw BadInput(fmt::format("the law {}: give what X is, without \"X =\"", formula));
  }
  mu::Parser& parser = parser_->parser;
  parser_->p.assign(parameters.size(), 1);
  try {
    parser.ClearFun();
    parser.ClearConst();
    for (const NamedFunction& function : functions)
      parser.DefineFun(function.name, function.function);
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineVar("t", &parser_->t);
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      parser.DefineVar(parameters[j], &parser_->p[j]);
    }
    parser.SetExpr(formula);
    parser.Eval();
  } catch (const mu::ParserError& error) {
    throw BadInput(fmt::format("the law {} cannot be read: {}", formula, error.GetMsg()));
  }
  if (parser.GetNumResults() != 1) {
    throw BadInput(
        fmt::format("the law {} cannot be read: it has a comma outside a function", formula));
  }
}

LawFormula::~LawFormula() = default;

double LawFormula::operator()(double t, const double* p) {
  parser_->t = t;
  std::copy_n(p, parser_->p.size(), parser_->p.begin());
  return parser_->parser.Eval();
}

}  // namespace jostle::inline study
