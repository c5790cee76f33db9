// What this CPU has.
#pragma once

#include <vector>

#include "core/match/matcher_options.h"

namespace stereod {

/// The instruction sets that this program has kernels for and this CPU can run, best last; kScalar is always
/// among them.
std::vector<Isa> available_isas();

/// The instruction set to use: the best one for kAuto, else `wanted`. Throws std::invalid_argument with a
/// sentence if this CPU cannot run `wanted`.
Isa resolve_isa(Isa wanted);

/// kLarge or kSmall: what suits this CPU for kAuto, else `wanted`.
CacheUse resolve_cache_use(CacheUse wanted);

}  // namespace stereod
