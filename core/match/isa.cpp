#include "core/match/isa.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace stereod {

std::vector<Isa> available_isas() {
  std::vector<Isa> isas{Isa::kScalar};
#if defined(__x86_64__) || defined(__i386__)
  if (__builtin_cpu_supports("ssse3")) isas.push_back(Isa::kSsse3);
  if (__builtin_cpu_supports("sse4.1")) isas.push_back(Isa::kSse41);
  if (__builtin_cpu_supports("avx2")) isas.push_back(Isa::kAvx2);
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

}  // namespace stereod
