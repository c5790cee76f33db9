#include "core/match/block/kernels/vector_scalar.h"
#include "core/match/semiglobal/kernels/kernel-inl.h"

namespace stereod::semiglobal {

extern constexpr Kernel kScalarKernel = make_kernel<kernels::VectorScalar>();

}  // namespace stereod::semiglobal
