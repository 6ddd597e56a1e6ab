#pragma once

#include <cstddef>

#include "engine/instruction_set.hpp"

// Defined where kernels are compiled for AVX2 and AVX-512 besides the baseline:
// engine/CMakeLists.txt compiles them under the same condition.
#if defined(__x86_64__) && !defined(JOSTLE_PORTABLE)
#define JOSTLE_X86_KERNELS
#endif

namespace jostle::inline engine {

/// A function, as it is compiled for one instruction set.
template <class Function>
struct CompiledFor {
  InstructionSet set;
  Function* function;
};

/// Throws std::invalid_argument where it is not compiled for `set`.
template <class Function, std::size_t n>
Function* function_for(InstructionSet set, const CompiledFor<Function> (&compiled)[n]) {
  for (const CompiledFor<Function>& entry : compiled) {
    if (entry.set == set) return entry.function;
  }
  throw_not_compiled_in(set);
}

}  // namespace jostle::inline engine
