#include "engine/instruction_set.hpp"

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
};

// The widest first.
constexpr Entry entries[] = {
    {InstructionSet::avx512, "avx512",
     [] {
       return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
              __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
     }},
    {InstructionSet::avx2, "avx2", [] { return __builtin_cpu_supports("avx2") != 0; }},
    {InstructionSet::baseline, "baseline", [] { return true; }},
};

}  // namespace

std::string_view name(InstructionSet set) {
  return std::ranges::find(entries, set, &Entry::set)->name;
}

InstructionSet best_instruction_set() {
  const char* wanted = std::getenv("JOSTLE_INSTRUCTION_SET");
  for (const Entry& one : entries) {
    if (one.machine_has() && (!wanted || wanted == one.name)) return one.set;
  }
  throw std::invalid_argument(std::string("JOSTLE_INSTRUCTION_SET is \"") + wanted +
                              "\", which this machine does not have: use baseline, avx2 or avx512");
}

}  // namespace jostle::inline engine
