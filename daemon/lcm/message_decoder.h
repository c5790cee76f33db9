// From bytes that came over the network to a message, whatever the bytes are.
#pragma once

#include <cstddef>
#include <span>

#include "daemon/client/stereod_client.h"
#include "stereod/image_t.hpp"
#include "stereod/planar_lidar_t.hpp"
#include "stereod/status_t.hpp"

namespace stereod {

template <>
inline constexpr std::string_view kWireLayout<image_t> = "diiiivz";  // without metadata
template <>
inline constexpr std::string_view kWireLayout<planar_lidar_t> = "dffii";

template <>
inline constexpr std::string_view kWireLayout<status_t> =
    "dsssssddddddddd"  // up to publish_errors
    "dddddddb"         // skew, latency, matching, pacing
    "ddddddss"         // shares, CPU, memory, temperature
    "dddidsdddddidd"   // synchronization, epipolar error, healing
    "ssssssssddddiddddddd"
    "ssssssssddddiddddddd";

/// decode_message() of the client library, for bytes as the receiver hands them over.
template <typename Message>
bool decode_message(std::span<const std::byte> bytes, Message& message) noexcept {
  return decode_message(bytes.data(), bytes.size(), message);
}

}  // namespace stereod
