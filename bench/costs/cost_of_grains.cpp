// Makes COUNT time steps of grains with one effect, to be counted by callgrind.
#include <cstdlib>
#include <map>
#include <string>

#include "bench/costs/cost_grains.hpp"
#include "engine/engines.hpp"

namespace jostle::bench {
namespace {

struct Effect {
  Container container = PeriodicBox{8, 8};
  double friction = 0;
  bool moves = false, is_watched = false;  // the floor; what the bed does while it moves
};

const std::map<std::string, Effect> effects = {
    {"grains", {}},
    {"grains_friction", {.friction = 0.1}},
    {"grains_walls", {.container = WalledBox{8, 8}}},
    {"grains_moving_floor", {.moves = true}},
    {"grains_driven_temperature", {.moves = true, .is_watched = true}},
};

bool make_steps(const Effect& effect, std::uint64_t count) {
  const auto dynamics = make_dynamics(EngineSettings{counted_grains(effect.friction)}, {});
  const Packing bed = stacked_grains(effect.container);
  dynamics->load(bed);
  if (effect.moves) {
    RandomStream random(stream_key(1, 0, 0, Purpose::tap));
    dynamics->tap(Vibration{.strength = 1e-6, .frequency = 30, .cycles = 1000}, random);
    if (effect.is_watched) dynamics->watch_motion(0.5);
  } else {
    dynamics->settle(RandomSettle{});
  }
  return dynamics->advance(count * bed.centres.size()) == DynamicsStatus::running;
}

}  // namespace
}  // namespace jostle::bench

int main(int argc, char** argv) {
  using namespace jostle::bench;
  if (argc != 3) return 2;
  const auto effect = effects.find(argv[1]);
  if (effect == effects.end()) return 2;
  return make_steps(effect->second, std::strtoull(argv[2], nullptr, 10)) ? 0 : 1;
}
