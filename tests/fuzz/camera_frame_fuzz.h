// SPDX-License-Identifier: BSD-3-Clause
// The fuzz target and what it tells its driver.
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace stereod {

/// True if the latest input was accepted as a frame.
extern bool last_input_was_a_frame;

}  // namespace stereod
