#include "engine/instruction_set.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "engine/kernel_sets.hpp"

namespace jostle::inline engine {

namespace {

struct Entry {
  InstructionSet set;
  std::string_view name;
  bool (*usable)();  // compiled in, and known to the machine
};

// The widest last.
constexpr Entry entries[] = {
    {InstructionSet::baseline, "baseline", [] { return true; }},
#ifdef JOSTLE_X86_KERNELS
    {InstructionSet::avx2, "avx2", [] { return __builtin_cpu_supports("avx2") != 0; }},
    {InstructionSet::avx512, "avx512",
     [] {
       return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
              __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
     }},
#else
    {InstructionSet::avx2, "avx2", [] { return false; }},
    {InstructionSet::avx512, "avx512", [] { return false; }},
#endif
};

}  // namespace

std::string_view name(InstructionSet set) {
  return std::ranges::find(entries, set, &Entry::set)->name;
}

std::vector<InstructionSet> instruction_sets() {
  std::vector<InstructionSet> usable;
  for (const Entry& entry : entries) {
    if (entry.usable()) usable.push_back(entry.set);
  }
  return usable;
}

InstructionSet best_instruction_set() {
  const std::vector<InstructionSet> usable = instruction_sets();
  const char* wanted = std::getenv("JOSTLE_INSTRUCTION_SET");
  if (!wanted) return usable.back();
  std::string names;
  for (const InstructionSet instructions : usable) {
    if (wanted == name(instructions)) return instructions;
    names += (names.empty() ? "" : ", ") + std::string(name(instructions));
  }
  throw std::invalid_argument(std::string("JOSTLE_INSTRUCTION_SET is \"") + wanted +
                              "\", which this machine does not have: use one of " + names);
}

void throw_not_compiled_in(InstructionSet set) {
  throw std::invalid_argument("this program has no kernels for " + std::string(name(set)) +
                              ": it was built for another processor, or with JOSTLE_PORTABLE");
}

}  // namespace jostle::inline engine
