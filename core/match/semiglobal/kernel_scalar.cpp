#include "core/match/kernels/vector_scalar.h"
#include "core/match/semiglobal/kernel_template.h"

namespace stereod::semiglobal {

extern constexpr Kernel kScalarKernel = make_kernel<kernels::VectorScalar>();

}  // namespace stereod::semiglobal
