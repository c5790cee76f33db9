#include "core/base/cpu.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "core/base/enum_names.h"

#if defined(__x86_64__) || defined(__i386__)
#include <cpuid.h>
#endif

namespace stereod {
namespace {

constexpr EnumNames<Isa, 6> kIsas{{{Isa::kAuto, "auto"},
                                   {Isa::kScalar, "scalar"},
                                   {Isa::kSsse3, "ssse3"},
                                   {Isa::kSse41, "sse41"},
                                   {Isa::kAvx2, "avx2"},
                                   {Isa::kNeon, "neon"}}};
constexpr EnumNames<CacheUse, 3> kCacheUses{
    {{CacheUse::kAuto, "auto"}, {CacheUse::kLarge, "large"}, {CacheUse::kSmall, "small"}}};

#if defined(__x86_64__) || defined(__i386__)
// Bytes of the first-level data cache, from Intel's "deterministic cache parameters" (CPUID leaf 4); 0 if it
// does not say. AMD's CPUs do not, and none of them has less than 32 KiB.
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

std::string_view name_of(Isa isa) { return find_name(kIsas, isa); }
std::string_view name_of(CacheUse cache) { return find_name(kCacheUses, cache); }
std::optional<Isa> parse_isa(std::string_view name) { return find_value(kIsas, name); }
std::optional<CacheUse> parse_cache_use(std::string_view name) { return find_value(kCacheUses, name); }

std::vector<Isa> available_isas() {
  std::vector<Isa> isas{Isa::kScalar};
#if defined(__x86_64__) || defined(__i386__)
  if (__builtin_cpu_supports("ssse3")) isas.push_back(Isa::kSsse3);
  if (__builtin_cpu_supports("sse4.1")) isas.push_back(Isa::kSse41);
  if (__builtin_cpu_supports("avx2")) isas.push_back(Isa::kAvx2);
#elif defined(__aarch64__) || defined(__ARM_NEON)
  isas.push_back(Isa::kNeon);  // of every 64-bit ARM; 32-bit programs are built for CPUs that have it, or not
#endif
  return isas;
}

Isa resolve_isa(Isa wanted) {
  const std::vector<Isa> isas = available_isas();
  if (wanted == Isa::kAuto) return isas.back();
  if (std::find(isas.begin(), isas.end(), wanted) != isas.end()) return wanted;
  std::string names;
  for (const Isa isa : isas) names += (names.empty() ? "" : ", ") + std::string(name_of(isa));
  throw std::invalid_argument(
      "isa is " + std::string(name_of(wanted)) +
      ", which this CPU or this build does not have; here auto and these are allowed: " + names);
}

CacheUse resolve_cache_use(CacheUse wanted) {
  if (wanted != CacheUse::kAuto) return wanted;
#if defined(__x86_64__) || defined(__i386__)
  constexpr unsigned kMin = 24 * 1024;
  const unsigned bytes = first_level_cache_bytes();
  return bytes > 0 && bytes <= kMin ? CacheUse::kSmall : CacheUse::kLarge;
#elif defined(__aarch64__) || defined(__arm__)
  // Programs cannot ask. The boards' cores share a second-level cache that is smaller than what large takes
  // for each worker.
  return CacheUse::kSmall;
#else
  return CacheUse::kLarge;
#endif
}

}  // namespace stereod
