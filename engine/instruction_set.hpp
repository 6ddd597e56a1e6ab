#pragma once

#include <string_view>

namespace jostle::inline engine {

/// What the kernels are compiled for, the widest last.
enum class InstructionSet { baseline, avx2, avx512 };

std::string_view name(InstructionSet set);
/// The widest instruction set of this machine, or what the environment variable
/// JOSTLE_INSTRUCTION_SET (baseline, avx2, avx512) asks for. All give the same bits.
InstructionSet best_instruction_set();

}  // namespace jostle::inline engine
