// From bytes that came over the network to a message, whatever the bytes are.
#pragma once

#include <cstddef>
#include <exception>
#include <span>
#include <string_view>

#include "stereod/camera_info_t.hpp"
#include "stereod/disparity_rows_t.hpp"
#include "stereod/frame_t.hpp"
#include "stereod/status_t.hpp"

namespace stereod {

/// How a message lies on the wire after its fingerprint, a letter a field: b 1 byte, i 4 bytes, d 8 bytes,
/// s a string (its length with the closing zero, then that), v a byte array (its length, then the bytes).
template <typename Message>
inline constexpr std::string_view kWireLayout;
template <>
inline constexpr std::string_view kWireLayout<disparity_rows_t> = "ddiiiiiiibiv";
template <>
inline constexpr std::string_view kWireLayout<frame_t> = "ddiiiiiddiiiiiii";
template <>
inline constexpr std::string_view kWireLayout<camera_info_t> = "diibddddddiis";
template <>
inline constexpr std::string_view kWireLayout<status_t> =
    "dssssdddddddddddddddddddsdddid"
    "ssssssssdddddddddd"
    "ssssssssdddddddddd";

/// True if the bytes are a fingerprint and exactly the fields of `layout`, every length inside the bytes.
bool has_layout(std::span<const std::byte> bytes, std::string_view layout) noexcept;

/// Decodes a message; false if the bytes are not one. Checks the layout first, because the code that lcm-gen
/// makes believes the lengths it reads: a string length of 0 throws, one of -2^31 reads past the end, and an
/// array may ask for 2 GB.
template <typename Message>
bool decode_message(std::span<const std::byte> bytes, Message& message) noexcept {
  static_assert(!kWireLayout<Message>.empty(), "say how this message lies on the wire");
  if (!has_layout(bytes, kWireLayout<Message>)) return false;
  try {
    return message.decode(bytes.data(), 0, static_cast<int>(bytes.size())) == static_cast<int>(bytes.size());
  } catch (const std::exception&) {  // out of memory
    return false;
  }
}

}  // namespace stereod
