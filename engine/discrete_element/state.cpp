#include "engine/discrete_element/state.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "engine/bed/container.hpp"
#include "engine/state_bytes.hpp"

namespace jostle::inline engine {

namespace {

// "DE" and a number that counts up when the bytes change.
constexpr std::uint32_t version = 0x44450001;
constexpr std::uint32_t version_of_watched = 0x44450002;  // with what a watched motion sums up

// Aggregates of numbers without padding, as the numbers in a row.
template <class T>
using Numbers = std::array<double, sizeof(T) / sizeof(double)>;

template <class T>
void put_numbers(ByteWriter& writer, const T& value) {
  for (const double number : std::bit_cast<Numbers<T>>(value)) writer.put(number);
}
template <class T>
T get_numbers(ByteReader& reader) {
  Numbers<T> numbers;
  for (double& number : numbers) {
    number = reader.get<double>();
    if (!std::isfinite(number)) throw std::out_of_range("no number");
  }
  return std::bit_cast<T>(numbers);
}

bool are_finite(std::span<const double> numbers) {
  return std::ranges::all_of(numbers, [](double value) { return std::isfinite(value); });
}

// A sphere that lists can be made for. Beds wander through periodic sides; what is thrown higher is
// not sound (GrainLoop::is_sound).
bool is_possible(const GrainState& grain) {
  constexpr double farthest = 1e8;  // diameters
  return are_finite(std::bit_cast<Numbers<GrainState>>(grain)) &&
         std::abs(grain.centre.x) < farthest && std::abs(grain.centre.y) < farthest &&
         std::abs(grain.centre.z) < 2 * widest_container;
}

bool is_possible(const FloorMotion& motion) {
  const double numbers[] = {motion.amplitude, motion.frequency};
  return are_finite(numbers) && motion.frequency > 0 && motion.half_periods <= 2 * most_cycles;
}

bool is_possible(const DrivenSums& driven) {
  const auto bin_is = [](const DrivenSums::Bin& bin) {
    return are_finite(std::bit_cast<Numbers<DrivenSums::Bin>>(bin));
  };
  return std::isfinite(driven.bin_width) && driven.bin_width >= 0 &&
         std::ranges::all_of(driven.bins, bin_is);
}

bool is_possible(const GrainDynamicsState& state) {
  const GrainLoop::State& loop = state.loop;
  const std::size_t n = loop.grains.size();
  const auto pair_is = [&](const KeptPair& pair) {
    return pair.first < pair.second && pair.second < n && are_finite(pair.history);
  };
  const auto side_is = [&](const KeptSide& side) {
    return side.sphere < n && side.side <= 4 && are_finite(side.history);
  };
  const double sums[] = {state.quiet_since, state.input, loop.floor_work, loop.floor_force,
                         loop.greatest_overlap};
  return are_finite(sums) && is_possible(loop.motion) && is_possible(state.driven) &&
         std::ranges::all_of(loop.grains,
                             [](const GrainState& grain) { return is_possible(grain); }) &&
         std::ranges::all_of(loop.pairs, pair_is) && std::ranges::all_of(loop.sides, side_is);
}

GrainDynamicsState read(ByteReader& reader) {
  const auto found = reader.get<std::uint32_t>();
  if (found != version && found != version_of_watched) throw std::out_of_range("another version");
  GrainDynamicsState state;
  state.status = reader.get_enum(DynamicsStatus::capped);
  state.quiet_since = reader.get<double>();
  state.input = reader.get<double>();
  state.dropped_offsets = reader.get<std::uint64_t>();
  state.start_energies = get_numbers<Energies>(reader);
  if (found == version_of_watched) {
    state.driven.bin_width = reader.get<double>();
    state.driven.samples = reader.get<std::uint64_t>();
    state.driven.bins = reader.get_vector<DrivenSums::Bin>();
  }
  GrainLoop::State& loop = state.loop;
  loop.grains = reader.get_vector<GrainState>();
  loop.pairs = reader.get_vector<KeptPair>();
  loop.sides = reader.get_vector<KeptSide>();
  loop.motion.amplitude = reader.get<double>();
  loop.motion.frequency = reader.get<double>();
  loop.motion.half_periods = reader.get<std::uint64_t>();
  loop.steps = reader.get<std::uint64_t>();
  loop.floor_work = reader.get<double>();
  loop.floor_force = reader.get<double>();
  loop.greatest_overlap = reader.get<double>();
  if (!is_possible(state)) throw std::out_of_range("no state of ours");
  return state;
}

}  // namespace

std::vector<std::byte> bytes_of(const GrainDynamicsState& state) {
  ByteWriter writer;
  const bool watched = state.driven.bin_width > 0;
  writer.put(watched ? version_of_watched : version);
  writer.put(state.status);
  writer.put(state.quiet_since);
  writer.put(state.input);
  writer.put(state.dropped_offsets);
  put_numbers(writer, state.start_energies);
  if (watched) {
    writer.put(state.driven.bin_width);
    writer.put(state.driven.samples);
    writer.put(state.driven.bins);
  }
  const GrainLoop::State& loop = state.loop;
  writer.put(loop.grains);
  writer.put(loop.pairs);
  writer.put(loop.sides);
  writer.put(loop.motion.amplitude);
  writer.put(loop.motion.frequency);
  writer.put(loop.motion.half_periods);
  writer.put(loop.steps);
  writer.put(loop.floor_work);
  writer.put(loop.floor_force);
  writer.put(loop.greatest_overlap);
  return std::move(writer.bytes());
}

GrainDynamicsState grain_state(std::span<const std::byte> bytes) {
  return state_from(bytes, read);
}

}  // namespace jostle::inline engine
