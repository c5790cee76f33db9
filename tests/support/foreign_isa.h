// An instruction set that the CPU the tests run on cannot have.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/base/cpu.h"

namespace stereod {

/// Its name in the configuration: that of another family of CPUs.
inline std::string foreign_isa() {
  const std::vector<Isa> isas = available_isas();
  return std::find(isas.begin(), isas.end(), Isa::kNeon) == isas.end() ? "neon" : "ssse3";
}

}  // namespace stereod
