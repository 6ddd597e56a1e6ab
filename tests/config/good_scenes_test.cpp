#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/config/scene_files.hpp"
#include "tests/test_files.hpp"

namespace jostle {

TEST_CASE("Good scenes are read, and read again from their resolved form") {
  for (const auto& file : json_files(good_scenes)) {
    INFO(file.filename().string());
    const ParsedScene parsed = parse_scene(text_of(file));
    CHECK(lines(parsed.faults).empty());
    REQUIRE(parsed.scene.has_value());
    const std::string written = resolved(*parsed.scene).dump(2);
    const Scene repeated = scene_of(written);
    CHECK(repeated == *parsed.scene);
    CHECK(resolved(repeated).dump(2) == written);
  }
}

TEST_CASE("The shortest scene takes its defaults from the aggregates") {
  const Scene scene = scene_of(text_of(good_scenes / "least.json"));
  CHECK(scene.name == "scene");
  CHECK(scene.realizations == 1);
  CHECK(scene.streams == Streams::independent);
  CHECK(scene.container == Container{PeriodicBox{8, 8}});
  CHECK(scene.start == StartChoice{SteepestDescentPour{}});
  CHECK(scene.relax.move == Move{PolarMove{}});
  CHECK(scene.relax.stop == Stop{});
  CHECK(scene.relax.sampler == Sampler::exhaustive);
  CHECK(scene.observables == std::vector<Observable>{MeanHeight{}, BottomFraction{},
                                                     CorrectedFraction{}, BulkFraction{}});
  CHECK(scene.snapshots == SnapshotChoice{});
  CHECK(scene.sweep.empty());
}

TEST_CASE("Every key of a scene is read") {
  const Scene scene = scene_of(text_of(good_scenes / "every_key.json"));
  CHECK(scene.name == "every_key-1.0");
  CHECK(scene.description == "Every key of a scene.");
  CHECK(scene.seed == 18446744073709551615u);
  CHECK(scene.realizations == 12);
  CHECK(scene.streams == Streams::matched);
  CHECK(scene.container == Container{WalledBox{12, 16.5}});
  CHECK(scene.n_spheres == 4096);
  CHECK(scene.start == StartChoice{FittedPour{}});
  REQUIRE(scene.protocol.size() == 7);
  CHECK(scene.protocol[0] == ProtocolLine{Dilate{0.02}, std::nullopt, 100});
  CHECK(scene.protocol[3] == ProtocolLine{Shake{0.02, 0.1, 3}, std::nullopt, 0});
  CHECK(scene.protocol[4] ==
        ProtocolLine{Dilate{0}, Ramp{0.025, 0.4, 0.025, RampScale::square_root}, 2});
  CHECK(scene.relax.move == Move{PolarMove{0.05, 1.5, ThetaLaw::linear}});
  CHECK(scene.relax.stop.rule ==
        StopRule{BulkFractionStop{0.002, 500'000, 3, false, HeightWindow{4, 8.5}}});
  CHECK(scene.relax.stop.max_sweeps == 20'000);
  CHECK(scene.relax.sampler == Sampler::rejection_free);
  const StructureSettings& structure = scene.structure;
  CHECK(structure.region == Region{1.5, 8, 2});
  CHECK(structure.profile == ProfileSettings{0.2, 0, HeightWindow{3, 9}});
  CHECK(structure.sides == SidesSettings{0.25, HeightWindow{2, 7}, 3});
  CHECK(structure.layers == LayersSettings{0.05, {0.2, 0.5, 0.8}});
  CHECK(structure.coordination == CoordinationSettings{1.1, 2, 0.1});
  CHECK(structure.pair_correlation == PairsSettings{3, 0.05});
  CHECK(structure.order == OrderSettings{0.5});
  CHECK(structure.voronoi == VoronoiSettings{0.01, 0.05, true});
  CHECK(structure.pores == PoresSettings{0.01, 2, 1e-5, 0.01, 0.2, true});
  CHECK(structure.void_probability == VoidSettings{1.5, 0.1, 5000});
  CHECK(structure.holes == HolesSettings{{1.25, 1.35, 0.1}});
  REQUIRE(scene.observables.size() == 9);
  CHECK(scene.observables[2] == Observable{CorrectedFraction{0.85}});
  CHECK(scene.observables[4] == Observable{BulkFraction{"upper", HeightWindow{10, 15}}});
  CHECK(scene.observables[5] ==
        Observable{BulkFraction{"middle", QuantileWindow{0.4, 0.6}, 0.8165}});
  CHECK(scene.observables[6] == Observable{CrystallineFraction{}});
  CHECK(scene.observables[7] == Observable{GrownLayers{}});
  CHECK(scene.observables[8] == Observable{OrderedHeight{}});
  CHECK(std::get<LogarithmicTaps>(scene.snapshots.taps) == LogarithmicTaps{1, 100, 2, {0, 120}});
  CHECK(scene.snapshots.positions);
  CHECK(scene.snapshots.coordination);
  CHECK_FALSE(scene.snapshots.height_histogram);
  CHECK(scene.snapshots.contact_cut == 1.1);
  CHECK(scene.snapshots.bin_width == 0.05);
  CHECK(scene.sweep.size() == 2);
}

TEST_CASE("Metropolis moves, their adaptation and beta are read") {
  const Scene scene = scene_of(text_of(good_scenes / "metropolis.json"));
  CHECK(scene.start == StartChoice{Crystal{Lattice::hcp, true}});
  const auto& move = std::get<MetropolisMove>(scene.relax.move);
  CHECK(move.max_step == 0.2);
  CHECK(std::isinf(move.beta));
  CHECK(move.adaptation == StepAdaptation{0.99, 20'000, 0.4, AcceptanceBase::not_upward, false});
  const Scene warm = scene_of(text_of(good_scenes / "finite_beta.json"));
  CHECK(warm.relax.move == Move{MetropolisMove{.max_step = 0.1, .beta = 2.5, .adaptation = {}}});
  CHECK(warm.relax.stop.rule == StopRule{SweepsStop{100}});
}

TEST_CASE("The settings of discrete elements and of a floor that moves are read") {
  const Scene scene = scene_of(text_of(good_scenes / "grains.json"));
  REQUIRE(scene.grains);
  const LinearSpringDashpot spheres{.stiffness = 2e4,
                                    .restitution = 0.7,
                                    .friction = 0.3,
                                    .tangential_ratio = 0.5,
                                    .tangential_damping = 0.25};
  CHECK(*scene.grains == DiscreteElement{.diameter = 0.003,
                                         .density = 2500,
                                         .gravity = 9.8,
                                         .spheres = spheres,
                                         .floor = LinearSpringDashpot{.friction = 0.5},
                                         .sides = LinearSpringDashpot{},
                                         .steps_per_contact = 50,
                                         .rest = TimedRest{0.5},
                                         .most_seconds = 4});
  REQUIRE(scene.protocol.size() == 6);
  CHECK(scene.protocol[0].tap == Tap{HalfSine{0.4, 12}});
  CHECK(scene.protocol[1].tap == Tap{Vibration{0.05, 60, 4}});
  CHECK(scene.protocol[2].ramp == Ramp{0.1, 0.3, 0.1});
  CHECK(scene.protocol[4].tap == Tap{HalfSine{2, 7.5, FloorStrength::acceleration}});
  CHECK(std::get<Vibration>(scene.protocol[5].tap).kind == FloorStrength::acceleration);
  CHECK(scene.protocol[5].ramp == Ramp{1, 3, 1});
  CHECK(engine_of(scene) == EngineSettings{*scene.grains});
  CHECK(scene_of(resolved(scene).dump()) == scene);
}

TEST_CASE("A stop by mean height is relative or in diameters") {
  const Scene scene = scene_of(text_of(good_scenes / "stop_in_diameters.json"));
  CHECK(scene.relax.stop.rule == StopRule{HeightChangeStop{.change = 2e-4, .every_sweeps = 50}});
  REQUIRE(scene.relax_start);
  CHECK(scene.relax_start->stop.rule == StopRule{HeightChangeStop{.change = 1}});
  const auto stop = resolved(scene)["relax"]["stop"]["mean_height"];
  CHECK(stop.at("change") == 2e-4);
  CHECK_FALSE(stop.contains("eta"));
}

TEST_CASE("The scenes of the reference page are scenes") {
  const std::string page = text_of(source_file("docs/reference/scene.md"));
  const std::string fence = "```json\n";
  std::size_t scenes = 0;
  for (auto begin = page.find(fence); begin != page.npos; begin = page.find(fence, begin)) {
    begin += fence.size();
    const std::string block = page.substr(begin, page.find("```", begin) - begin);
    if (block.find("\"seed\"") == block.npos) continue;  // a part of a scene
    INFO(block);
    CHECK(lines(parse_scene(block).faults).empty());
    ++scenes;
  }
  CHECK(scenes == 2);
}

}  // namespace jostle
