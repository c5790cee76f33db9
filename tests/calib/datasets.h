// SPDX-License-Identifier: BSD-3-Clause
// The public image sets that tests read; tests skip where they are missing.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace stereod::calib {

/// Returns the directory of the sets: $STEREO_DATASETS, or the default beside the source tree.
inline std::filesystem::path datasets() {
  const char* set = std::getenv("STEREO_DATASETS");
  return set != nullptr ? std::filesystem::path(set)
                        : std::filesystem::path(STEREOD_SOURCE_DIR) / ".." / "shared" / "datasets";
}

}  // namespace stereod::calib
