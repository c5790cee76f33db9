#include "core/rectify_map.h"

#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

namespace stereod {

namespace {

constexpr std::int32_t kOutside = -1;
constexpr std::ptrdiff_t kColorBytes = 3;

std::string text(Size size) { return std::to_string(size.width) + "×" + std::to_string(size.height); }

void check(const SourceLayout& layout) {
  const Size size = layout.size;
  if (size.width < 1 || size.height < 1) {
    throw std::invalid_argument("an image of " + text(size) + " pixels cannot be rectified");
  }
  constexpr std::ptrdiff_t kLargest = std::numeric_limits<std::int32_t>::max() - kColorBytes;
  if (layout.pixel_stride < 1 || layout.pixel_stride > kLargest / size.width) {
    throw std::invalid_argument("pixels of a row " + std::to_string(layout.pixel_stride) +
                                " bytes apart are not possible in an image " + std::to_string(size.width) +
                                " pixels wide");
  }
  if (layout.row_stride < (size.width - 1) * layout.pixel_stride + 1) {
    throw std::invalid_argument("rows " + std::to_string(layout.row_stride) + " bytes apart do not hold " +
                                std::to_string(size.width) + " pixels " +
                                std::to_string(layout.pixel_stride) + " bytes apart");
  }
  if (layout.row_stride > kLargest / size.height) {
    throw std::invalid_argument("an image of " + text(size) + " pixels with rows " +
                                std::to_string(layout.row_stride) +
                                " bytes apart is too large: offsets into it must fit 31 bits");
  }
}

Matrix3 inverse_of_projection(const RectifiedProjection& p) {
  return {{1 / p.fx, 0, -p.cx / p.fx, 0, 1 / p.fy, -p.cy / p.fy, 0, 0, 1}};
}

std::uint8_t checked(const std::uint8_t* source, std::int32_t offset) {
  return offset < 0 ? std::uint8_t{0} : source[offset];
}

}  // namespace

RectifyMap::RectifyMap(const SourceLayout& layout) : layout_(layout) {
  check(layout);
  offsets_ = AlignedBuffer<std::int32_t>(static_cast<std::size_t>(layout.size.width) *
                                         static_cast<std::size_t>(layout.size.height));
  rows_.resize(static_cast<std::size_t>(layout.size.height));
}

RectifyMap::RectifyMap(const CameraCalibration& calibration, const SourceLayout& layout)
    : RectifyMap(layout) {
  const CameraModel& camera = calibration.camera;
  if (camera.image != layout.size) {
    throw std::invalid_argument("the calibration is for " + text(camera.image) +
                                " images, the camera delivers " + text(layout.size));
  }
  // From a rectified pixel to a direction of the camera. A rotation's inverse is its transpose.
  const Matrix3 to_camera = transposed(calibration.rotation) * inverse_of_projection(calibration.projection);
  std::int32_t* offset = offsets_.data();
  for (int y = 0; y < layout.size.height; ++y) {
    for (int x = 0; x < layout.size.width; ++x, ++offset) {
      const Vector3 direction = to_camera * Vector3{static_cast<double>(x), static_cast<double>(y), 1};
      if (!(direction.z > 0)) {
        *offset = kOutside;
        continue;
      }
      const Point2 at =
          camera.to_pixel(camera.distort({direction.x / direction.z, direction.y / direction.z}));
      *offset = offset_of(at.x, at.y);
    }
  }
  describe_rows();
}

RectifyMap RectifyMap::identity(const SourceLayout& layout) {
  RectifyMap map(layout);
  std::int32_t* offset = map.offsets_.data();
  for (int y = 0; y < layout.size.height; ++y) {
    for (int x = 0; x < layout.size.width; ++x) *offset++ = map.offset_of(x, y);
  }
  map.describe_rows();
  return map;
}

std::int32_t RectifyMap::offset_of(double source_x, double source_y) const {
  const double x = std::nearbyint(source_x), y = std::nearbyint(source_y);
  const bool inside =
      x >= 0 && x < layout_.size.width && y >= 0 && y < layout_.size.height;  // false for a NaN
  if (!inside) return kOutside;
  return static_cast<std::int32_t>(static_cast<std::ptrdiff_t>(y) * layout_.row_stride +
                                   static_cast<std::ptrdiff_t>(x) * layout_.pixel_stride);
}

void RectifyMap::describe_rows() {
  const int width = layout_.size.width;
  const std::int32_t last_pixel = offset_of(width - 1, layout_.size.height - 1);
  for (int y = 0; y < layout_.size.height; ++y) {
    const std::int32_t* offsets = row_of_table(y);
    Row& row = rows_[static_cast<std::size_t>(y)];
    int run_first = 0;
    for (int x = 0; x < width; ++x) {
      if (offsets[x] < 0) run_first = x + 1;
      if (x + 1 - run_first > row.inside_end - row.inside_first) {
        row.inside_first = run_first;
        row.inside_end = x + 1;
      }
      if (offsets[x] == last_pixel) row.has_last_pixel = true;
    }
  }
}

void RectifyMap::grey_row(const std::uint8_t* source, int y, std::uint8_t* out) const noexcept {
  const std::int32_t* offsets = row_of_table(y);
  const Row row = rows_[static_cast<std::size_t>(y)];
  int x = 0;
  for (; x < row.inside_first; ++x) out[x] = checked(source, offsets[x]);
  for (; x + 8 <= row.inside_end; x += 8) {
    // All are read before one is written: `out` may, as far as the compiler knows, lie over the table.
    const std::uint8_t p0 = source[offsets[x]], p1 = source[offsets[x + 1]];
    const std::uint8_t p2 = source[offsets[x + 2]], p3 = source[offsets[x + 3]];
    const std::uint8_t p4 = source[offsets[x + 4]], p5 = source[offsets[x + 5]];
    const std::uint8_t p6 = source[offsets[x + 6]], p7 = source[offsets[x + 7]];
    out[x] = p0, out[x + 1] = p1, out[x + 2] = p2, out[x + 3] = p3;
    out[x + 4] = p4, out[x + 5] = p5, out[x + 6] = p6, out[x + 7] = p7;
  }
  for (; x < layout_.size.width; ++x) out[x] = checked(source, offsets[x]);
}

void RectifyMap::grey_rows(const std::uint8_t* source, RowRange rows,
                           ImageView<std::uint8_t> out) const noexcept {
  assert(out.size() == size() && rows.first >= 0 && rows.end <= out.height());
  for (int y = rows.first; y < rows.end; ++y) grey_row(source, y, out.row(y));
}

void RectifyMap::color_rows(const std::uint8_t* source, RowRange rows, ImageView<Rgb> out) const noexcept {
  assert(layout_.pixel_stride >= kColorBytes);
  assert(out.size() == size() && rows.first >= 0 && rows.end <= out.height());
  const int last = layout_.size.width - 1;
  const auto move_bytes = [&](std::int32_t offset, std::uint8_t* to) {
    if (offset < 0) {
      std::memset(to, 0, kColorBytes);
    } else {
      std::memcpy(to, source + offset, kColorBytes);
    }
  };
  for (int y = rows.first; y < rows.end; ++y) {
    const std::int32_t* offsets = row_of_table(y);
    const Row row = rows_[static_cast<std::size_t>(y)];
    auto* to = reinterpret_cast<std::uint8_t*>(out.row(y));
    int x = 0;
    for (; x < row.inside_first; ++x, to += kColorBytes) move_bytes(offsets[x], to);
    if (!row.has_last_pixel) {
      const int end = row.inside_end < last ? row.inside_end : last;
      for (; x < end; ++x, to += kColorBytes) std::memcpy(to, source + offsets[x], 4);
    }
    for (; x <= last; ++x, to += kColorBytes) move_bytes(offsets[x], to);
  }
}

void rectify_grey(const RectifyMap& map, const std::uint8_t* source, ImageView<std::uint8_t> out,
                  WorkerPool& pool) {
  const int bands = pool.workers();
  pool.run(bands, [&](int band, int) { map.grey_rows(source, band_rows(out.height(), band, bands), out); });
}

void rectify_color(const RectifyMap& map, const std::uint8_t* source, ImageView<Rgb> out, WorkerPool& pool) {
  const int bands = pool.workers();
  pool.run(bands, [&](int band, int) { map.color_rows(source, band_rows(out.height(), band, bands), out); });
}

}  // namespace stereod
