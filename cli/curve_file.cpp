#include "cli/curve_file.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <vector>

#include "cli/scene_file.hpp"

namespace jostle {

namespace {

std::vector<std::string> cells(std::string line) {
  for (char& c : line) {
    if (c == ',' || c == ';' || c == '\t' || c == '\r') c = ' ';
  }
  std::istringstream words(line);
  std::vector<std::string> found;
  for (std::string word; words >> word;) found.push_back(word);
  return found;
}

std::optional<double> number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return end == text.c_str() + text.size() ? std::optional(value) : std::nullopt;
}

std::optional<std::vector<double>> numbers(const std::vector<std::string>& words) {
  std::vector<double> values;
  for (const std::string& word : words) {
    const auto value = number(word);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

}  // namespace

Curve read_curve(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw BadInput(fmt::format("{}: cannot be read", path));
  Curve curve;
  std::size_t columns = 0, line_number = 0;
  bool named = false;
  for (std::string line; std::getline(file, line);) {
    ++line_number;
    const std::vector<std::string> words = cells(line);
    if (words.empty() || words.front().front() == '#') continue;
    const auto values = numbers(words);
    if (!values && curve.t.empty() && !named) {
      named = true;
      continue;
    }
    if (!values || values->size() < 2 || values->size() > 3 ||
        (columns != 0 && values->size() != columns)) {
      throw BadInput(fmt::format("{}: line {} is not {} (\"{}\")", path, line_number,
                                 columns == 3   ? "three numbers t, X, sigma"
                                 : columns == 2 ? "two numbers t, X like those before"
                                                : "two numbers t, X or three t, X, sigma",
                                 line));
    }
    columns = values->size();
    curve.t.push_back((*values)[0]);
    curve.x.push_back((*values)[1]);
    if (columns == 3) curve.sigma.push_back((*values)[2]);
  }
  return curve;
}

}  // namespace jostle
