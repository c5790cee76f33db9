// SPDX-License-Identifier: BSD-3-Clause
#include "core/rectify/rectify_map.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/cpu.h"
#include "core/base/text.h"
#include "core/rectify/remap_runs.h"

namespace stereod {

namespace {

constexpr std::int32_t kOutside = -1;
constexpr std::ptrdiff_t kColorBytes = 3;
// Columns that are blended together: their neighbors fit in a first-level cache.
constexpr int kBlended = 256;

void check(const SourceLayout& layout) {
  const Size size = layout.size;
  if (size.width < 1 || size.height < 1) {
    throw std::invalid_argument("an image of " + to_string(size) + " pixels cannot be rectified");
  }
  if (size.width > RunTable::kMaxWidth) {
    throw std::invalid_argument("an image of " + to_string(size) + " pixels cannot be rectified; at most " +
                                std::to_string(RunTable::kMaxWidth) + " columns are possible");
  }
  constexpr std::ptrdiff_t kMax = std::numeric_limits<std::int32_t>::max() - kColorBytes;
  if (layout.pixel_stride < 1 || layout.pixel_stride > kMax / size.width) {
    throw std::invalid_argument("pixels of a row " + std::to_string(layout.pixel_stride) +
                                " bytes apart are not possible in an image " + std::to_string(size.width) +
                                " pixels wide");
  }
  if (layout.row_stride < (size.width - 1) * layout.pixel_stride + 1) {
    throw std::invalid_argument("rows " + std::to_string(layout.row_stride) + " bytes apart do not hold " +
                                std::to_string(size.width) + " pixels " +
                                std::to_string(layout.pixel_stride) + " bytes apart");
  }
  if (layout.row_stride > kMax / size.height) {
    throw std::invalid_argument("an image of " + to_string(size) + " pixels with rows " +
                                std::to_string(layout.row_stride) +
                                " bytes apart is too large: offsets into it must fit 31 bits");
  }
}

Matrix3 inverse_of_projection(const RectifiedProjection& p) {
  return {{1 / p.fx, 0, -p.cx / p.fx, 0, 1 / p.fy, -p.cy / p.fy, 0, 0, 1}};
}

SourceLayout checked(const SourceLayout& layout) {
  check(layout);
  return layout;
}

// Returns where the segments end that rows are copied in. Whole runs may write past the end of a segment.
// kNearest: therefore the last pixels of a row are a segment of their own, which is copied to a buffer first.
std::vector<int> segment_ends(int width, Interpolation interpolation) {
  std::vector<int> ends;
  if (interpolation == Interpolation::kBilinear) {
    for (int end = kBlended; end < width; end += kBlended) ends.push_back(end);
  } else if (width > kRunPixels) {
    ends.push_back(width - kRunPixels);
  }
  ends.push_back(width);
  return ends;
}

std::ptrdiff_t source_bytes(const SourceLayout& layout) {
  const std::ptrdiff_t pixel = layout.pixel_stride < kColorBytes ? 1 : kColorBytes;
  const std::ptrdiff_t row = (layout.size.width - 1) * layout.pixel_stride + pixel;
  return (layout.size.height - 1) * layout.row_stride + std::min(row, layout.row_stride);
}

RunTable empty_table(const SourceLayout& layout, Interpolation interpolation) {
  const int width = layout.size.width;
  std::ptrdiff_t reach = 0;  // no whole runs of pixels that lie far apart
  if (layout.pixel_stride <= kColorBytes &&
      (width > kRunPixels || interpolation == Interpolation::kBilinear)) {
    reach = kRunPixels * layout.pixel_stride;
    if (interpolation == Interpolation::kBilinear) reach += layout.row_stride + layout.pixel_stride;
  }
  return {width, segment_ends(width, interpolation), layout.pixel_stride, reach, source_bytes(layout)};
}

}  // namespace

std::string_view name_of(Interpolation interpolation) {
  return interpolation == Interpolation::kNearest ? "nearest" : "bilinear";
}

std::optional<Interpolation> parse_interpolation(std::string_view name) {
  if (name == "nearest") return Interpolation::kNearest;
  if (name == "bilinear") return Interpolation::kBilinear;
  return std::nullopt;
}

RectifyMap::RectifyMap(const SourceLayout& layout, Interpolation interpolation)
    : layout_(checked(layout)),
      interpolation_(interpolation),
      runs_(empty_table(layout, interpolation)),
      blend_(blend_for(resolve_isa(Isa::kAuto))) {
  if (interpolation_ == Interpolation::kBilinear) {
    const auto pixels =
        static_cast<std::size_t>(layout.size.width) * static_cast<std::size_t>(layout.size.height);
    across_ = AlignedBuffer<std::uint8_t>(pixels);
    down_ = AlignedBuffer<std::uint8_t>(pixels);
  }
}

RectifyMap::RectifyMap(const CameraCalibration& calibration, const SourceLayout& layout,
                       Interpolation interpolation)
    : RectifyMap(layout, interpolation) {
  const CameraModel& camera = calibration.camera;
  if (camera.image != layout.size) {
    throw std::invalid_argument("the calibration is for " + to_string(camera.image) +
                                " images, the camera delivers " + to_string(layout.size));
  }
  // Turns a rectified pixel into a direction of the camera. The inverse of a rotation is its transpose.
  const Matrix3 to_camera = transposed(calibration.rotation) * inverse_of_projection(calibration.projection);
  fill([&](int x, int y) {
    const Vector3 direction = to_camera * Vector3{static_cast<double>(x), static_cast<double>(y), 1};
    constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
    if (!(direction.z > 0)) return Point2{kNowhere, kNowhere};
    return camera.to_pixel(camera.distort({direction.x / direction.z, direction.y / direction.z}));
  });
}

RectifyMap RectifyMap::identity(const SourceLayout& layout) {
  RectifyMap map(layout, Interpolation::kNearest);
  map.fill([](int x, int y) { return Point2{static_cast<double>(x), static_cast<double>(y)}; });
  return map;
}

template <typename SourceOf>
void RectifyMap::fill(SourceOf source_of) {
  const int width = layout_.size.width;
  std::vector<std::int32_t> offsets(static_cast<std::size_t>(width));
  for (int y = 0; y < layout_.size.height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Point2 source = source_of(x, y);
      std::int32_t& offset = offsets[static_cast<std::size_t>(x)];
      if (interpolation_ == Interpolation::kNearest) {
        offset = nearest(source);
      } else {
        const auto pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
        offset = upper_left(source, across_[pixel], down_[pixel]);
      }
    }
    runs_.append(offsets.data());
  }
}

std::int32_t RectifyMap::nearest(const Point2& source) const {
  const double x = std::nearbyint(source.x), y = std::nearbyint(source.y);
  const bool inside = x >= 0 && x < layout_.size.width && y >= 0 && y < layout_.size.height;  // false for NaN
  return inside ? offset_to(static_cast<std::ptrdiff_t>(x), static_cast<std::ptrdiff_t>(y)) : kOutside;
}

std::int32_t RectifyMap::upper_left(const Point2& source, std::uint8_t& across, std::uint8_t& down) const {
  const double x = std::nearbyint(source.x * kBlendSteps), y = std::nearbyint(source.y * kBlendSteps);
  const int last_x = layout_.size.width - 1, last_y = layout_.size.height - 1;
  if (!(x >= 0 && x <= last_x * kBlendSteps && y >= 0 && y <= last_y * kBlendSteps)) return kOutside;
  // In the last column or row the pixel itself is the right or lower one of the four.
  const int left = std::min(static_cast<int>(x) / kBlendSteps, std::max(last_x - 1, 0));
  const int top = std::min(static_cast<int>(y) / kBlendSteps, std::max(last_y - 1, 0));
  across = static_cast<std::uint8_t>(4 * (static_cast<int>(x) - left * kBlendSteps));
  down = static_cast<std::uint8_t>(static_cast<int>(y) - top * kBlendSteps);
  return offset_to(left, top);
}

std::int32_t RectifyMap::offset_to(std::ptrdiff_t x, std::ptrdiff_t y) const {
  return static_cast<std::int32_t>(y * layout_.row_stride + x * layout_.pixel_stride);
}

template <typename Copier>
void RectifyMap::nearest_row(const std::uint8_t* source, int y, std::uint8_t* out,
                             const Copier& copier) const noexcept {
  const int width = layout_.size.width;
  const RunTable::Row& row = runs_.row(y);
  RowCopier<Copier> copies(runs_, row, source, copier);
  if (row.kind == RunTable::Kind::kExactRuns || row.kind == RunTable::Kind::kOffsets) {
    copies.next(0, width, out);
    return;
  }
  constexpr std::size_t kLast = std::size_t{kRunPixels} * Copier::kBytes;
  std::uint8_t last[2 * kLast];
  const int first = width - kRunPixels;
  copies.next(0, first, out);
  copies.next(first, width, last);
  std::memcpy(out + static_cast<std::ptrdiff_t>(first) * Copier::kBytes, last, kLast);
}

template <typename Copier>
void RectifyMap::blended_row(const std::uint8_t* source, int y, std::uint8_t* out,
                             const Copier& copier) const noexcept {
  constexpr std::ptrdiff_t kPlane = kBlended + kRunPixels;
  std::uint8_t planes[4 * kPlane];
  const int width = layout_.size.width;
  RowCopier<BilinearTaps<Copier>> copies(runs_, runs_.row(y), source, {copier, right(), below(), kPlane});
  const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(y) * width;
  for (int first = 0; first < width; first += kBlended) {
    const int end = std::min(first + kBlended, width);
    copies.next(first, end, planes);
    blend_({planes, planes + kPlane, planes + 2 * kPlane, planes + 3 * kPlane, across_.data() + row + first,
            down_.data() + row + first},
           end - first, out + first);
  }
}

template <typename Copier>
void RectifyMap::row(const std::uint8_t* source, int y, std::uint8_t* out,
                     const Copier& copier) const noexcept {
  if (interpolation_ == Interpolation::kNearest) {
    nearest_row(source, y, out, copier);
  } else {
    blended_row(source, y, out, copier);
  }
}

void RectifyMap::gray_row(const std::uint8_t* source, int y, std::uint8_t* out) const noexcept {
  switch (layout_.pixel_stride) {
    case 1:
      return row(source, y, out, PixelCopier<1>{});
    case 2:
      return row(source, y, out, PixelCopier<2>{});
    default:
      return row(source, y, out, StridedCopier{layout_.pixel_stride});
  }
}

void RectifyMap::gray_rows(const std::uint8_t* source, RowRange rows,
                           ImageView<std::uint8_t> out) const noexcept {
  assert(out.size() == size() && rows.first >= 0 && rows.end <= out.height());
  for (int y = rows.first; y < rows.end; ++y) gray_row(source, y, out.row(y));
}

void RectifyMap::color_rows(const std::uint8_t* source, RowRange rows, ImageView<Rgb> out) const noexcept {
  assert(layout_.pixel_stride >= kColorBytes && interpolation_ == Interpolation::kNearest);
  assert(out.size() == size() && rows.first >= 0 && rows.end <= out.height());
  for (int y = rows.first; y < rows.end; ++y) {
    nearest_row(source, y, reinterpret_cast<std::uint8_t*>(out.row(y)), ColorCopier{layout_.pixel_stride});
  }
}

void rectify_gray(const RectifyMap& map, const std::uint8_t* source, ImageView<std::uint8_t> out,
                  WorkerPool& pool) {
  const int bands = pool.workers();
  pool.run(bands, [&](int band, int) { map.gray_rows(source, band_rows(out.height(), band, bands), out); });
}

void rectify_color(const RectifyMap& map, const std::uint8_t* source, ImageView<Rgb> out, WorkerPool& pool) {
  const int bands = pool.workers();
  pool.run(bands, [&](int band, int) { map.color_rows(source, band_rows(out.height(), band, bands), out); });
}

}  // namespace stereod
