#include "core/match/block/kernels/kernel-inl.h"
#include "core/match/block/kernels/vector_scalar.h"

namespace stereod::kernels {

extern constexpr Kernel kScalarKernel = make_kernel<VectorScalar>();

}  // namespace stereod::kernels
