// SPDX-License-Identifier: BSD-3-Clause
// The format in which the page fetches snapshots.
#pragma once

#include <string>

#include "daemon/tools/view/live_view.h"

namespace stereod::tools {

/// Encodes a snapshot for the page:
///
/// | part | format |
/// |---|---|
/// | length of the JSON | 4 bytes, little-endian |
/// | JSON | all numbers and texts, and disparity_bytes, left_bytes: the sizes of the next two |
/// | disparities | of every @p step -th row and column [≥ 1], packed as in snapshot_codec.cpp, compressed by zlib |
/// | left image | JPEG |
std::string encode_snapshot(const Snapshot& snapshot, int step);

}  // namespace stereod::tools
