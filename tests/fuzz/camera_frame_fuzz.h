// What the fuzz target tells its driver.
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace stereod {

/// Whether the latest input was taken for a frame.
extern bool last_input_was_a_frame;

}  // namespace stereod
