#include "engine/dynamics.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/discrete_element/discrete_element.hpp"
#include "engine/discrete_element/reduced.hpp"
#include "engine/discrete_element/state.hpp"

namespace jostle::inline engine {

namespace {

/// How the floor moves in a tap; not at all in one that displaces the spheres.
struct MotionOf {
  double seconds;  // seconds of the unit of time

  FloorMotion operator()(const HalfSine& tap) const {
    return {floor_amplitude(tap, gravity()), tap.frequency * seconds, 1};
  }
  FloorMotion operator()(const Vibration& tap) const {
    return {floor_amplitude(tap, gravity()), tap.frequency * seconds, 2 * tap.cycles};
  }
  template <class Displacement>
  requires(!FloorTap<Displacement>) FloorMotion operator()(const Displacement&) const { return {}; }
  double gravity() const { return 1 / (seconds * seconds); }  // diameters / s^2
};

class GrainDynamics final : public Dynamics {
 public:
  explicit GrainDynamics(const DiscreteElement& settings)
      : settings_(settings), units_(reduced(settings)) {}

  void load(const Packing& bed) override {
    packing_ = bed;
    units_ = reduced(settings_, lightest_masses(bed));
    loop_.emplace(bed.container, units_, best_instruction_set(), bed.sizes);
    loop_->load(bed);
    state_ = {};
  }

  void settle(const Start&) override {
    begin({});
    require_gentle_start();
  }

  void tap(const Tap& tap, RandomStream& random) override {
    const FloorMotion motion = std::visit(MotionOf{units_.seconds}, tap);
    if (motion.half_periods > 0) {
      require_resolved(motion);
      begin(motion);
      return;
    }
    const double held = loop_->energies().held();
    Packing bed;
    loop_->store(bed);
    const TapReport report = excite(bed, tap, random);
    loop_->displace(bed);
    begin({});
    state_.dropped_offsets = report.lateral_offsets_dropped;
    state_.input = state_.start_energies.held() - held;
  }

  void watch_motion(double bin_width) override {
    if (loop_->floor_moves()) state_.driven.bin_width = bin_width;
  }

  DynamicsStatus advance(std::uint64_t units) override {
    if (state_.status != DynamicsStatus::running) return state_.status;
    const std::uint64_t n = std::max<std::uint64_t>(1, loop_->n_spheres());
    const std::uint64_t slice = std::max<std::uint64_t>(1, units / n);
    for (std::uint64_t done = 0; done < slice && state_.status == DynamicsStatus::running;) {
      const std::uint64_t now =
          std::min({steps_to_next(check_interval()), steps_to_next_sample(), slice - done});
      loop_->run(now);
      effort_.units += now * n;
      done += now;
      if (is_watched() && loop_->steps() % sample_interval() == 0)
        add_sample(state_.driven, loop_->grains(), motion_height());
      if (loop_->steps() % check_interval() == 0) check();
    }
    effort_.pair_tests = loop_->pair_tests();
    return state_.status;
  }

  void store(Packing& bed) const override { loop_->store(bed); }

  std::vector<double> diagnostics() const override {
    GrainLoop& loop = *loop_;
    const Energies now = loop.energies();
    const ContactCensus census = loop.census();
    const auto n = static_cast<double>(loop.n_spheres());
    const double mass = loop.mass();
    const Ledger tap = ledger(now);
    return {loop.time() * units_.seconds,
            now.kinetic / mass,
            now.elastic / mass,
            (state_.input + tap.floor_work) / mass,
            tap.latched / mass,
            tap.friction / mass,
            tap.dissipated() > 0 ? tap.missing / tap.dissipated()
                                 : std::numeric_limits<double>::quiet_NaN(),
            loop.greatest_overlap(),
            census.mean_overlap,
            census.contacts,
            census.sliding,
            state_.status == DynamicsStatus::capped ? 1.0 : 0.0,
            static_cast<double>(state_.dropped_offsets) / n};
  }

  BedMechanics mechanics() const override {
    BedMechanics bed = loop_->mechanics();
    for (std::vector<Vec3>* rates : {&bed.velocities, &bed.spins})
      for (Vec3& rate : *rates) rate = (1 / units_.seconds) * rate;
    bed.driven = driven_bed(state_.driven, units_.seconds);
    return bed;
  }

  Effort effort() const override { return effort_; }
  std::uint64_t units_per_slice() const override { return 1'000'000; }
  std::size_t bytes() const override {
    return packing_.centres.size() * sizeof(Vec3) + (loop_ ? loop_->bytes() : 0);
  }

  std::vector<std::byte> save() const override {
    GrainDynamicsState state = state_;
    state.loop = loop_->state();
    return bytes_of(state);
  }

  void restore(std::span<const std::byte> bytes) override {
    state_ = grain_state(bytes);
    if (state_.loop.grains.size() != packing_.centres.size())
      throw StateError("the stored state has another number of spheres");
    loop_->restore(state_.loop);
    state_.loop = {};
  }

 private:
  void begin(const FloorMotion& motion) {
    loop_->begin_motion(motion);
    loop_->forget_greatest_overlap();
    state_ = {};
    state_.status = DynamicsStatus::running;
    state_.start_energies = loop_->energies();
  }

  // Repeats the check of the scene, which does not know the sizes of a file or those drawn.
  void require_resolved(const FloorMotion& motion) const {
    const double steps = 0.5 / motion.frequency / units_.time_step;
    if (steps >= least_steps_per_half_period) return;
    throw std::runtime_error("half a period of the floor takes " + std::to_string(steps) +
                             " time steps of this bed, 20 at least: lower the frequency, or raise "
                             "stiffness or steps_per_contact");
  }

  // Springs that are pressed much deeper than by weight throw what lies above them. Columns of one
  // sphere a square diameter press with up to their number n, and hold n^2 / 6 K1 a sphere; those
  // of diameter d, by the mass of a square diameter, d^4 / m times as much for their mass.
  void require_gentle_start() const {
    constexpr double most = 1, times = 10;  // m g d for a sphere's mass; of what weight holds
    const double mass = loop_->mass(), column = mass / footprint_area(packing_.container);
    const double widest = 2 * packing_.largest_radius();
    const double softer = widest * solid_volume(packing_) / (sphere_volume * mass);
    const double by_weight = softer * column * column / (6 * units_.spheres.stiffness);
    const double held = state_.start_energies.elastic / mass;
    if (held <= most + times * by_weight) return;
    throw std::runtime_error(
        "the overlaps of the start hold " + std::to_string(held) +
        " m g d per sphere, where weight would hold about " + std::to_string(by_weight) +
        ": its springs would throw the bed apart; begin from a packing whose overlaps are those of "
        "its weight on these springs, or lower the stiffness");
  }

  // Rest is tested every fiftieth of the unit of time.
  std::uint64_t check_interval() const {
    return static_cast<std::uint64_t>(std::ceil(0.02 / units_.time_step));
  }
  std::uint64_t steps_to_next(std::uint64_t every) const { return every - loop_->steps() % every; }

  // A motion is sampled about twenty times a period.
  bool is_watched() const { return state_.driven.bin_width > 0 && loop_->floor_moves(); }
  std::uint64_t sample_interval() const {
    const double steps = 0.05 / (loop_->motion().frequency * units_.time_step);
    return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(steps));
  }
  std::uint64_t steps_to_next_sample() const {
    return is_watched() ? steps_to_next(sample_interval()) : check_interval();
  }
  double motion_height() const { return loop_->motion().place_at(loop_->time()).height; }

  void check() {
    if (!loop_->is_sound())
      throw std::runtime_error(
          "a sphere left the container, or overlaps another by more than a fifth of its diameter, "
          "after " +
          std::to_string(loop_->time() * units_.seconds) +
          " s of a tap: the contacts are too soft for the speeds (raise the stiffness), the time "
          "step is too long (raise steps_per_contact), or the start has such overlaps");
    if (loop_->floor_moves()) return;
    const double now = loop_->time() * units_.seconds;
    if (is_at_rest(now)) {
      state_.status = DynamicsStatus::settled;
    } else if (now - motion_seconds() >= settings_.most_seconds) {
      state_.status = DynamicsStatus::capped;
    }
    if (state_.status != DynamicsStatus::running) require_closed_ledger();
  }

  /// Energies of the tap so far, in units of m g d.
  struct Ledger {
    double floor_work, latched, friction;
    double came;     // energy received, and held before
    double missing;  // part of it that is neither held now nor dissipated

    double dissipated() const { return std::abs(latched) + std::abs(friction); }
  };
  Ledger ledger(const Energies& now) const {
    Ledger tap{
        .floor_work = now.floor_work - state_.start_energies.floor_work,
        .latched = now.latched - state_.start_energies.latched,
        .friction = now.friction - state_.start_energies.friction,
        .came = now.floor_work - state_.start_energies.floor_work + state_.start_energies.held(),
        .missing = 0};
    tap.missing = tap.came - now.held() - tap.latched - tap.friction;
    return tap;
  }

  // A step that is too long makes or loses energy: no such tap is recorded. Collisions are right to
  // a share of what moves in them, which beds that bounce on hardly dissipate.
  void require_closed_ledger() const {
    constexpr double widest = 0.1, least = 1e-2;  // share of the moved energy; m g d per sphere
    const Energies now = loop_->energies();
    const Ledger tap = ledger(now);
    const double missing = std::abs(tap.missing);
    const double moved = std::max(tap.dissipated(), std::abs(state_.input + tap.floor_work)) +
                         now.kinetic + now.elastic;
    if (!(missing > widest * moved && missing > least * loop_->mass())) return;
    throw std::runtime_error(
        "the energy ledger of a tap misses " + std::to_string(100 * missing / moved) +
        " % of the greater of what was put in and what was dissipated, and of what still moves or "
        "presses: the time step is too long, raise steps_per_contact");
  }

  double motion_seconds() const { return loop_->motion().duration() * units_.seconds; }

  bool is_at_rest(double now) {
    if (const auto* timed = std::get_if<TimedRest>(&settings_.rest))
      return now - motion_seconds() >= timed->seconds;
    const QuietRest& quiet = std::get<QuietRest>(settings_.rest);
    const double per_mass = loop_->kinetic_energy() / loop_->mass();
    if (per_mass >= quiet.kinetic_energy) {
      state_.quiet_since = -1;
    } else if (state_.quiet_since < 0) {
      state_.quiet_since = now;
    }
    return state_.quiet_since >= 0 && now - state_.quiet_since >= quiet.seconds;
  }

  DiscreteElement settings_;
  ReducedSettings units_;
  Packing packing_;  // state after loading
  GrainDynamicsState state_;
  mutable std::optional<GrainLoop> loop_;  // a census may renew its lists
  Effort effort_;
};

}  // namespace

std::unique_ptr<Dynamics> make_dynamics(const DiscreteElement& settings, const DynamicsStreams&) {
  return std::make_unique<GrainDynamics>(settings);
}

}  // namespace jostle::inline engine
