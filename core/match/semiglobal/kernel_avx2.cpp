#include "core/match/kernels/vector_avx2.h"
#include "core/match/semiglobal/kernel_template.h"

namespace stereod::semiglobal {

extern constexpr Kernel kAvx2Kernel = make_kernel<kernels::VectorAvx2>();

}  // namespace stereod::semiglobal
