#include "cli/first_run/beyond_first_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "cli/commands/commands.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "config/json/json_text.hpp"

namespace jostle::inline cli {
namespace {

bool moves_grains(const Plan& plan) {
  return std::holds_alternative<DiscreteElement>(plan.engine);
}

bool has_sizes(const Plan& plan) {
  const auto* given = std::get_if<GivenPacking>(&plan.start);
  return !plan.kinds.empty() || (given != nullptr && given->sizes);
}

bool skips_trials(const Plan& plan) {
  const auto* trials = std::get_if<MonteCarlo>(&plan.engine);
  return trials != nullptr &&
         (trials->relax.sampler == Sampler::rejection_free ||
          (trials->relax_start && trials->relax_start->sampler == Sampler::rejection_free));
}

}  // namespace

std::vector<std::string> loops_beyond_first_run(const LoadedScene& loaded) {
  std::vector<std::string> needs;
  if (std::ranges::any_of(loaded.plans, moves_grains)) needs.emplace_back("discrete elements");
  if (std::ranges::any_of(loaded.plans, has_sizes)) needs.emplace_back("spheres of several sizes");
  if (std::ranges::any_of(loaded.plans, skips_trials)) needs.emplace_back("the sampler skipping");
  return needs;
}

std::vector<std::string> beyond_first_run(const LoadedScene& loaded) {
  std::vector<std::string> needs;
  if (const auto tables = requested_tables(loaded.scene); !tables.empty())
    needs.push_back(fmt::format("tables ({})", joined(tables, ", ")));
  const std::vector<std::string> loops = loops_beyond_first_run(loaded);
  needs.insert(needs.end(), loops.begin(), loops.end());
  return needs;
}

int print_requests(const std::vector<std::string>& needs) {
  if (needs.empty()) return exit_ok;
  print(joined(needs, ", ") + "\n");
  return exit_requests;
}

void add_requests(Command& app, int& code) {
  Command requests =
      app.add_command("requests",
                      "Print what a command needs beyond the program of a first run; nothing if it "
                      "needs nothing. Its arguments are those of the command");
  requests.require_command();
  add_run_requests(requests, code);
  add_check_requests(requests, code);
}

}  // namespace jostle::inline cli
