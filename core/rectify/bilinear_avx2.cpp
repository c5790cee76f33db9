// SPDX-License-Identifier: BSD-3-Clause
#include "core/rectify/bilinear-inl.h"

namespace stereod {

void blend_row_avx2(const BlendRow& row, int count, std::uint8_t* out);

void blend_row_avx2(const BlendRow& row, int count, std::uint8_t* out) {
  struct Avx2 {};
  blend_row<Avx2>(row, count, out);
}

}  // namespace stereod
