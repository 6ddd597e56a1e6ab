#include "engine/monte_carlo/kernel/kernel_table.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace jostle::inline engine {

namespace {

struct Entry {
  InstructionSet set;
  std::string_view name;
  bool (*machine_has)();
  Kernels (*kernels)();
};

// The widest first.
constexpr Entry entries[] = {
    {InstructionSet::avx512, "avx512",
     [] {
       return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
              __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
     },
     [] {
       return Kernels{avx512::proposal_kernels(), avx512::rejection_free_kernels()};
     }},
    {InstructionSet::avx2, "avx2", [] { return __builtin_cpu_supports("avx2") != 0; },
     [] {
       return Kernels{avx2::proposal_kernels(), avx2::rejection_free_kernels()};
     }},
    {InstructionSet::baseline, "baseline", [] { return true; },
     [] {
       return Kernels{baseline::proposal_kernels(), baseline::rejection_free_kernels()};
     }},
};

const Entry& entry(InstructionSet set) {
  return *std::ranges::find(entries, set, &Entry::set);
}

}  // namespace

std::string_view name(InstructionSet set) {
  return entry(set).name;
}

InstructionSet best_instruction_set() {
  const char* wanted = std::getenv("JOSTLE_INSTRUCTION_SET");
  for (const Entry& one : entries) {
    if (one.machine_has() && (!wanted || wanted == one.name)) return one.set;
  }
  throw std::invalid_argument(std::string("JOSTLE_INSTRUCTION_SET is \"") + wanted +
                              "\", which this machine does not have: use baseline, avx2 or avx512");
}

Kernels kernels_for(InstructionSet set) {
  return entry(set).kernels();
}

}  // namespace jostle::inline engine
