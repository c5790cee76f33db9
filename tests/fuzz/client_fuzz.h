// What the fuzz target of the client library tells its driver.
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace stereod {

/// How many frames the latest input made.
extern int frames_of_last_input;

}  // namespace stereod
