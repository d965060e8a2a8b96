#include "lanes/soft/soft_kernel.hpp"

namespace carom::lanes {

SoftKernel avx2_soft_kernel() { return soft_kernel(); }

}  // namespace carom::lanes
