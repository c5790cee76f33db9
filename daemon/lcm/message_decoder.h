// SPDX-License-Identifier: BSD-3-Clause
// Decodes messages that may hold any bytes. All programs of the tree decode here or in daemon/client.
#pragma once

#include <cstddef>
#include <exception>
#include <span>
#include <string_view>

#include "daemon/client/stereod_client.h"
#include "stereod/camera_status_t.hpp"
#include "stereod/depth_rows_t.hpp"
#include "stereod/image_t.hpp"
#include "stereod/planar_lidar_t.hpp"
#include "stereod/pointcloud_t.hpp"
#include "stereod/status_t.hpp"

namespace stereod {

// The letters are explained at kWireLayout in the client library.
template <>
inline constexpr std::string_view kWireLayout<image_t> = "diiiivz";  // without metadata
template <>
inline constexpr std::string_view kWireLayout<planar_lidar_t> = "dffii";
template <>
inline constexpr std::string_view kWireLayout<depth_rows_t> = "ddiiiiiiiiv";
template <>
inline constexpr std::string_view kWireLayout<camera_status_t> = "ssssssssddddiddddddd";
template <>
inline constexpr std::string_view kWireLayout<status_t> =
    "dsssssddddddddd"        // up to publish_errors
    "dddddddb"               // skew, latency, matching, pacing
    "ddddddss"               // shares, CPU, memory, temperature
    "dddidsdddddidd"         // synchronization, epipolar error, healing
    "ssssssssddddiddddddd"   // left
    "ssssssssddddiddddddd";  // right

/// Returns true if the bytes are a pointcloud_t as stereod sends it: with a frame_id, n_points points and no
/// channels.
bool has_pointcloud_layout(std::span<const std::byte> bytes) noexcept;

/// Decodes a message; checks its layout first, because the generated code trusts the lengths that it reads.
/// Returns false if the bytes are not such a message.
template <typename Message>
bool decode_message(std::span<const std::byte> bytes, Message& message) noexcept {
  return decode_message(bytes.data(), bytes.size(), message);
}

/// The same for a point cloud, whose layout kWireLayout cannot express.
inline bool decode_message(std::span<const std::byte> bytes, pointcloud_t& message) noexcept {
  if (!has_pointcloud_layout(bytes)) return false;
  const auto size = static_cast<int>(bytes.size());
  try {
    return message.decode(bytes.data(), 0, size) == size;
  } catch (const std::exception&) {  // out of memory
    return false;
  }
}

}  // namespace stereod
