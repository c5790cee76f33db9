// SPDX-License-Identifier: BSD-3-Clause
// Images of the disparities, side by side.
#include "tests/bench/quality_images.h"

#include <cmath>

#include "daemon/imagefile/write_image.h"
#include "daemon/visual/disparity_rendering.h"
#include "tests/bench/bench_images.h"

namespace stereod::bench {
namespace {

constexpr int kGap = 4;

ColorImage color_of(GrayView gray) {
  ColorImage color(gray.size());
  for (int y = 0; y < gray.height(); ++y) {
    for (int x = 0; x < gray.width(); ++x) {
      color.at(x, y) = {gray.at(x, y), gray.at(x, y), gray.at(x, y)};
    }
  }
  return color;
}

DisparityImage disparity_of(const Image<float>& truth) {
  DisparityImage disparity(truth.size());
  for (int y = 0; y < truth.height(); ++y) {
    for (int x = 0; x < truth.width(); ++x) {
      const float value = truth.at(x, y);
      disparity.at(x, y) = std::isfinite(value)
                               ? static_cast<std::int16_t>(std::lround(value * kSubpixelUnits))
                               : kInvalidDisparity;
    }
  }
  return disparity;
}

ColorImage side_by_side(const std::vector<ColorImage>& images) {
  int width = -kGap;
  for (const ColorImage& image : images) width += image.width() + kGap;
  ColorImage whole(width, images.front().height());
  int x = 0;
  for (const ColorImage& image : images) {
    const ImageView<Rgb> place(&whole.at(x, 0), image.width(), image.height(), whole.view().stride());
    copy_pixels(image.view(), place);
    x += image.width() + kGap;
  }
  return whole;
}

}  // namespace

void write_comparison(const std::filesystem::path& path, const StereoSet& set,
                      const std::vector<FoundDisparity>& found) {
  const DisparityImage truth = disparity_of(set.truth);
  DisparityRenderingOptions options;
  options.range = typical_range(truth.view(), kSubpixelUnits);
  options.scale_bar = false;
  std::vector<ColorImage> images;
  images.push_back(color_of(view_of(set.left)));
  images.push_back(draw_disparity(truth.view(), kSubpixelUnits, options));
  for (std::size_t i = 0; i < found.size(); ++i) {
    options.scale_bar = i + 1 == found.size();
    images.push_back(draw_disparity(found[i].image.view(), found[i].units_per_pixel, options));
  }
  const ColorImage whole = side_by_side(images);
  write_png(path, whole.view());
}

}  // namespace stereod::bench
