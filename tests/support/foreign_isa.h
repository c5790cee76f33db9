// SPDX-License-Identifier: BSD-3-Clause
// An instruction set that the CPU of the tests lacks.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/base/cpu.h"

namespace stereod {

/// Returns the configuration name of an instruction set of another CPU family.
inline std::string foreign_isa() {
  const std::vector<Isa> isas = available_isas();
  return std::find(isas.begin(), isas.end(), Isa::kNeon) == isas.end() ? "neon" : "ssse3";
}

}  // namespace stereod
