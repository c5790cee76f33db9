// SPDX-License-Identifier: BSD-3-Clause
// The rectification tables of one camera.
#pragma once

#include <optional>

#include "core/geometry/calibration.h"
#include "core/rectify/rectify_map.h"
#include "daemon/publish/published_pixels.h"

namespace stereod {

/// Builds the rectification map and the validity masks of one camera when its first frame shows how pixels
/// lie in memory, and again if that changes. The tables may be read by several threads between calls of
/// prepare().
class CameraRectification {
 public:
  /// @p camera is null without a calibration: images are used as they are. @p matched are the columns of the
  /// rectified image that are matched.
  CameraRectification(const CameraCalibration* camera, Interpolation interpolation, ColumnRange matched);

  /// Builds the tables for frames of this layout, unless they are current.
  /// @throws std::invalid_argument if the layout does not fit the calibration.
  void prepare(const SourceLayout& layout);

  // Valid after prepare().
  const RectifyMap& map() const { return *map_; }
  /// Returns which pixels of the rectified image have a source.
  const ValidityMask& mask() const { return *mask_; }
  /// Returns the same for the matched columns only; its column 0 is the first of them.
  const ValidityMask& matched_mask() const { return matched_mask_ ? *matched_mask_ : *mask_; }

 private:
  const std::optional<CameraCalibration> camera_;
  const Interpolation interpolation_;
  const ColumnRange matched_;
  std::optional<RectifyMap> map_;
  std::optional<ValidityMask> mask_;
  std::optional<ValidityMask> matched_mask_;  // only if some columns are not matched
};

}  // namespace stereod
