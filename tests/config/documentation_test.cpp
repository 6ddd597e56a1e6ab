#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <regex>
#include <set>

#include "config/json/json.hpp"
#include "engine/monte_carlo/rejection_free/directions.hpp"
#include "tests/config/scene_files.hpp"
#include "tests/test_files.hpp"

namespace jostle {

namespace {

/// 1 000 000 as pages write it.
std::string spaced(std::uint64_t value) {
  std::string text = fmt::to_string(value);
  if (text.size() < 5) return text;
  for (std::size_t i = text.size(); i > 3;) text.insert(i -= 3, 1, ' ');
  return text;
}

/// 1e9, 1e12.
std::string power_of_ten(std::uint64_t value) {
  std::size_t zeros = 0;
  for (; value > 1; value /= 10) {
    REQUIRE(value % 10 == 0);
    ++zeros;
  }
  return fmt::format("1e{}", zeros);
}

/// The keys of objects and the words that a value may be, wherever the schema has them.
void add_words(const Json& schema, std::set<std::string>& words) {
  if (schema.is_array()) {
    for (const Json& element : schema.elements()) add_words(element, words);
  }
  if (!schema.is_object()) return;
  for (const auto& [key, member] : schema.members()) {
    if (key == "properties") {
      for (const auto& [name, unused] : member.members()) words.insert(name);
    }
    if (key == "const" && member.is_string()) words.insert(member.text());
    if (key == "enum") {
      for (const Json& value : member.elements()) {
        if (value.is_string()) words.insert(value.text());
      }
    }
    add_words(member, words);
  }
}

/// Code in a page of Markdown.
std::set<std::string> words_of_code(const std::string& page) {
  const std::regex code("```[^`]*```|`[^`]*`"), word("[A-Za-z0-9_$]+");
  std::set<std::string> words;
  for (std::sregex_iterator found(page.begin(), page.end(), code), end; found != end; ++found) {
    const std::string text = found->str();
    for (std::sregex_iterator match(text.begin(), text.end(), word); match != end; ++match)
      words.insert(match->str());
  }
  return words;
}

}  // namespace

TEST_CASE("The reference of scenes has every key and every word of the schema") {
  const std::string page = text_of(source_file("docs/reference/scene.md"));
  const Json schema = Json::parse(scene_schema());
  const std::set<std::string> quoted = words_of_code(page);
  std::set<std::string> words;
  add_words(schema, words);
  CHECK(words.size() > 150);
  for (const std::string& word : words) {
    INFO(word);
    CHECK(quoted.contains(word));
  }
  // Each key of a scene has a row, and each row has an existing key.
  const std::string rows =
      page.substr(page.find("## Keys"), page.find("### container") - page.find("## Keys"));
  std::set<std::string> listed, known;
  const std::regex row("\n\\| `([^`]+)` \\|");
  for (std::sregex_iterator found(rows.begin(), rows.end(), row), end; found != end; ++found)
    listed.insert((*found)[1].str());
  for (const auto& [name, unused] : schema.at("properties").members()) known.insert(name);
  CHECK(listed == known);
}

TEST_CASE("The reference of scenes quotes limits and defaults as they are") {
  const std::string page = text_of(source_file("docs/reference/scene.md"));
  const StepAdaptation adapt;
  const BulkFractionStop bulk;
  const MeanHeightStop mean_height;
  DiscreteElement dashpots;
  dashpots.spheres = LinearSpringDashpot{};
  for (const std::string& quoted : {
           fmt::format("width above {}", least_periodic_width),
           fmt::format("width at least {}", least_walled_width),
           fmt::format("n taps of one kind (0 to {})", power_of_ten(most_taps)),
           fmt::format(
               "`lambda` 0 to 10 ({}), `lateral_radius` 0 to 1 ({}), `retries` 0 to 1000 ({})",
               Shake{}.lambda, Shake{}.lateral_radius, Shake{}.retries),
           fmt::format("`amplitude` 0 to 100 ({}) or `acceleration` 0 to 100, `frequency` 1e-3 to "
                       "1e6 Hz ({})",
                       HalfSine{}.strength, HalfSine{}.frequency),
           fmt::format("`amplitude` 0 to 100 ({}) or `acceleration` 0 to 100, `frequency` 1e-3 to "
                       "1e6 Hz ({}), `cycles` 1 to "
                       "{} ({})",
                       Vibration{}.strength, Vibration{}.frequency, spaced(most_cycles),
                       Vibration{}.cycles),
           fmt::format("m/s^2 (1e-4 to 1e4) | {}, {:g}, {} |", DiscreteElement{}.diameter,
                       DiscreteElement{}.density, DiscreteElement{}.gravity),
           fmt::format(
               "| `steps_per_contact` | 40 to 1e6 | {:g}, of `linear_spring_dashpot` {:g} |",
               steps_of_contact({}), steps_of_contact(dashpots)),
           fmt::format("`{{\"timed\": {{\"seconds\": s}}}}` ({}) | `quiet`: 5e-5, {} |",
                       TimedRest{}.seconds, QuietRest{}.seconds),
           fmt::format("| `most_seconds` | above 0, at most 1e5 | {:g} |",
                       DiscreteElement{}.most_seconds),
           fmt::format("at most {}; {})", densest_dilution, RandomSettle{}.dilute_fraction),
           fmt::format("`max_sweeps` (1 to {}, {})", power_of_ten(most_sweeps),
                       spaced(Grow{}.max_sweeps)),
           fmt::format("packing fraction at most {}", densest_growth),
           fmt::format("a packing fraction of {};", densest_growth),
           fmt::format("`max_step` (1e-9 to {}; {})", least_periodic_width, PolarMove{}.max_step),
           fmt::format("`eta` (between 0 and 1; 1e-5) or `change` (above 0, at most 1), "
                       "`every_sweeps` (1 to {}; {})",
                       power_of_ten(most_sweeps), mean_height.every_sweeps),
           fmt::format(
               "`change` (0 to 1; {}), `every_trials` (1 to {}; {}), `times` (1 to 1000; {})",
               bulk.change, power_of_ten(most_trials), spaced(bulk.every_trials), bulk.times),
           fmt::format("`max_sweeps` | whole, 1 to {} | {} |", power_of_ten(most_sweeps),
                       spaced(Stop{}.max_sweeps)),
           fmt::format("(1 to {}; {}) the step is multiplied by `factor` (between 0\nand 1; {})",
                       power_of_ten(most_trials), spaced(adapt.every_trials), adapt.factor),
           fmt::format("fewer than {:g} % of polar trials ({:g} % of Metropolis ones)",
                       100 * PolarDirections::least_acceptance,
                       100 * CubicDirections::least_acceptance),
           fmt::format("`threshold` (above 0, at most 1; {})", adapt.threshold),
       }) {
    INFO(quoted);
    CHECK(page.find(quoted) != std::string::npos);
  }
  CHECK(mean_height.eta == 1e-5);
}

}  // namespace jostle
