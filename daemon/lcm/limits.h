// What fits on the wire.
#pragma once

namespace stereod {

/// Channel name, its terminating zero and data; LCM 1.3.1 sends more in fragments, of which one lost loses
/// all.
inline constexpr int kMaxDatagram = 65'499;

/// Width or height of an image, px. Receivers refuse more, so that no message can ask them for gigabytes.
inline constexpr int kMaxImageSide = 4096;

}  // namespace stereod
