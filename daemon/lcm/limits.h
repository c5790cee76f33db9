// What fits on the wire.
#pragma once

#include "core/base/limits.h"

namespace stereod {

/// Channel name, its terminating zero and data; LCM 1.3.1 sends more in fragments, of which one lost loses
/// all.
inline constexpr int kMaxDatagram = 65'499;

}  // namespace stereod
