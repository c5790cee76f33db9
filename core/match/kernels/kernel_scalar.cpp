#include "core/match/kernels/kernel_template.h"
#include "core/match/kernels/vector_scalar.h"

namespace stereod::kernels {

extern constexpr Kernel kScalarKernel = make_kernel<VectorScalar>();

}  // namespace stereod::kernels
