// SPDX-License-Identifier: BSD-3-Clause
// The interface between the fuzz target of the client library and its driver.
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace stereod {

/// Number of frames that the latest input made.
extern int frames_of_last_input;

}  // namespace stereod
