// What others of the engine's files ask for and the page does not have.
#include <fmt/format.h>

#include "carom/files/ensembles.hpp"
#include "lanes/free/kernels.hpp"
#include "lanes/free/tangent_pack.hpp"
#include "lanes/soft/soft_pack.hpp"

namespace carom {

std::string text_of(const Shard& shard) { return fmt::format("{}/{}", shard.k, shard.of); }

// Each analysis is told to fly without lanes: a register holds one or two numbers.
namespace lanes {
Kernels kernels_for(InstructionSet, const LaneTable&, Turn) { return {}; }
Kernels no_kernels() { return {}; }
TangentKernels tangent_kernels_for(InstructionSet, const LaneTable&, Turn) { return {}; }
template <>
SoftKernel soft_kernel<InstructionSet::baseline>() {
  return {};
}
}  // namespace lanes

}  // namespace carom
