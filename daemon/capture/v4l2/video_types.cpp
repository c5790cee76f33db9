// SPDX-License-Identifier: BSD-3-Clause
// Pixel format names.
#include "daemon/capture/v4l2/video_types.h"

namespace stereod::v4l2 {

std::string fourcc_name(std::uint32_t fourcc) {
  std::string name;
  for (int shift = 0; shift < 32; shift += 8) {
    const auto c = static_cast<unsigned char>(fourcc >> shift);
    name += c >= ' ' && c < 127 ? static_cast<char>(c) : '?';
  }
  while (!name.empty() && name.back() == ' ') name.pop_back();
  return name;
}

}  // namespace stereod::v4l2
