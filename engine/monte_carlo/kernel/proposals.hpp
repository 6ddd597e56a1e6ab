#pragma once

#include <cstdint>

#include "engine/instruction_set.hpp"

// Trial displacements, made in batches so that they vectorise. The proposal of a trial is a
// function of its stream and its number alone; every instruction set makes the same bits.
namespace jostle::inline engine {

/// Proposals of consecutive trials. Displacements: in diameters for the polar move, in units of the
/// step for the Metropolis move.
struct ProposalBatch {
  static constexpr std::uint32_t size = 256;
  static constexpr std::uint32_t margin = 16;  // spheres of the next batch: to be fetched early
  alignas(64) std::uint32_t sphere[size + margin] = {};
  alignas(64) double dx[size];
  alignas(64) double dy[size];
  alignas(64) double dz[size];
};

/// Position of a batch in its stream: trial numbers first .. first + ProposalBatch::size - 1.
struct BatchOrigin {
  std::uint64_t key;    // StreamKey of Purpose::trials
  std::uint64_t first;  // a multiple of ProposalBatch::size
  std::uint32_t n_spheres;
};

/// A word w of a Philox block as a number in (0, 1): (w + 1/2) 2^-32. Word 0 chooses the sphere,
/// floor(w n / 2^32): to within n 2^-32 uniform. Words 1 to 3 choose the displacement.
/// Polar: word 1 the azimuth, word 2 the length, word 3 the angle theta through its table
/// (engine/monte_carlo/theta_table.hpp). Metropolis: words 1, 2, 3 the components, 1 - 2 xi.
struct ProposalKernels {
  void (*polar)(const BatchOrigin& origin, const double* theta_table, double max_step,
                ProposalBatch& batch);
  void (*metropolis)(const BatchOrigin& origin, ProposalBatch& batch);
};

namespace baseline {
ProposalKernels proposal_kernels();
}
namespace avx2 {
ProposalKernels proposal_kernels();
}
namespace avx512 {
ProposalKernels proposal_kernels();
}

/// Throws std::invalid_argument where none are compiled for `set`.
ProposalKernels proposal_kernels_for(InstructionSet set);

}  // namespace jostle::inline engine
