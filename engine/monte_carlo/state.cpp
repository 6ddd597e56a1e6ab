#include "engine/monte_carlo/state.hpp"

#include <algorithm>
#include <cmath>

#include "engine/state_bytes.hpp"

namespace jostle::inline engine {

namespace {

// "MC" and a number that counts up when the bytes change. Those of a mixture have the heights of
// its kinds at the end.
constexpr std::uint32_t version = 0x4d430001, version_of_mixtures = 0x4d430002;

bool is_length(double x) {
  return std::isfinite(x) && x >= 0;
}

/// True if trials can be made from here.
bool is_possible(const MonteCarloState& state) {
  return is_length(state.move.step) && is_length(state.sampler.reference_step) &&
         is_window(state.stop_window) &&
         std::ranges::all_of(state.progress.kind_heights,
                             [](double height) { return std::isfinite(height); });
}

MonteCarloState read(ByteReader& reader) {
  const auto found = reader.get<std::uint32_t>();
  if (found != version && found != version_of_mixtures) throw std::out_of_range("another version");
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
  if (found == version_of_mixtures) {
    const auto kinds = reader.get<std::uint32_t>();
    if (kinds == 0) throw std::out_of_range("no state of a mixture");
    for (std::uint32_t k = 0; k < kinds; ++k)
      state.progress.kind_heights.push_back(reader.get<double>());
  }
  if (!is_possible(state)) throw std::out_of_range("no state of ours");
  return state;
}

}  // namespace

std::vector<std::byte> bytes_of(const MonteCarloState& state) {
  ByteWriter writer;
  const std::vector<double>& kind_heights = state.progress.kind_heights;
  writer.put(kind_heights.empty() ? version : version_of_mixtures);
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
  if (!kind_heights.empty()) {
    writer.put(static_cast<std::uint32_t>(kind_heights.size()));
    for (const double height : kind_heights) writer.put(height);
  }
  return std::move(writer.bytes());
}

MonteCarloState monte_carlo_state(std::span<const std::byte> bytes) {
  return state_from(bytes, read);
}

}  // namespace jostle::inline engine
