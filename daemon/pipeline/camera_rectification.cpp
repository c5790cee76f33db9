// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pipeline/camera_rectification.h"

namespace stereod {

CameraRectification::CameraRectification(const CameraCalibration* camera, Interpolation interpolation,
                                         ColumnRange matched)
    : camera_(camera != nullptr ? std::optional(*camera) : std::nullopt),
      interpolation_(interpolation),
      matched_(matched) {}

void CameraRectification::prepare(const SourceLayout& layout) {
  if (map_ && map_->layout() == layout) return;
  map_.emplace(camera_ ? RectifyMap(*camera_, layout, interpolation_) : RectifyMap::identity(layout));
  mask_.emplace(map_->mask());
  if (matched_.count() == layout.size.width) return;
  matched_mask_.emplace(Size{matched_.count(), layout.size.height},
                        [this](int x, int y) { return map_->offset(matched_.first + x, y) >= 0; });
}

}  // namespace stereod
