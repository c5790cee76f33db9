// SPDX-License-Identifier: BSD-3-Clause
// Limits of messages.
#pragma once

#include "core/base/limits.h"

namespace stereod {

/// Maximum channel name, its terminating zero and data in one datagram [bytes]. LCM 1.3.1 sends larger
/// messages in fragments; a lost fragment loses the message.
inline constexpr int kMaxDatagram = 65'499;

}  // namespace stereod
