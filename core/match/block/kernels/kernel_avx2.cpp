#include "core/match/block/kernels/kernel-inl.h"
#include "core/match/block/kernels/vector_avx2.h"

namespace stereod::kernels {

extern constexpr Kernel kAvx2Kernel = make_kernel<VectorAvx2>();

}  // namespace stereod::kernels
