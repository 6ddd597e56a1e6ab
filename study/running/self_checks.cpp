#include "study/running/self_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <span>

#include "engine/monte_carlo/plain_loop.hpp"
#include "engine/monte_carlo/trial_loop.hpp"
#include "engine/starts/starts.hpp"
#include "ensemble/realization.hpp"
#include "ensemble/run.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "fitting/fit.hpp"
#include "fitting/models/models.hpp"
#include "results/content/record.hpp"
#include "results/disk/error.hpp"
#include "results/file/results_file.hpp"
#include "results/run/run_store.hpp"
#include "study/provenance.hpp"

namespace jostle::inline study {
namespace {

void require(bool holds, const std::string& otherwise) {
  if (!holds) throw SelfCheckFailure(otherwise);
}

void require_no_overlap(const Packing& packing, const std::string& context) {
  const Overlap overlap = deepest_overlap_brute_force(packing);
  require(overlap.depth <= overlap_bound(packing),
          finite_text("{}: spheres {} and {} overlap by {:.3g} diameters", context, overlap.first,
                      overlap.second, overlap.depth));
}

/// Plans of milliseconds that differ in container, start, tap, move, stop and sampler.
std::vector<Plan> small_plans() {
  Plan plan;
  plan.seed = 20260105;
  plan.container = PeriodicBox{4, 4};
  plan.n_spheres = 60;
  plan.start = SteepestDescentPour{};
  plan.protocol = {{Dilate{0.05}, 10}, {Lift{0.2}, 5}};
  MonteCarlo engine;
  engine.relax.stop = {.rule = MeanHeightStop{.eta = 1e-4, .every_sweeps = 20}, .max_sweeps = 2000};
  plan.engine = engine;
  plan.observables = {MeanHeight{}, BottomFraction{}, BulkFraction{}};
  plan.snapshots.taps = {0, 15};
  std::vector<Plan> plans = {plan};
  engine.relax.sampler = Sampler::rejection_free;
  plan.engine = engine;
  plans.push_back(plan);
  plan.container = WalledBox{4.5, 4};
  plan.start = RandomSettle{};
  engine.relax.move = MetropolisMove{0.2};
  plan.engine = engine;
  plan.protocol = {{Shake{0.05, 0.2, 5}, 15}};
  plans.push_back(plan);
  plan.container = Cylinder{1.4};  // a single file
  plan.n_spheres = 20;
  plan.start = SteepestDescentPour{};
  plans.push_back(plan);
  plan.container = PeriodicBox{4, 3.4641016151377544};
  plan.start = Crystal{};  // without any gap
  plan.n_spheres = 80;
  plan.engine = MonteCarlo{.relax = {.move = MetropolisMove{0.1, 1e3}, .stop = engine.relax.stop}};
  plan.protocol = {{Dilate{0}, 5}, {Dilate{1e-16}, 5}, {Dilate{10}, 5}};
  plans.push_back(plan);
  for (std::size_t k = 0; k < plans.size(); ++k) plans[k].point_id = k;
  return plans;
}

std::string compare_with_plain_loop(InstructionSet set) {
  const StreamKey key = stream_key(20260106, 0, 0, Purpose::trials);
  constexpr std::uint64_t n_trials = 50'000;
  std::uint64_t compared = 0;
  for (const Container& container :
       {Container{PeriodicBox{3.5, 4}}, Container{WalledBox{4, 4}}, Container{Cylinder{4.5}}}) {
    RandomStream random(stream_key(20260106, 0, 0, Purpose::start));
    Packing start = make_start(SteepestDescentPour{}, container, 50, random);
    excite(start, Dilate{0.1}, random);
    for (const Move& move : {Move{PolarMove{}}, Move{PolarMove{2.0, 1.0, ThetaLaw::linear}},
                             Move{MetropolisMove{}}, Move{MetropolisMove{0.4, 1.0}}}) {
      PlainLoop plain(start, move, key);
      plain.run(n_trials);
      const auto loop = make_trial_loop(container, move, key, set);
      loop->load(start);
      loop->run(n_trials);
      Packing end = start;
      loop->store(end);
      require(end.centres == plain.packing().centres,
              fmt::format("{} does not make the trajectory of the plain loop (container {}, move "
                          "{}): it computes other numbers",
                          name(set), container.index(), move.index()));
      compared += n_trials;
    }
  }
  return fmt::format("{} trials equal the plain loop's, bit for bit", compared);
}

std::string look_for_overlaps() {
  std::uint64_t taps = 0;
  for (const Plan& plan : small_plans()) {
    Realization realization(plan, 0);
    while (!realization.finished()) {
      const Slice slice = realization.advance(1'000'000);
      if (!slice.row) continue;
      require_no_overlap({plan.container, realization.state().centres, realization.sizes()},
                         fmt::format("point {}, tap {}", plan.point_id, slice.row->tap));
      ++taps;
    }
  }
  return fmt::format("{} taps, all pairs compared", taps);
}

/// NIST StRD Misra1a, y = b1 (1 - exp(-b2 x)): a stretched exponential with beta = 1 that begins
/// at 0. https://www.itl.nist.gov/div898/strd/nls/data/misra1a.shtml
std::string fit_certified_set() {
  const Curve misra1a{.t = {77.6, 114.9, 141.1, 190.8, 239.9, 289.0, 332.8, 378.4, 434.8, 477.3,
                            536.8, 593.1, 689.1, 760.0},
                      .x = {10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02, 44.82, 50.76, 55.05,
                            61.01, 66.40, 75.47, 81.78},
                      .sigma = {}};
  constexpr double b1 = 2.3894212918e2, b2 = 5.5015643181e-4;
  const auto result = fit(StretchedExponential(), misra1a, {.fixed = {{"rho_0", 0}, {"beta", 1}}});
  if (const auto* refusal = std::get_if<Refusal>(&result)) throw SelfCheckFailure(refusal->message);
  const Fit& found = std::get<Fit>(result);
  const double error = std::max(std::abs(found.estimates[0].value / b1 - 1),
                                std::abs(found.estimates[2].value * b2 - 1));
  require(error < 1e-6,
          finite_text("Misra1a: {:.9g} and 1/{:.9g}, certified are {:.9g} and 1/{:.9g}",
                      found.estimates[0].value, found.estimates[2].value, b1, 1 / b2));
  return finite_text("Misra1a to {:.0f} digits", std::min(16.0, -std::log10(error + 1e-16)));
}

std::string run_into_file(const std::string& path, int threads) {
  constexpr std::uint32_t realizations = 2;
  const std::vector<Plan> plans = small_plans();
  const auto store = RunStore::create(path, make_study(plans, "{}", "{}", realizations), {},
                                      provenance_of_this_run(fmt::to_string(threads)));
  Progress progress;
  const RunSummary summary =
      run_ensemble(plans, store->pending(), {.threads = threads}, *store, progress);
  require(summary.done == plans.size() * realizations,
          fmt::format("{} of {} realizations failed", summary.failed, plans.size() * realizations));
  store->finish();
  return digest_of(path);
}

std::string compare_threads(const std::string& folder) {
  const std::string single = run_into_file(folder + "/one.h5", 1);
  const std::string two = run_into_file(folder + "/two.h5", 2);
  require(single == two, "one thread and two made different data");
  return fmt::format("1 and 2 threads: digest {}...", single.substr(0, 16));
}

/// Checks that written data are read back unchanged, and that damage is detected.
std::string read_back(const std::string& folder) {
  const std::string path = folder + "/written.h5";
  run_into_file(path, 1);
  const ResultsFile file(path);
  const std::vector<Plan> plans = small_plans();
  std::uint64_t rows = 0;
  for (std::uint32_t point = 0; point < plans.size(); ++point) {
    const std::vector<double> stored = file.record({point, 1}).rows;
    const std::size_t n_columns = file.study().points[point].n_columns();
    Realization realization(plans[point], 1);
    while (!realization.finished()) {
      const Slice slice = realization.advance(1'000'000);
      if (!slice.row) continue;
      const auto row = stored.begin() + static_cast<std::ptrdiff_t>(slice.row->tap * n_columns);
      require(
          std::ranges::equal(slice.row->observables,
                             std::span(row, plans[point].observables.size())),
          fmt::format("tap {} of point {} was read back as other numbers", slice.row->tap, point));
      ++rows;
    }
  }
  std::fstream bytes(path, std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekg(2000);
  const char byte = static_cast<char>(bytes.get() ^ 1);
  bytes.seekp(2000);
  bytes.put(byte);
  bytes.close();
  try {
    const ResultsFile damaged(path);
  } catch (const ResultsError&) {
    return fmt::format("{} rows read back, one flipped bit noticed", rows);
  }
  throw SelfCheckFailure("a flipped bit went unnoticed");
}

}  // namespace

std::vector<SelfCheck> self_checks(const std::string& folder) {
  using enum SelfCheck::Finds;
  std::vector<SelfCheck> checks;
  for (const InstructionSet set : instruction_sets()) {
    if (set > best_instruction_set()) continue;
    checks.push_back({fmt::format("trials, {}", name(set)),
                      [set] { return compare_with_plain_loop(set); }, wrong_numbers});
  }
  checks.push_back({"overlaps", look_for_overlaps, wrong_numbers});
  checks.push_back({"fit", fit_certified_set, wrong_numbers});
  checks.push_back({"threads", [folder] { return compare_threads(folder); }, wrong_numbers});
  checks.push_back({"results file", [folder] { return read_back(folder); }, bad_disk});
  return checks;
}

}  // namespace jostle::inline study
