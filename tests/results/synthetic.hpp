#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "ensemble/sink.hpp"
#include "results/content/study.hpp"

// A stand-in for the engine: realizations whose numbers are hashes that depend on their state, like
// real ones, so that a wrong restart gives wrong rows.
namespace jostle::synthetic {

/// The spheres of a study: equal, a mixture of fixed diameters, or one whose realizations draw
/// theirs.
enum class StudySpheres { equal, fixed, drawn };

struct StudySize {
  std::uint32_t points = 2, realizations = 3, spheres = 5;
  std::uint64_t taps = 6;
  std::vector<std::uint64_t> snapshot_taps = {0, 2, 6};
  StudySpheres kinds = StudySpheres::equal;
};

/// A study with two observables; its resolved scene names the sizes.
Study study(const StudySize& sizes = {});

struct Conduct {
  std::uint64_t checkpoint_every = 2;  // steps, of which a tap takes three
  std::uint64_t steps = std::numeric_limits<std::uint64_t>::max();  // then stop, as by a signal
  bool leave_without_end = false;  // stop as by SIGKILL: neither checkpoint nor end
  std::uint64_t fail_at_tap = std::numeric_limits<std::uint64_t>::max();
};

/// Runs one realization from its last checkpoint.
void run(Sink& sink, const Study& study, RealizationId id, const Conduct& conduct = {});

/// The row that a straight run records at a tap.
TapRow expected_row(const Study& study, RealizationId id, std::uint64_t tap);

Provenance provenance();

}  // namespace jostle::synthetic
