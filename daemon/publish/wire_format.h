// SPDX-License-Identifier: BSD-3-Clause
// How disparity rows are laid out in messages.
#pragma once

#include <optional>
#include <string>

#include "core/base/image.h"
#include "daemon/config/config.h"

namespace stereod {

/// Channel prefix, value encoding and message size of the disparity rows.
struct WireFormat {
  std::string prefix;          ///< of the channels
  std::string calibration_id;  ///< as in camera_info_t; empty: uncalibrated
  int rows_per_message = 1;
  int min_disparity = 0;  ///< [px]
  int disparities = 1;    ///< number searched
  int units_per_pixel = 1;
  bool with_depth = false;  ///< depth_rows_t with the same rows are sent as well
  double pacing_s = 0;      ///< time over which the rows of a frame are spread [s]; 0: sent at once

  /// Returns 1 if every value and the invalid one fit in a byte, else 2.
  int bytes_per_value() const;
  /// Returns the maximum bytes of one row in a message, the bits of its filled pixels included.
  int row_bytes(int width) const;
  int invalid_value() const { return bytes_per_value() == 1 ? 0xFF : 0xFFFF; }
};

/// Returns the format that @p config asks for. @p published is the size of the published image [px].
WireFormat wire_format(const Config& config, Size published, const std::string& calibration_id = {});

/// Returns the rows in a message where the configuration says auto: 16, or fewer if 16 rows of this width
/// [px] do not fit.
int default_rows_per_message(const WireFormat& format, int width);

/// Returns why rows of the @p published image do not fit in messages of this format: what was found, what is
/// allowed. Returns nothing if they fit.
std::optional<std::string> wire_problem(const WireFormat& format, Size published);

}  // namespace stereod
