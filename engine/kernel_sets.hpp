#pragma once

#include <initializer_list>

#include "engine/instruction_set.hpp"

// JOSTLE_X86_KERNELS: kernels are compiled for AVX2 and AVX-512 besides the baseline.
// engine/CMakeLists.txt compiles them under the same condition. JOSTLE_EVERY_SET lists a function
// that every set has, for function_for().
#if defined(__x86_64__) && !defined(JOSTLE_PORTABLE)
#define JOSTLE_X86_KERNELS
#define JOSTLE_EVERY_SET(function)                                                          \
  {                                                                                         \
    {InstructionSet::baseline, baseline::function}, {InstructionSet::avx2, avx2::function}, \
        {InstructionSet::avx512, avx512::function},                                         \
  }
#else
#define JOSTLE_EVERY_SET(function) \
  { {InstructionSet::baseline, baseline::function}, }
#endif

namespace jostle::inline engine {

/// A function, as it is compiled for one instruction set.
template <class Function>
struct CompiledFor {
  InstructionSet set;
  Function* function;
};

/// Returns the function for `set`: function_for<Kernels()>(set, JOSTLE_EVERY_SET(kernels)). Throws
/// std::invalid_argument where it is not compiled for it.
template <class Function>
Function* function_for(InstructionSet set, std::initializer_list<CompiledFor<Function>> compiled) {
  for (const CompiledFor<Function>& entry : compiled) {
    if (entry.set == set) return entry.function;
  }
  throw_not_compiled_in(set);
}

}  // namespace jostle::inline engine
