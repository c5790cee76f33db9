// SPDX-License-Identifier: BSD-3-Clause
#include "core/base/cpu.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#if defined(__x86_64__) || defined(__i386__)
#include <cpuid.h>
#endif

namespace stereod {
namespace {

#if defined(__x86_64__) || defined(__i386__)
/// Returns the size of the first-level data cache [bytes] from Intel's "deterministic cache parameters" (CPUID leaf 4),
/// 0 if unknown. AMD's CPUs do not report it; all of them have 32 KiB or more.
unsigned first_level_cache_bytes() {
  constexpr unsigned kLeaf = 4;
  for (unsigned index = 0; index < 8; ++index) {
    unsigned eax = 0;
    unsigned ebx = 0;
    unsigned sets = 0;
    unsigned edx = 0;
    if (__get_cpuid_count(kLeaf, index, &eax, &ebx, &sets, &edx) == 0) return 0;
    const unsigned type = eax & 0x1F;  // 0: no more caches, 1: data, 2: instructions, 3: both
    const unsigned level = eax >> 5 & 7;
    if (type == 0) return 0;
    if (level != 1 || type == 2) continue;
    const unsigned ways = (ebx >> 22) + 1;
    const unsigned partitions = (ebx >> 12 & 0x3FF) + 1;
    const unsigned line = (ebx & 0xFFF) + 1;
    return ways * partitions * line * (sets + 1);
  }
  return 0;
}
#endif

}  // namespace

std::string_view name_of(Isa isa) { return find_name(kIsaNames, isa); }
std::string_view name_of(CacheUse cache) { return find_name(kCacheUseNames, cache); }
std::optional<Isa> parse_isa(std::string_view name) { return find_value(kIsaNames, name); }
std::optional<CacheUse> parse_cache_use(std::string_view name) { return find_value(kCacheUseNames, name); }

std::vector<Isa> available_isas() {
  std::vector<Isa> isas{Isa::kScalar};
#if defined(__x86_64__) || defined(__i386__)
  if (__builtin_cpu_supports("ssse3")) isas.push_back(Isa::kSsse3);
  if (__builtin_cpu_supports("sse4.1")) isas.push_back(Isa::kSse41);
  if (__builtin_cpu_supports("avx2")) isas.push_back(Isa::kAvx2);
#elif defined(__aarch64__) || defined(__ARM_NEON)
  // Every 64-bit ARM CPU has NEON; a 32-bit program is built with it or without it.
  isas.push_back(Isa::kNeon);
#endif
  return isas;
}

Isa resolve_isa(Isa wanted) {
  const std::vector<Isa> isas = available_isas();
  if (wanted == Isa::kAuto) return isas.back();
  if (std::find(isas.begin(), isas.end(), wanted) != isas.end()) return wanted;
  std::string names;
  for (const Isa isa : isas) names += ", " + std::string(name_of(isa));
  throw std::invalid_argument("isa " + std::string(name_of(wanted)) +
                              " is not available on this CPU or in this build, allowed auto" + names);
}

CacheUse resolve_cache_use(CacheUse wanted) {
  if (wanted != CacheUse::kAuto) return wanted;
#if defined(__x86_64__) || defined(__i386__)
  constexpr unsigned kMin = 24 * 1024;
  const unsigned bytes = first_level_cache_bytes();
  return bytes > 0 && bytes <= kMin ? CacheUse::kSmall : CacheUse::kLarge;
#elif defined(__aarch64__) || defined(__arm__)
  // Programs cannot read the cache size. The boards' cores share a second-level cache that is smaller than what kLarge
  // takes for each worker.
  return CacheUse::kSmall;
#else
  return CacheUse::kLarge;
#endif
}

}  // namespace stereod
