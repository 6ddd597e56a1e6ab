#include "config/ladder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/grids.hpp"
#include "config/parts/parts.hpp"
#include "config/sweep.hpp"
#include "engine/bed/boundary.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline config {

namespace {

constexpr std::uint64_t complete_interval = 100;
constexpr double narrowest_half = 4;  // diameters

std::uint64_t raised(std::uint64_t sweeps, double factor) {
  const double product = static_cast<double>(sweeps) * factor;
  return product < static_cast<double>(most_sweeps) ? static_cast<std::uint64_t>(product)
                                                    : most_sweeps;
}

/// The settings of an engine that a ladder varies.
struct Written {
  Json operator()(const MonteCarlo& engine) const { return written_part(engine.relax); }
  Json operator()(const DiscreteElement& engine) const { return written_engine(engine); }
};

/// The settings of every ladder.
class LadderMaker {
 public:
  explicit LadderMaker(const Scene& scene) : scene_(scene) {
    add(PilotSetting::Part::scene, "as the scene", engine_of(scene));
  }

 protected:
  void half_the_spheres() {
    const bool fills = std::holds_alternative<SteepestDescentPour>(scene_.start) ||
                       std::holds_alternative<FittedPour>(scene_.start) ||
                       std::holds_alternative<RandomSettle>(scene_.start);
    if (!fills || has_one_width(scene_.container) || !has_gravity(scene_.container) ||
        scene_.n_spheres < 2)
      return;
    Vec3 half = extent(scene_.container);
    half.x *= 0.5;
    if (half.x < narrowest_half) return;
    const Container container = *container_of(name_of(scene_.container), half);
    std::vector<MixtureKind> kinds = with_share(scene_.kinds, 0.5);
    for (MixtureKind& kind : kinds)
      if (kind.place) (*kind.place)[0] *= 0.5;
    if (!kinds.empty() && width_fault(container, range_of(kinds).greatest)) return;
    add(PilotSetting::Part::spheres, "half the footprint", engine_of(scene_));
    PilotSetting& setting = settings_.back();
    setting.n_spheres =
        kinds.empty() ? scene_.n_spheres / 2 : static_cast<std::uint32_t>(n_spheres_of(kinds));
    setting.kinds = std::move(kinds);
    setting.container = container;
  }

  void add(PilotSetting::Part part, std::string name, const EngineSettings& engine) {
    const bool known = part != PilotSetting::Part::spheres && part != PilotSetting::Part::start &&
                       std::ranges::any_of(settings_, [&](const PilotSetting& setting) {
                         return setting.engine == engine;
                       });
    if (known) return;
    settings_.push_back({part, std::move(name), engine, scene_.n_spheres, scene_.container,
                         scene_.start, scene_.kinds});
  }

  const Scene& scene_;
  std::vector<PilotSetting> settings_;
};

class GrainLadder : LadderMaker {
 public:
  explicit GrainLadder(const Scene& scene) : LadderMaker(scene), grains_(*scene.grains) {}

  std::vector<PilotSetting> make() {
    std::visit([&](const auto& rest) { rests(rest); }, grains_.rest);
    time_steps();
    stiffnesses();
    half_the_spheres();
    return std::move(settings_);
  }

 private:
  void rests(const QuietRest& rest) {
    for (const double factor : {100.0, 10.0}) {
      QuietRest rung = rest;
      rung.kinetic_energy = rounded_to_15_digits(rest.kinetic_energy * factor);
      if (rung.kinetic_energy > 1) continue;
      ended_by(rung, finite_text("quiet below {:.3g} m g d", rung.kinetic_energy));
    }
    for (const double factor : {5.0, 25.0}) {
      QuietRest rung = rest;
      rung.seconds = rounded_to_15_digits(rest.seconds * factor);
      ended_by(rung, finite_text("quiet for {:.3g} s", rung.seconds));
    }
  }

  void rests(const TimedRest& rest) {
    for (const double factor : {0.25, 0.5, 2.0, 4.0}) {
      const TimedRest rung{rounded_to_15_digits(rest.seconds * factor)};
      ended_by(rung, finite_text("{:.3g} s after the floor", rung.seconds));
    }
  }

  template <class AnyRest>
  void ended_by(const AnyRest& rest, std::string name) {
    if (rest.seconds > most_seconds) return;
    DiscreteElement rung = grains_;
    rung.rest = rest;
    // The cap must leave as much time before the rest as the scene's does.
    const double own = std::visit([](const auto& choice) { return choice.seconds; }, grains_.rest);
    const double extra_time = std::max(0.0, rest.seconds - own);
    rung.most_seconds =
        rounded_to_15_digits(std::min(grains_.most_seconds + extra_time, most_seconds));
    add(PilotSetting::Part::stop, std::move(name), rung);
  }

  void time_steps() {
    for (const double factor : {0.5, 2.0, 4.0}) {
      DiscreteElement rung = grains_;
      const double steps = rounded_to_15_digits(steps_of_contact(grains_) * factor);
      if (steps < 40 || steps > 1e6) continue;
      rung.steps_per_contact = steps;
      add(PilotSetting::Part::step, finite_text("{:g} steps per contact", steps), rung);
    }
  }

  void stiffnesses() {
    for (const double factor : {0.1, 10.0}) {
      bool allowed = true;
      const auto scale = [&](ContactLaw& law) {
        std::visit(
            [&](auto& springs) {
              springs.stiffness = rounded_to_15_digits(springs.stiffness * factor);
              allowed = allowed && springs.stiffness >= 1 && springs.stiffness <= 1e12;
            },
            law);
      };
      DiscreteElement rung = grains_;
      scale(rung.spheres);
      if (rung.floor) scale(*rung.floor);
      if (rung.sides) scale(*rung.sides);
      if (!allowed) continue;
      add(PilotSetting::Part::stiffness, factor < 1 ? "ten times softer" : "ten times stiffer",
          rung);
    }
  }

  static constexpr double most_seconds = 1e5;
  const DiscreteElement& grains_;
};

class RelaxationLadder : LadderMaker {
 public:
  using LadderMaker::LadderMaker;

  std::vector<PilotSetting> make() {
    std::visit([&](const auto& rule) { stops(rule); }, scene_.relax.stop.rule);
    std::visit([&](const auto& move) { steps(move); }, scene_.relax.move);
    half_the_spheres();
    other_pour();
    return std::move(settings_);
  }

 private:
  void stops(const MeanHeightStop& rule) {
    for (const double factor : {100.0, 10.0, 0.1, 0.01}) {
      MeanHeightStop rung = rule;
      rung.eta = rounded_to_15_digits(rule.eta * factor);
      if (rung.eta < 1) stop(rung, factor, finite_text("eta = {:.3g}", rung.eta));
    }
    intervals(rule);
  }

  void stops(const HeightChangeStop& rule) {
    for (const double factor : {100.0, 10.0, 0.1, 0.01}) {
      HeightChangeStop rung = rule;
      rung.change = rounded_to_15_digits(rule.change * factor);
      if (rung.change <= 1) stop(rung, factor, finite_text("change = {:.3g} d", rung.change));
    }
    intervals(rule);
  }

  template <class OfMeanHeight>
  void intervals(const OfMeanHeight& rule) {
    for (const std::uint64_t interval : {rule.every_sweeps / 10, rule.every_sweeps * 10}) {
      if (interval < 1) continue;
      OfMeanHeight rung = rule;
      rung.every_sweeps = interval;
      Relaxation relax = scene_.relax;
      relax.stop.rule = rung;
      add(PilotSetting::Part::interval, fmt::format("test every {} sweeps", interval), relax);
    }
  }

  void stops(const BulkFractionStop& rule) {
    for (const double factor : {10.0, 0.1}) {
      BulkFractionStop rung = rule;
      rung.change = rounded_to_15_digits(rule.change * factor);
      stop(rung, factor, finite_text("change = {:.3g}", rung.change));
    }
    for (const double eta : {1e-5, 1e-6}) {
      stop(MeanHeightStop{.eta = eta, .every_sweeps = complete_interval}, 0.01,
           finite_text("mean height, eta = {:.3g}", eta));
    }
  }

  void stops(const SweepsStop& rule) {
    for (const double factor : {100.0, 10.0, 0.1, 0.01}) {
      const SweepsStop rung{raised(rule.sweeps, 1 / factor)};
      if (rung.sweeps > 0) stop(rung, factor, fmt::format("{} sweeps", rung.sweeps));
    }
  }

  void stop(const StopRule& rule, double factor, std::string name) {
    Relaxation relax = scene_.relax;
    relax.stop.rule = rule;
    relax.stop.max_sweeps = raised(relax.stop.max_sweeps, std::max(1.0, 1 / factor));
    add(PilotSetting::Part::stop, std::move(name), relax);
  }

  template <class AnyMove>
  void steps(const AnyMove& move) {
    std::apply([&](const auto&... fields) { (halve_and_double(move, fields), ...); },
               AnyMove::fields());
    if constexpr (std::same_as<AnyMove, MetropolisMove>) adaptations(move);
  }

  template <class AnyMove, class Value, class Form>
  void halve_and_double(const AnyMove& move, const Field<AnyMove, Value, Form>& number) {
    if constexpr (std::same_as<Form, Number>) {
      if (number.notes.ladder_symbol.empty()) return;
      for (const double factor : {0.5, 2.0}) {
        AnyMove rung = move;
        double& value = rung.*number.member;
        value = rounded_to_15_digits(value * factor);
        if (!number.form.range.contains(value)) continue;
        // A step may not pass the smallest sphere of a mixture.
        if (!scene_.kinds.empty() && rung.max_step > 2 * range_of(scene_.kinds).least) continue;
        Relaxation relax = scene_.relax;
        relax.move = rung;
        add(PilotSetting::Part::step, finite_text("{} = {:.3g}", number.notes.ladder_symbol, value),
            relax);
      }
    }
  }

  void adaptations(const MetropolisMove& move) {
    const auto adapted = [&](const char* name, std::optional<StepAdaptation> adaptation) {
      const bool skips = scene_.relax.sampler == Sampler::rejection_free;
      if (skips && adaptation && adaptation->base == AcceptanceBase::not_upward) return;
      MetropolisMove rung = move;
      rung.adaptation = adaptation;
      Relaxation relax = scene_.relax;
      relax.move = rung;
      add(PilotSetting::Part::adaptation, name, relax);
    };
    adapted("published delta rule", StepAdaptation{});
    adapted("delta of falling trials, 2 %",
            StepAdaptation{.threshold = 0.02, .base = AcceptanceBase::not_upward});
    adapted("fixed delta", std::nullopt);
  }

  void other_pour() {
    const Boundary boundary(scene_.container);
    if (!(boundary.planes_x() || boundary.planes_y()) || scene_.relax_start) return;
    if (std::holds_alternative<FittedPour>(scene_.start)) {
      add(PilotSetting::Part::start, "poured between the walls", scene_.relax);
      settings_.back().start = SteepestDescentPour{};
    } else if (std::holds_alternative<SteepestDescentPour>(scene_.start) && scene_.kinds.empty() &&
               !start_fault(FittedPour{}, scene_.container)) {
      add(PilotSetting::Part::start, "fitted between the walls", scene_.relax);
      settings_.back().start = FittedPour{};
    }
  }

  void add(PilotSetting::Part part, std::string name, const Relaxation& relax) {
    LadderMaker::add(part, std::move(name), MonteCarlo{relax, scene_.relax_start});
  }
};

constexpr double layer_spacing = 0.8165;  // spacing of close-packed layers, sqrt(2/3) diameters

/// Tests if a window of heights leaves room for a taper of this length above the floor.
bool can_taper(const Window& window) {
  const auto* heights = std::get_if<HeightWindow>(&window);
  return heights == nullptr || heights->low >= 0.5 * layer_spacing;
}

}  // namespace

std::vector<PilotSetting> ladder(const Scene& scene) {
  if (scene.grains) return GrainLadder(scene).make();
  return RelaxationLadder(scene).make();
}

MostComplete most_complete(const std::vector<PilotSetting>& settings) {
  MostComplete found;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    if (settings[i].part == PilotSetting::Part::stop) found = {found.last, i};
  }
  return found;
}

std::vector<OtherWindow> other_windows(const Scene& scene) {
  constexpr std::size_t longest_name = 64;
  std::vector<OtherWindow> windows;
  std::vector<std::string> taken;
  for (const Observable& observable : scene.observables) taken.push_back(label(observable).name);
  const auto add = [&](const BulkFraction& bulk, const char* ending, const Window& window,
                       double taper) {
    const std::string name = bulk.name + ending;
    if (name.size() > longest_name || std::ranges::find(taken, name) != taken.end()) return;
    taken.push_back(name);
    windows.push_back({bulk.name, {name, window, taper}});
  };
  for (const Observable& observable : scene.observables) {
    const auto* bulk = std::get_if<BulkFraction>(&observable);
    if (bulk == nullptr) continue;
    std::visit(
        [&](auto window) {
          const double quarter = 0.25 * (window.high - window.low);
          window.low = rounded_to_15_digits(window.low + quarter);
          window.high = rounded_to_15_digits(window.high - quarter);
          if (window.low < window.high) add(*bulk, "_narrow", window, bulk->taper);
        },
        bulk->window);
    if (const auto* quantiles = std::get_if<QuantileWindow>(&bulk->window)) {
      add(*bulk, "_wide",
          QuantileWindow{rounded_to_15_digits(0.5 * quantiles->low),
                         rounded_to_15_digits(0.5 * (1 + quantiles->high))},
          bulk->taper);
    }
    if (bulk->taper == 0 && can_taper(bulk->window))
      add(*bulk, "_tapered", bulk->window, layer_spacing);
  }
  return windows;
}

Scene ladder_scene(const Scene& scene, const std::vector<PilotSetting>& settings,
                   std::uint64_t taps) {
  Scene pilot = scene;
  pilot.name = scene.name + "-cost";
  pilot.streams = Streams::matched;
  pilot.realizations = 1;
  pilot.until = {};
  pilot.fits.clear();
  pilot.analyse = {};
  pilot.structure = {};
  pilot.snapshots = SnapshotChoice{};
  pilot.motion.reset();
  pilot.protocol.clear();
  for (const Stage& stage : stages(scene.protocol)) {
    const std::uint64_t count = std::min(stage.count, taps);
    if (count > 0) pilot.protocol.push_back({stage.tap, std::nullopt, count});
    taps -= count;
  }
  const EngineSettings engine = engine_of(scene);
  const auto* monte_carlo = std::get_if<MonteCarlo>(&engine);
  if (monte_carlo != nullptr) {
    if (const auto* relaxation = relaxation_of_start(*monte_carlo, engine_start(scene.start)))
      pilot.relax_start = *relaxation;
  }
  for (const OtherWindow& added : other_windows(scene))
    pilot.observables.push_back(added.observable);
  SweepAxis axis;
  axis.columns = {{monte_carlo ? "/relax" : "/engine", {}}, {"/spheres", {}}, {"/container", {}}};
  // The values of a point are part of its random streams: without another start, none is named.
  const bool starts_differ = std::ranges::any_of(settings, [](const PilotSetting& setting) {
    return setting.part == PilotSetting::Part::start;
  });
  if (starts_differ) axis.columns.push_back({"/start", {}});
  for (const PilotSetting& setting : settings) {
    axis.columns[0].second.push_back(std::visit(Written{}, setting.engine));
    Scene spheres;
    spheres.n_spheres = setting.n_spheres;
    spheres.kinds = setting.kinds;
    axis.columns[1].second.push_back(written_spheres(spheres));
    axis.columns[2].second.push_back(written_value(OneOf<Container>{}, setting.container));
    if (starts_differ)
      axis.columns[3].second.push_back(written_value(OneOf<StartChoice>{}, setting.start));
  }
  pilot.sweep = {axis};
  return pilot;
}

}  // namespace jostle::inline config
