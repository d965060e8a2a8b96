// What others of the engine's files ask for and the page does not have.
#include <fmt/format.h>

#include "carom/files/ensembles.hpp"
#include "files/text_file.hpp"
#include "lanes/free/kernels.hpp"
#include "lanes/free/tangent_pack.hpp"
#include "lanes/soft/soft_pack.hpp"

namespace carom {

std::string text_of(const Shard& shard) { return fmt::format("{}/{}", shard.k, shard.of); }

std::string files::text_of_file(const std::string&, std::size_t, const Place& place,
                                const std::string& subject, const std::string& expected) {
  throw InputError(place, subject + "cannot be read: the page reads no files", expected);
}

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
