// SPDX-License-Identifier: BSD-3-Clause
// The choice of the kernel. On emulated CPUs tests/emulated/run.sh says which one it must be.
#include "core/base/cpu.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

namespace stereod {
namespace {

TEST(Isa, Auto_IsLastAvailable) {
  const std::vector<Isa> isas = available_isas();
  ASSERT_FALSE(isas.empty());
  EXPECT_EQ(isas.front(), Isa::kScalar);
  EXPECT_EQ(resolve_isa(Isa::kAuto), isas.back());
  EXPECT_EQ(std::count(isas.begin(), isas.end(), Isa::kAuto), 0);
}

TEST(Isa, Auto_IsExpectedForCpu) {
  const char* const expected = std::getenv("STEREOD_EXPECTED_ISA");
  if (expected == nullptr) GTEST_SKIP() << "STEREOD_EXPECTED_ISA does not say which one this CPU should get";
  EXPECT_EQ(name_of(resolve_isa(Isa::kAuto)), std::string(expected));
}

}  // namespace
}  // namespace stereod
