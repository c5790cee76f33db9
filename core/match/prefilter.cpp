#include "core/match/prefilter.h"

#include "core/match/kernels/row_preparation.h"

namespace stereod {
namespace {

struct Baseline {};

}  // namespace

void xsobel_row(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int width,
                int cap, std::uint8_t* out) noexcept {
  kernels::xsobel_row<Baseline>(above, row, below, width, cap, out);
}

}  // namespace stereod
