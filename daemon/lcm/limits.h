// SPDX-License-Identifier: BSD-3-Clause
// Limits of messages.
#pragma once

namespace stereod {

/// Maximum channel name, its terminating zero and data in one datagram [bytes]. LCM 1.3.1 sends larger
/// messages in fragments; a lost fragment loses the message.
inline constexpr int kMaxDatagram = 65'499;

/// Maximum width or height of an image [px]. Receivers refuse larger ones, so that no message makes them
/// allocate gigabytes.
inline constexpr int kMaxImageSide = 4096;

}  // namespace stereod
