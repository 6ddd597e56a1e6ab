#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "config/fault.hpp"
#include "config/json/json.hpp"
#include "engine/bed/mixture.hpp"
#include "engine/fields.hpp"
#include "ensemble/analysis/analyses.hpp"
#include "ensemble/plan.hpp"
#include "ensemble/target_precision.hpp"
#include "structure/measure.hpp"

// A scene: one JSON file, read into plain aggregates. docs/reference/scene.md describes every key.
namespace jostle::inline config {

/// "start": {"file": ...}: a packing saved by an earlier run (.h5, .hdf5: point, realization, tap)
/// or extended XYZ (.xyz, .extxyz: frame).
struct PackingFile {
  std::string path;         // relative to the folder of the scene file
  std::uint32_t point = 0;  // index of the sweep point of the earlier run
  std::uint32_t realization = 0;
  std::optional<std::uint64_t> tap;    // a snapshot of the earlier run; absent: its last
  std::optional<std::uint64_t> frame;  // counted from 0; absent: the last
  double overlap = 0;                  // the deepest that is accepted, diameters
  bool operator==(const PackingFile&) const = default;
  // libc++ before version 18 compares no optional values by <=>.
  friend bool operator<(const PackingFile& a, const PackingFile& b) {
    const auto members = [](const PackingFile& file) {
      return std::tie(file.path, file.point, file.realization, file.tap, file.frame, file.overlap);
    };
    return members(a) < members(b);
  }

  static constexpr Description description{
      "file",
      "Results of an earlier run (.h5, .hdf5) or extended XYZ (.xyz, .extxyz); a path from the "
      "folder of the scene",
      "Packing from a file"};
};

/// The starts of the engine, with a file in the place of the packing that it holds.
template <class Variant>
struct ChosenStart;
template <class... Starts>
struct ChosenStart<std::variant<Starts...>> {
  using Type = std::variant<
      std::conditional_t<std::is_same_v<Starts, GivenPacking>, PackingFile, Starts>...>;
};
using StartChoice = ChosenStart<Start>::Type;

/// Strengths from `start` to `end`, both included, `step` apart; downwards where from > to. With
/// square_root the three are square roots, and a tap's strength is their square: [PB]'s control
/// parameter is epsilon^(1/2).
enum class RampScale { linear, square_root };
struct Ramp {
  double start = 0, end = 0, step = 0;
  RampScale scale = RampScale::linear;
  bool operator==(const Ramp&) const = default;
};

/// The strengths of a ramp, in order. A value in between is rounded to 15 significant digits, so
/// that it is the number a person would have typed, and the same on the way up and down.
std::vector<double> strengths(const Ramp& ramp);

/// One line of a protocol: `count` taps, or `count` taps at each strength of a ramp; the strength
/// of `tap` itself is then unused (zero).
struct ProtocolLine {
  Tap tap;
  std::optional<Ramp> ramp;
  std::uint64_t count = 0;
  bool operator==(const ProtocolLine&) const = default;
};

/// Taps from 10^(k / per_decade) x `first`, rounded, at most `last`; and `also`, any others.
struct LogarithmicTaps {
  std::uint64_t first = 1, last = 1;
  std::uint32_t per_decade = 3;
  std::vector<std::uint64_t> also = {};  // ascending
  bool operator==(const LogarithmicTaps&) const = default;
};

/// Taps as the scene gives them: ascending, or a logarithmic grid.
using TapChoice = std::variant<std::vector<std::uint64_t>, LogarithmicTaps>;

struct SnapshotChoice {
  TapChoice taps;
  std::optional<std::uint64_t> every;  // also tap 0 and each tap that is a multiple of it
  bool positions = true, coordination = true, height_histogram = true;
  double contact_cut = 1.05, bin_width = 0.1;  // diameters
  // Of discrete elements, which keep them by default:
  bool velocities = false, contacts = false, granular_temperature = false, forces = false;
  bool driven_temperature = false;  // discrete elements only
  bool operator==(const SnapshotChoice&) const = default;
};

/// How the motion of spheres is followed while they are tapped. docs/reference/analyses.md.
struct MotionChoice {
  std::optional<TapChoice> origins;                  // absent: 0 and two per decade
  std::optional<TapChoice> lags;                     // absent: ten per decade
  std::vector<double> overlap_lengths = {0.1, 0.3};  // diameters, ascending
  std::uint32_t layers = 5;
  bool operator==(const MotionChoice&) const = default;

  template <class Self = MotionChoice>
  static constexpr auto fields() {
    return std::tuple{
        field("origins", &Self::origins, TapNumbers{},
              "Taps that displacements are counted from, the waiting times, at most 1000; 0 is the "
              "start. Each keeps the centres of all spheres, 24 bytes per sphere. Default: 0 and "
              "two per decade"),
        field(
            "lags", &Self::lags, TapNumbers{},
            "Taps after an origin at which they are measured, at most 1000, the first at least 1. "
            "Default: ten per decade"),
        field("overlap_lengths", &Self::overlap_lengths,
              list_of(Number{left_open_range(0, 100)}, 1, most_overlap_lengths,
                      "lengths in diameters", true),
              "Lengths a in diameters: the overlap is the fraction of spheres that moved less"),
        field("layers", &Self::layers, Whole{1, most_motion_layers},
              "Layers of equal numbers of spheres, by height at the origin")};
  }
};

/// Values that vary together: one list of values a pointer, all of one length. An axis with one
/// pointer is a plain axis, with several a zipped one. Axes are crossed, the first varies slowest.
struct SweepAxis {
  std::vector<std::pair<std::string, std::vector<Json>>> columns;
  std::size_t size() const { return columns.empty() ? 0 : columns.front().second.size(); }
  bool operator==(const SweepAxis&) const = default;
};

/// Laws of an approach to a final value.
std::vector<std::string> relaxation_laws();
/// Those of the model "all", which compete for one curve: no two draw the same curves.
std::vector<std::string> competing_laws();

/// Laws fitted to the mean of an observable against taps, at every sweep point, when a run ends.
struct FitRequest {
  std::string observable;           // a name of an observable of the scene
  std::vector<std::string> models;  // docs/reference/laws.md; {"all"}: those that compete
  std::uint64_t first = 1;          // tap
  std::optional<std::uint64_t> last = std::nullopt;  // tap; absent: the last one
  bool operator==(const FitRequest&) const = default;
};

/// An analysis of one observable, as the scene calls it.
template <class Settings>
struct AnalysisRequest {
  std::string observable;
  Settings settings;
  bool operator==(const AnalysisRequest&) const = default;

  template <class Self = AnalysisRequest>
  static constexpr auto fields() {
    return std::tuple{field("observable", &Self::observable, Text{}, "One that the scene observes",
                            {.required = "the name of an observable of this scene"}),
                      inlined(&Self::settings)};
  }
};

/// The list of analyses of one kind, under the name of the kind.
template <class Part, class Settings>
constexpr auto asked_for(std::vector<AnalysisRequest<Settings>> Part::*member,
                         bool unless_empty = false) {
  return field(Settings::description.name, member,
               list_of(Object<AnalysisRequest<Settings>>{}, 0, 100, "analyses"),
               Settings::description.text, {.unless_default = unless_empty});
}

/// Analyses made at the end of a run, at every sweep point. docs/reference/analyses.md.
struct Analyses {
  std::vector<AnalysisRequest<SteadySettings>> steady;
  std::vector<AnalysisRequest<SpectrumSettings>> spectrum;
  std::vector<AnalysisRequest<AgeingSettings>> ageing;
  std::vector<AnalysisRequest<HysteresisSettings>> hysteresis;
  std::vector<AnalysisRequest<OrderingSettings>> ordering;  // also over the points
  std::vector<AnalysisRequest<SweepSettings>> sweep;        // over the points
  std::vector<AnalysisRequest<VolumesSettings>> volumes;    // also over the points
  std::vector<AnalysisRequest<MemorySettings>> memory;      // also over the points
  bool operator==(const Analyses&) const = default;

  /// Later kinds are written only where there are any, so that runs of earlier versions can be
  /// resumed.
  template <class Self = Analyses>
  static constexpr auto fields() {
    return std::tuple{asked_for(&Self::steady),        asked_for(&Self::spectrum),
                      asked_for(&Self::ageing),        asked_for(&Self::hysteresis),
                      asked_for(&Self::sweep),         asked_for(&Self::ordering, true),
                      asked_for(&Self::volumes, true), asked_for(&Self::memory, true)};
  }
  bool empty() const { return *this == Analyses{}; }
};

struct Scene {
  std::string name = "scene", description;
  std::uint64_t seed = 0;
  std::uint32_t realizations = 1;  // per sweep point; with `until`, at first
  Streams streams = Streams::independent;

  Container container;
  std::uint32_t n_spheres = 0;     // all kinds together
  std::vector<MixtureKind> kinds;  // empty: equal spheres, or the sizes of a file
  PourOrder pour_order = PourOrder::random;
  StartChoice start;
  std::vector<ProtocolLine> protocol;
  Relaxation relax;
  std::optional<Relaxation> relax_start;  // absent: a random settle as `relax`, else none
  std::optional<DiscreteElement> grains;  // they move by these, not by Monte Carlo

  std::vector<Observable> observables{MeanHeight{}, BottomFraction{}, CorrectedFraction{},
                                      BulkFraction{}};
  SnapshotChoice snapshots;
  std::optional<MotionChoice> motion;
  std::vector<SweepAxis> sweep;
  std::vector<std::string> point_labels;  // by sweep point; empty: made of the values
  TargetPrecision until;
  std::vector<FitRequest> fits;
  Analyses analyse;
  StructureSettings structure;
  bool operator==(const Scene&) const = default;
};

/// Returns the keys of the scene that request tables, which are made after the run: "fits", ...
std::vector<std::string> requested_tables(const Scene& scene);

/// The engine that the scene asks for, with its settings.
EngineSettings engine_of(const Scene& scene);

/// A scene, or every fault that keeps the text from being one.
struct ParsedScene {
  std::optional<Scene> scene;
  std::vector<Scene> points;  // by sweep point; without a sweep only the scene
  std::vector<Fault> faults;  // empty if and only if there is a scene
};

/// Reads a scene. Reports every fault: of syntax (with line and column), duplicate and unknown
/// keys, wrong types, values out of range or at odds with each other, also at single sweep points.
ParsedScene parse_scene(std::string_view json_text);

/// Like parse_scene(), for parsed JSON: reports every fault except those of syntax.
ParsedScene checked_scene(const Json& document);

/// The parts of structure to measure, or every fault of the text.
struct ParsedStructure {
  std::optional<StructureSettings> settings;
  std::vector<Fault> faults;  // empty if and only if there are settings
};

/// Reads an object as the key "structure" of a scene holds it.
ParsedStructure parse_structure(std::string_view json_text);

/// The settings with every default of their parts written out.
Json resolved(const StructureSettings& settings);

/// Names of the parts that are measured: "profile", "pores", ...
std::vector<std::string> parts_of(const StructureSettings& settings);

/// The settings with exactly the named parts; parts missing in `settings` have their defaults.
StructureSettings with_parts(StructureSettings settings, std::span<const std::string> names);

/// The scene with every default written out, keys in a fixed order: checked_scene(resolved(s))
/// gives s again.
Json resolved(const Scene& scene);

/// Number of sweep points, 1 without a sweep.
std::size_t n_sweep_points(const Scene& scene);

/// Reads a saved packing. May throw; make_plans lets it pass.
using PackingLoader = std::function<Packing(const PackingFile&)>;

/// The scene of every sweep point, in the order of the sweep (first axis slowest); of a scene that
/// was parsed, ParsedScene has them.
std::vector<Scene> point_scenes(const Scene& scene);

/// One plan per sweep point, of their scenes. Calls `load` once for every distinct file. Throws
/// StartError where a file does not hold the spheres of the scene, or holds spheres of several
/// sizes that something in the scene does not take.
std::vector<Plan> make_plans(const Scene& scene, const std::vector<Scene>& points,
                             const PackingLoader& load);
/// Makes the scenes of the points, too.
std::vector<Plan> make_plans(const Scene& scene, const PackingLoader& load);

/// The JSON Schema (draft-07) of scenes, which the build writes to scene.schema.json.
std::string scene_schema();

/// Why a run of the scene `was` cannot be resumed as another, given with the scenes of its points:
/// one fault for everything that changed, but for more taps at the end, snapshots of those, more
/// realizations, more values of what is swept, other limits of `until`, fits, analyses and measured
/// structure, and another name or description.
std::vector<Fault> resume_faults(const ParsedScene& was, const Scene& scene,
                                 const std::vector<Scene>& points);

/// One scene of two that differ in the values of their sweep alone, and maybe in name and
/// description, which are the first one's: every axis with the values of both, the first one's
/// first. Faults where anything else differs, and those of either.
ParsedScene join_sweeps(const ParsedScene& first, const ParsedScene& second);

}  // namespace jostle::inline config
