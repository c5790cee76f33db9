// What this CPU has.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace stereod {

/// Instruction sets that the simd implementation is compiled for. kAuto takes the best one the CPU has.
enum class Isa { kAuto, kScalar, kSsse3, kSse41, kAvx2, kNeon };

/// What the simd implementation sacrifices to the caches. The result is the same.
enum class CacheUse {
  kAuto,   ///< small on CPUs with a first-level data cache of 24 KiB or less, and on ARM; else large
  kLarge,  ///< keeps the differences of all rows of the window, half a MiB at 640 px, 64 disparities and
           ///< window 11
  kSmall,  ///< calculates them twice, and works in strips of columns whose sums stay in a cache of 24 KiB
};

/// The names used in configuration files, on command lines and in messages. parse_…: nothing if unknown.
std::string_view name_of(Isa isa);
std::string_view name_of(CacheUse cache);
std::optional<Isa> parse_isa(std::string_view name);
std::optional<CacheUse> parse_cache_use(std::string_view name);

/// The instruction sets that this program has kernels for and this CPU can run, best last; kScalar is always
/// among them.
std::vector<Isa> available_isas();

/// The instruction set to use: the best one for kAuto, else `wanted`. Throws std::invalid_argument with a
/// sentence if this CPU cannot run `wanted`.
Isa resolve_isa(Isa wanted);

/// kLarge or kSmall: what suits this CPU for kAuto, else `wanted`.
CacheUse resolve_cache_use(CacheUse wanted);

}  // namespace stereod
