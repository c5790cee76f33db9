// SPDX-License-Identifier: BSD-3-Clause
// Finds the instruction sets and the cache of this CPU.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/base/enum_names.h"

namespace stereod {

/// Instruction sets that the simd implementation is compiled for. kAuto selects the best one that the CPU has.
enum class Isa { kAuto, kScalar, kSsse3, kSse41, kAvx2, kNeon };

/// Selects how the simd implementation uses the caches. The result is the same.
enum class CacheUse {
  kAuto,  ///< kSmall on CPUs with a first-level data cache of 24 KiB or less, and on ARM; else kLarge
  kLarge,  ///< stores the differences of all rows of the window: 0.5 MiB at 640 px, 64 disparities and window 11
  kSmall,  ///< calculates them twice, in column tiles whose sums fit in a cache of 24 KiB
};

inline constexpr EnumNames<Isa, 6> kIsaNames{{{Isa::kAuto, "auto"},
                                              {Isa::kScalar, "scalar"},
                                              {Isa::kSsse3, "ssse3"},
                                              {Isa::kSse41, "sse41"},
                                              {Isa::kAvx2, "avx2"},
                                              {Isa::kNeon, "neon"}}};
inline constexpr EnumNames<CacheUse, 3> kCacheUseNames{
    {{CacheUse::kAuto, "auto"}, {CacheUse::kLarge, "large"}, {CacheUse::kSmall, "small"}}};

/// Return the names used in configuration files, on command lines and in messages, and the values of such names; nothing
/// if the name is unknown.
std::string_view name_of(Isa isa);
std::string_view name_of(CacheUse cache);
std::optional<Isa> parse_isa(std::string_view name);
std::optional<CacheUse> parse_cache_use(std::string_view name);

/// Returns the instruction sets that this program has kernels for and this CPU can run, the best last. kScalar is always
/// among them.
std::vector<Isa> available_isas();

/// Returns the best available instruction set for kAuto, else @p wanted.
/// @throws std::invalid_argument if this CPU or this build lacks @p wanted.
Isa resolve_isa(Isa wanted);

/// Returns kLarge or kSmall: the one that suits this CPU for kAuto, else @p wanted.
CacheUse resolve_cache_use(CacheUse wanted);

}  // namespace stereod
