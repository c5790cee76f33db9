// SPDX-License-Identifier: BSD-3-Clause
#include "core/rectify/bilinear.h"

#include "core/rectify/bilinear-inl.h"

namespace stereod {

void blend_row_avx2(const BlendRow& row, int count, std::uint8_t* out);

Blend blend_for(Isa isa) {
#if defined(__x86_64__) || defined(__i386__)
  if (isa == Isa::kAvx2) return blend_row_avx2;
#endif
  struct Baseline {};
  static_cast<void>(isa);
  return blend_row<Baseline>;
}

}  // namespace stereod
