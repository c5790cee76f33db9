// SPDX-License-Identifier: BSD-3-Clause
#include "core/rectify/rectify_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace stereod {
namespace {

// Memory of exactly `size` bytes, so that a sanitizer detects every access beyond it.
std::unique_ptr<std::uint8_t[]> exact(std::size_t size, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::unique_ptr<std::uint8_t[]> bytes(new std::uint8_t[size]);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(random() | 1U);  // never 0
  return bytes;
}

std::size_t bytes_of(const SourceLayout& layout, std::ptrdiff_t pixel) {
  return static_cast<std::size_t>((layout.size.height - 1) * layout.row_stride +
                                  (layout.size.width - 1) * layout.pixel_stride + pixel);
}

// Turned so that some pixels at every border lie outside the source.
CameraCalibration tilted(Size size) {
  CameraCalibration c;
  const double f = 0.9 * size.width;
  c.camera = {size, f, f, (size.width - 1) / 2.0, (size.height - 1) / 2.0};
  c.camera.k1 = -0.2, c.camera.p1 = 0.002;
  c.rotation = rotation_about({0.03, -0.05, 0.12});
  c.projection = {f, f, (size.width - 1) / 2.0, (size.height - 1) / 2.0};
  return c;
}

// Turned so far that neighbors rarely form runs.
CameraCalibration slanted(Size size) {
  CameraCalibration c = tilted(size);
  c.rotation = rotation_about({0, 0, 0.8});
  return c;
}

const std::vector<Size> sizes = {{1, 1},  {2, 1},  {1, 2},  {3, 5},   {7, 3},   {8, 8},
                                 {9, 17}, {16, 2}, {17, 5}, {31, 33}, {67, 41}, {300, 20}};

// The reference: the byte at the offset, or 0.
std::uint8_t expected(const RectifyMap& map, const std::uint8_t* source, int x, int y, int channel = 0) {
  const std::int32_t offset = map.offset(x, y);
  return offset < 0 ? std::uint8_t{0} : source[offset + channel];
}

TEST(RectifyMap, Identity_OffsetsFollowLayout) {
  const RectifyMap map = RectifyMap::identity({{5, 3}, 40, 2});
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 5; ++x) EXPECT_EQ(map.offset(x, y), 40 * y + 2 * x);
  }
}

TEST(RectifyMap, ShiftedProjection_ShiftsPixels) {
  CameraCalibration c;
  c.camera = {{10, 6}, 20, 20, 4, 3};
  c.projection = {20, 20, 2, 4};  // rectified (x, y) shows source (x + 2, y - 1)
  const RectifyMap map(c, {{10, 6}, 16, 1});
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 10; ++x) {
      EXPECT_EQ(map.offset(x, y), x + 2 < 10 && y >= 1 ? 16 * (y - 1) + x + 2 : -1) << x << ' ' << y;
    }
  }
}

TEST(RectifyMap, Mask_MarksPixelsWithSource) {
  const RectifyMap map(tilted({67, 41}), {{67, 41}, 80, 1});
  const ValidityMask mask = map.mask();
  int without = 0;
  for (int y = 0; y < 41; ++y) {
    bool whole = true;
    for (int x = 0; x < 67; ++x) {
      EXPECT_EQ(mask.row(y)[x], map.offset(x, y) >= 0 ? 1 : 0);
      whole = whole && map.offset(x, y) >= 0;
      without += map.offset(x, y) < 0 ? 1 : 0;
    }
    EXPECT_EQ(mask.row_is_whole(y), whole);
  }
  EXPECT_GT(without, 0);
}

TEST(RectifyMap, Nearest_TakesNearestPixel) {
  CameraCalibration c;
  c.camera = {{10, 1}, 20, 20, 4.4, 0};
  c.projection = {20, 20, 4, 0};
  EXPECT_EQ(RectifyMap(c, {{10, 1}, 10, 1}).offset(3, 0), 3);
  c.camera.cx = 4.6;
  EXPECT_EQ(RectifyMap(c, {{10, 1}, 10, 1}).offset(3, 0), 4);
}

TEST(RectifyMap, BehindCamera_HasNoSource) {
  CameraCalibration c = tilted({9, 9});
  c.rotation = rotation_about({0, 3.14159265358979, 0});  // looks backward
  const RectifyMap map(c, {{9, 9}, 9, 1});
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 9; ++x) EXPECT_EQ(map.offset(x, y), -1);
  }
}

TEST(RectifyMap, Gray_CopiesEverySizeAndLayout) {
  for (const Size size : sizes) {
    for (const std::ptrdiff_t pixel_stride : {1, 2, 3, 4}) {
      const SourceLayout layout{size, size.width * pixel_stride + 3, pixel_stride};
      const RectifyMap maps[] = {RectifyMap(tilted(size), layout), RectifyMap(slanted(size), layout),
                                 RectifyMap::identity(layout)};
      for (const RectifyMap& map : maps) {
        const auto source = exact(bytes_of(layout, 1));
        const auto width = static_cast<std::size_t>(size.width);
        const std::unique_ptr<std::uint8_t[]> out(new std::uint8_t[width]);
        for (int y = 0; y < size.height; ++y) {
          map.gray_row(source.get(), y, out.get());
          for (int x = 0; x < size.width; ++x) {
            ASSERT_EQ(out[static_cast<std::size_t>(x)], expected(map, source.get(), x, y))
                << size.width << 'x' << size.height << " stride " << pixel_stride << " at " << x << ' ' << y;
          }
        }
      }
    }
  }
}

// Both buffers end with the last pixel, so copying a pixel as four bytes would exceed them.
TEST(RectifyMap, Color_WritesNothingPastEnd) {
  for (const Size size : sizes) {
    for (const std::ptrdiff_t pixel_stride : {3, 4}) {
      const SourceLayout layout{size, size.width * pixel_stride, pixel_stride};
      CameraCalibration turned = tilted(size);  // by half a turn: the last pixel becomes the first
      turned.rotation = rotation_about({0, 0, 3.14159265358979});
      const RectifyMap maps[] = {RectifyMap(tilted(size), layout), RectifyMap(slanted(size), layout),
                                 RectifyMap::identity(layout), RectifyMap(turned, layout)};
      for (const RectifyMap& map : maps) {
        const auto source = exact(bytes_of(layout, 3));
        const std::size_t pixels =
            static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
        const std::unique_ptr<Rgb[]> memory(new Rgb[pixels]);
        const ImageView<Rgb> out(memory.get(), size.width, size.height, std::ptrdiff_t{size.width} * 3);
        map.color_rows(source.get(), {0, size.height}, out);
        for (int y = 0; y < size.height; ++y) {
          for (int x = 0; x < size.width; ++x) {
            const Rgb want{expected(map, source.get(), x, y, 0), expected(map, source.get(), x, y, 1),
                           expected(map, source.get(), x, y, 2)};
            ASSERT_EQ(out.at(x, y), want) << size.width << 'x' << size.height << " at " << x << ' ' << y;
          }
        }
      }
    }
  }
}

// The reference of bilinear interpolation in steps of 1/32 px, from the source coordinates; nullopt outside.
std::optional<int> blended(const CameraCalibration& camera, const SourceLayout& layout,
                           const std::uint8_t* source, int x, int y) {
  const auto at = source_point(camera, {static_cast<double>(x), static_cast<double>(y)});
  if (!at) return std::nullopt;
  const double across = std::nearbyint(32 * at->x), down = std::nearbyint(32 * at->y);
  if (across < 0 || down < 0 || across > 32 * (layout.size.width - 1) ||
      down > 32 * (layout.size.height - 1)) {
    return std::nullopt;
  }
  const int u = static_cast<int>(across), v = static_cast<int>(down);
  int sum = 0;
  for (const int dy : {0, 1}) {
    for (const int dx : {0, 1}) {
      const int weight = (dx == 1 ? u % 32 : 32 - u % 32) * (dy == 1 ? v % 32 : 32 - v % 32);
      if (weight > 0) {
        sum += weight * source[(v / 32 + dy) * layout.row_stride + (u / 32 + dx) * layout.pixel_stride];
      }
    }
  }
  return (sum + 512) / 1024;
}

TEST(RectifyMap, Bilinear_IsWeightedMeanOfFour) {
  for (const Size size : sizes) {
    for (const std::ptrdiff_t pixel_stride : {1, 2, 4}) {
      const SourceLayout layout{size, size.width * pixel_stride + 3, pixel_stride};
      for (const CameraCalibration& camera : {tilted(size), slanted(size)}) {
        const RectifyMap map(camera, layout, Interpolation::kBilinear);
        const ValidityMask mask = map.mask();
        const auto source = exact(bytes_of(layout, 1));
        const auto width = static_cast<std::size_t>(size.width);
        const std::unique_ptr<std::uint8_t[]> out(new std::uint8_t[width]);
        for (int y = 0; y < size.height; ++y) {
          map.gray_row(source.get(), y, out.get());
          for (int x = 0; x < size.width; ++x) {
            const std::optional<int> want = blended(camera, layout, source.get(), x, y);
            ASSERT_EQ(mask.row(y)[x] != 0, want.has_value());
            ASSERT_EQ(int{out[static_cast<std::size_t>(x)]}, want.value_or(0))
                << size.width << 'x' << size.height << " stride " << pixel_stride << " at " << x << ' ' << y;
          }
        }
      }
    }
  }
}

TEST(RectifyMap, Table_IsSmall) {
  const Size size{640, 480};
  for (const CameraCalibration& camera : {tilted(size), slanted(size)}) {
    for (const std::ptrdiff_t pixel_stride : {1, 3}) {
      const SourceLayout layout{size, size.width * pixel_stride, pixel_stride};
      EXPECT_LE(RectifyMap(camera, layout).bytes(), 1'300'000U);
    }
  }
  EXPECT_LE(RectifyMap(tilted(size), {size, 640, 1}, Interpolation::kBilinear).bytes(), 1'300'000U);
}

TEST(RectifyMap, RowsOutsideRange_StayUntouched) {
  const Size size{31, 9};
  const RectifyMap gray(tilted(size), {size, 31, 1});
  const RectifyMap color(tilted(size), {size, 93, 3});
  const auto source = exact(std::size_t{31} * 9 * 3);
  GrayImage gray_out(size);
  ColorImage color_out(size);
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 31; ++x) gray_out.at(x, y) = 77, color_out.at(x, y) = {7, 8, 9};
  }
  gray.gray_rows(source.get(), {3, 6}, gray_out.view());
  color.color_rows(source.get(), {3, 6}, color_out.view());
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 31; ++x) {
      const bool inside = y >= 3 && y < 6;
      EXPECT_EQ(gray_out.at(x, y), inside ? expected(gray, source.get(), x, y) : 77);
      EXPECT_EQ(color_out.at(x, y) == (Rgb{7, 8, 9}), !inside);
    }
  }
}

TEST(RectifyMap, Result_IndependentOfWorkers) {
  for (const Size size : sizes) {
    const RectifyMap gray(tilted(size), {size, size.width, 1});
    const RectifyMap color(tilted(size), {size, std::ptrdiff_t{size.width} * 3, 3});
    const auto source = exact(bytes_of(color.layout(), 3));
    GrayImage gray_want(size);
    ColorImage color_want(size);
    gray.gray_rows(source.get(), {0, size.height}, gray_want.view());
    color.color_rows(source.get(), {0, size.height}, color_want.view());
    for (int workers = 1; workers <= 4; ++workers) {
      WorkerPool pool(workers);
      GrayImage gray_out(size);
      ColorImage color_out(size);
      rectify_gray(gray, source.get(), gray_out.view(), pool);
      rectify_color(color, source.get(), color_out.view(), pool);
      for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
          ASSERT_EQ(gray_out.at(x, y), gray_want.at(x, y));
          ASSERT_EQ(color_out.at(x, y), color_want.at(x, y));
        }
      }
    }
  }
}

std::string complaint_about(const SourceLayout& layout, Size calibrated = {640, 480}) {
  try {
    const RectifyMap map(tilted(calibrated), layout);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "none";
}

TEST(RectifyMap, ImpossibleLayout_Throws) {
  EXPECT_EQ(complaint_about({{640, 480}, 640, 1}), "none");
  EXPECT_EQ(complaint_about({{1280, 720}, 1280, 1}),
            "the calibration is for 640×480 images, the camera delivers 1280×720");
  EXPECT_EQ(complaint_about({{0, 480}, 640, 1}), "an image of 0×480 pixels cannot be rectified");
  EXPECT_EQ(complaint_about({{70'000, 4}, 70'000, 1}),
            "an image of 70000×4 pixels cannot be rectified; at most 65535 columns are possible");
  EXPECT_EQ(complaint_about({{640, 480}, 640, 2}),
            "rows 640 bytes apart do not hold 640 pixels 2 bytes apart");
  EXPECT_EQ(complaint_about({{640, 480}, -640, 1}),
            "rows -640 bytes apart do not hold 640 pixels 1 bytes apart");
  EXPECT_EQ(complaint_about({{640, 480}, 640, 0}),
            "pixels of a row 0 bytes apart are not possible in an image 640 pixels wide");
  EXPECT_EQ(complaint_about({{640, 480}, std::ptrdiff_t{1} << 30, 1}),
            "an image of 640×480 pixels with rows 1073741824 bytes apart is too large: offsets into it "
            "must fit 31 "
            "bits");
  EXPECT_THROW(RectifyMap::identity({{-1, 4}, 8, 1}), std::invalid_argument);
}

}  // namespace
}  // namespace stereod
