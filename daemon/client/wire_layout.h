// SPDX-License-Identifier: BSD-3-Clause
// From bytes of the network to a message: the layout of the bytes is checked before the generated code decodes them.
#pragma once

#include <cstddef>
#include <exception>
#include <string_view>

#include "stereod/camera_info_t.hpp"
#include "stereod/disparity_rows_t.hpp"
#include "stereod/frame_t.hpp"

namespace stereod {

/// The fields of a message on the wire after its fingerprint, one letter a field:
///
/// | letter | field |
/// |---|---|
/// | b, i, d | 1, 4, 8 bytes |
/// | s | string: its length including the closing zero (4 bytes), then its bytes |
/// | v | byte array: its length (4 bytes), then its bytes |
/// | f | array of floats: their number (4 bytes), then 4 bytes each |
/// | z | number of structs, which must be 0 because stereod never sends any |
template <typename Message>
inline constexpr std::string_view kWireLayout;
template <>
inline constexpr std::string_view kWireLayout<disparity_rows_t> = "ddiiiiiiiiiiibibvvv";
template <>
inline constexpr std::string_view kWireLayout<frame_t> = "ddiiiiiiibsddiiiiiiibbii";
template <>
inline constexpr std::string_view kWireLayout<camera_info_t> = "diibbddddddiisdddddd";

/// Returns whether @p bytes are a fingerprint followed by exactly the fields of @p layout, every length inside the bytes.
bool has_layout(const void* bytes, std::size_t size, std::string_view layout) noexcept;

/// Decodes a message. Returns false if @p bytes are not one.
///
/// Checks the layout first, because the code that lcm-gen makes trusts the lengths it reads: a string length of 0 throws, a
/// string length of −2^31 reads past the end, and an array may ask for 2 GB.
template <typename Message>
bool decode_message(const void* bytes, std::size_t size, Message& message) noexcept {
  static_assert(!kWireLayout<Message>.empty(), "kWireLayout lacks this message");
  if (!has_layout(bytes, size, kWireLayout<Message>)) return false;
  try {
    return message.decode(bytes, 0, static_cast<int>(size)) == static_cast<int>(size);
  } catch (const std::exception&) {  // out of memory
    return false;
  }
}

}  // namespace stereod
