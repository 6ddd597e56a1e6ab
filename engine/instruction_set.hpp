#pragma once

#include <string_view>
#include <vector>

namespace jostle::inline engine {

/// The instruction sets of the kernels, the widest last.
enum class InstructionSet { baseline, avx2, avx512 };

std::string_view name(InstructionSet set);
/// Those that this program is compiled for and this machine has, the widest last. All give the same
/// bits. Baseline is always among them: what every processor of its kind has, x86-64 or not.
std::vector<InstructionSet> instruction_sets();
/// The widest of them, or the one that the environment variable JOSTLE_INSTRUCTION_SET names.
/// Throws std::invalid_argument where it names none of them.
InstructionSet best_instruction_set();

/// Throws std::invalid_argument: the program has no kernels for this set.
[[noreturn]] void throw_not_compiled_in(InstructionSet set);

}  // namespace jostle::inline engine
