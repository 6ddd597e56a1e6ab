#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bench/rates.hpp"
#include "bench/standard_states.hpp"
#include "cli/commands/commands.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline cli {
namespace {

struct BenchArguments {
  bool json = false;
  std::vector<std::string> states;  // empty: all
};

bool wanted(const BenchArguments& arguments, std::string_view state) {
  return arguments.states.empty() || std::ranges::count(arguments.states, state) > 0;
}

std::vector<std::string> state_names() {
  std::vector<std::string> names;
  for (const bench::StandardState state : bench::all_standard_states) {
    names.emplace_back(bench::name(state));
  }
  return names;
}

/// The median of three turns of about a tenth of a second, after ten sweeps to warm up.
bench::Rate rate_of(const bench::Case& bed) {
  const StreamKey key = stream_key(20010222, 0, 1, Purpose::trials);
  const auto loop = make_trial_loop(bed.packing.container, bed.move, key);
  loop->load(bed.packing);
  loop->run(10 * bed.packing.centres.size());
  std::array<bench::Rate, 3> rates;
  for (auto& rate : rates) rate = bench::measure_rate(*loop, 4'000'000);
  std::ranges::sort(rates, {}, &bench::Rate::trials_per_second);
  return rates[1];
}

void print_line(std::string_view state, std::size_t n_spheres, const bench::Rate& rate) {
  print(finite_text(
      "{:<11} {} spheres {:7.1f} million trials/s, acceptance {:.4f}, {:.2f} distance tests per "
      "trial, {:.1f} list renewals per sweep, {:.0f} bytes per sphere\n",
      state, n_spheres, rate.trials_per_second() / 1e6, rate.acceptance,
      rate.distance_tests_per_trial, rate.list_renewals_per_sweep, rate.bytes_per_sphere));
}

Json as_json(std::string_view state, std::size_t n_spheres, const bench::Rate& rate) {
  return {{"state", state},
          {"spheres", n_spheres},
          {"trials_per_second", rate.trials_per_second()},
          {"acceptance", rate.acceptance},
          {"distance_tests_per_trial", rate.distance_tests_per_trial},
          {"list_renewals_per_sweep", rate.list_renewals_per_sweep},
          {"bytes_per_sphere", rate.bytes_per_sphere}};
}

void run_bench(const BenchArguments& arguments) {
  const std::string set(name(best_instruction_set()));
  if (!arguments.json) print(fmt::format("instruction set {}, one core, processor time\n", set));
  Json cases = Json::array();
  for (const bench::StandardState state : bench::all_standard_states) {
    if (!wanted(arguments, bench::name(state))) continue;
    const bench::Case bed = bench::standard_state(state);
    const bench::Rate rate = rate_of(bed);
    const std::size_t n_spheres = bed.packing.centres.size();
    if (arguments.json) {
      cases.push_back(as_json(bench::name(state), n_spheres, rate));
    } else {
      print_line(bench::name(state), n_spheres, rate);
    }
  }
  if (arguments.json) {
    print_json(Json{{"instruction_set", set}, {"cases", cases}});
  }
}

}  // namespace

void add_bench(Command& app, int& code) {
  Command command = app.add_command("bench", "Measure the rate of trials on this machine");
  auto arguments = std::make_shared<BenchArguments>();
  command.add_option("states", arguments->states, "States to measure (default: all)")
      .one_of(state_names());
  command.add_flag("--json", arguments->json, "Print JSON instead of one line per state");
  command.footer(
      "Examples:\n"
      "  jostle bench                                about half a minute\n"
      "  jostle bench tapped_bed --json\n"
      "  JOSTLE_INSTRUCTION_SET=avx2 jostle bench    as without AVX-512\n"
      "\n"
      "The states: a bed of 4096 spheres poured, dilated and settled; one lifted and settled by\n"
      "Metropolis moves; a dense disordered packing and two fluids.");
  command.run([arguments, &code] {
    run_bench(*arguments);
    code = exit_ok;
  });
}

}  // namespace jostle::inline cli
