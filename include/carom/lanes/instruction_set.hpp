// The instruction sets that lanes were compiled for.
#pragma once

#include <vector>

namespace carom {

/// Instruction sets that lanes were compiled for, widest last. Results never depend on it.
enum class InstructionSet { baseline, avx2, avx512 };
const char* name_of(InstructionSet);
/// Can this machine run it?
bool available(InstructionSet);
/// Those it can, and the widest of them.
std::vector<InstructionSet> available_instruction_sets();
InstructionSet widest_instruction_set();

}  // namespace carom
