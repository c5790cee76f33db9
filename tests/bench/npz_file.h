// SPDX-License-Identifier: BSD-3-Clause
// Reads one image of floats from a NumPy file of arrays.
#pragma once

#include <filesystem>

#include "core/base/image.h"

namespace stereod::bench {

/// Returns the first array of an .npz: two dimensions, little-endian 32-bit floats, row by row, stored
/// deflated (a ZIP archive, APPNOTE.TXT 4.3.7, of NumPy's format .npy, NEP 1). Throws FileError for anything
/// else.
Image<float> read_npz_floats(const std::filesystem::path& path);

}  // namespace stereod::bench
