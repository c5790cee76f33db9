// SPDX-License-Identifier: BSD-3-Clause
#include "core/rectify/bilinear.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "core/base/cpu.h"

namespace stereod {
namespace {

TEST(Bilinear, EveryIsa_Equal) {
  constexpr int kMax = 300;
  std::mt19937 random(5);
  const std::unique_ptr<std::uint8_t[]> bytes(new std::uint8_t[std::size_t{4} * kMax]);
  for (std::size_t i = 0; i < std::size_t{4} * kMax; ++i) bytes[i] = static_cast<std::uint8_t>(random());
  std::vector<std::uint8_t> across(kMax), down(kMax);
  for (int i = 0; i < kMax; ++i) {
    const auto at = static_cast<std::size_t>(i);
    across[at] = static_cast<std::uint8_t>(4 * (i < 33 ? static_cast<unsigned>(i) : random() % 33));
    down[at] = static_cast<std::uint8_t>(i < 33 ? 32 : random() % 33);
    if (i % 7 == 0) bytes[at] = 255, bytes[at + kMax] = 0;
    if (i % 5 == 0) bytes[at + 2 * kMax] = 0, bytes[at + 3 * kMax] = 255;
  }
  const BlendRow row{bytes.get(),   bytes.get() + kMax, bytes.get() + 2 * kMax, bytes.get() + 3 * kMax,
                     across.data(), down.data()};
  for (const Isa isa : available_isas()) {
    for (const int count : {1, 7, 16, 33, kMax}) {
      std::vector<std::uint8_t> out(static_cast<std::size_t>(count) + 1, 77);
      blend_for(isa)(row, count, out.data());
      for (int i = 0; i < count; ++i) {
        const int a = across[static_cast<std::size_t>(i)] / 4, d = down[static_cast<std::size_t>(i)];
        const int sum = (32 - d) * ((32 - a) * row.top_left[i] + a * row.top_right[i]) +
                        d * ((32 - a) * row.bottom_left[i] + a * row.bottom_right[i]);
        ASSERT_EQ(int{out[static_cast<std::size_t>(i)]}, (sum + 512) / 1024) << name_of(isa) << ' ' << i;
      }
      EXPECT_EQ(out.back(), 77) << name_of(isa);
    }
  }
}

}  // namespace
}  // namespace stereod
