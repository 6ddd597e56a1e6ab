#include "engine/monte_carlo/state.hpp"

#include <cmath>

#include "engine/state_bytes.hpp"

namespace jostle::inline engine {

namespace {

// "MC" and a number that counts up when the bytes change.
constexpr std::uint32_t version = 0x4d430001;

bool is_length(double x) {
  return std::isfinite(x) && x >= 0;
}

/// Whether trials can be made from here.
bool is_possible(const MonteCarloState& state) {
  return is_length(state.move.step) && is_length(state.sampler.reference_step) &&
         is_window(state.stop_window);
}

MonteCarloState read(ByteReader& reader) {
  if (reader.get<std::uint32_t>() != version) throw std::out_of_range("another version");
  MonteCarloState state;
  state.tapping = reader.get_flag();
  state.progress.status = reader.get_enum(DynamicsStatus::capped);
  state.progress.trials = reader.get<std::uint64_t>();
  state.progress.accepted = reader.get<std::uint64_t>();
  state.progress.measured = reader.get_flag();
  state.progress.last_value = reader.get<double>();
  state.progress.passes = reader.get<std::uint32_t>();
  state.move.next_trial = reader.get<std::uint64_t>();
  state.move.step = reader.get<double>();
  state.move.window_trials = reader.get<std::uint64_t>();
  state.move.window_base = reader.get<std::uint64_t>();
  state.move.window_accepted = reader.get<std::uint64_t>();
  state.sampler.active = reader.get_flag();
  state.sampler.window_trials = reader.get<std::uint64_t>();
  state.sampler.window_accepted = reader.get<std::uint64_t>();
  state.sampler.candidate = reader.get<std::uint64_t>();
  state.sampler.pending = reader.get<std::uint64_t>();
  state.sampler.reference_step = reader.get<double>();
  state.dropped_offsets = reader.get<std::uint64_t>();
  state.stop_window.low = reader.get<double>();
  state.stop_window.high = reader.get<double>();
  if (!is_possible(state)) throw std::out_of_range("no state of ours");
  return state;
}

}  // namespace

std::vector<std::byte> bytes_of(const MonteCarloState& state) {
  ByteWriter writer;
  writer.put(version);
  writer.put(state.tapping);
  writer.put(state.progress.status);
  writer.put(state.progress.trials);
  writer.put(state.progress.accepted);
  writer.put(state.progress.measured);
  writer.put(state.progress.last_value);
  writer.put(state.progress.passes);
  writer.put(state.move.next_trial);
  writer.put(state.move.step);
  writer.put(state.move.window_trials);
  writer.put(state.move.window_base);
  writer.put(state.move.window_accepted);
  writer.put(state.sampler.active);
  writer.put(state.sampler.window_trials);
  writer.put(state.sampler.window_accepted);
  writer.put(state.sampler.candidate);
  writer.put(state.sampler.pending);
  writer.put(state.sampler.reference_step);
  writer.put(state.dropped_offsets);
  writer.put(state.stop_window.low);
  writer.put(state.stop_window.high);
  return std::move(writer.bytes());
}

MonteCarloState monte_carlo_state(std::span<const std::byte> bytes) {
  return state_from(bytes, read);
}

}  // namespace jostle::inline engine
