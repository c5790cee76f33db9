// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/random_images.h"

#include <algorithm>
#include <cstdlib>

namespace stereod {
namespace {

/// Returns the image of the pixels @p pixel_of(x, y).
template <typename PixelOf>
GrayImage make_image(Size size, PixelOf&& pixel_of) {
  GrayImage image(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) image.at(x, y) = static_cast<std::uint8_t>(pixel_of(x, y));
  }
  return image;
}

GrayImage noise(Size size, Random& random) {
  return make_image(size, [&](int, int) { return random.between(0, 255); });
}

/// Returns the mean over the (2·radius + 1)² square around each pixel, clipped at the border.
GrayImage blurred(const GrayImage& image, int radius) {
  return make_image(image.size(), [&](int x, int y) {
    int sum = 0;
    int count = 0;
    for (int v = std::max(0, y - radius); v <= std::min(image.height() - 1, y + radius); ++v) {
      for (int u = std::max(0, x - radius); u <= std::min(image.width() - 1, x + radius); ++u) {
        sum += image.at(u, v);
        ++count;
      }
    }
    return sum / count;
  });
}

StereoPair slanted_pair(Size size, Random& random) {
  constexpr int kUnits = 64;  // disparities in 1/64 px
  const int start = random.between(0, std::max(1, size.width / 3) * kUnits);
  const int slope_x = random.between(-8, 8);
  const int slope_y = random.between(-8, 8);
  GrayImage right = blurred(noise(size, random), random.between(0, 1));
  GrayImage left = make_image(size, [&](int x, int y) {
    const int source = x * kUnits - std::max(0, start + slope_x * x + slope_y * y);
    const int column = source >= 0 ? source / kUnits : -1;
    if (column < 0 || column + 1 >= size.width) return random.between(0, 255);
    const int fraction = source % kUnits;
    const int gray =
        ((kUnits - fraction) * right.at(column, y) + fraction * right.at(column + 1, y)) / kUnits;
    return std::clamp(gray + random.between(-2, 2), 0, 255);
  });
  return {std::move(left), std::move(right)};
}

StereoPair two_levels(Size size, Random& random) {
  const int low = random.between(0, 254);
  const int high = std::min(255, low + random.between(1, 12));
  const int rarity = random.between(2, 9);
  const auto one = [&] {
    return make_image(size, [&](int, int) { return random.one_in(rarity) ? high : low; });
  };
  GrayImage left = one();
  return {std::move(left), one()};
}

StereoPair extremes(Size size, Random& random) {
  const auto flat = [&](int gray) { return make_image(size, [&](int, int) { return gray; }); };
  // Bars two columns wide have the maximum gradient in every column, and half a period apart the maximum
  // cost.
  const auto bars = [&](int phase) {
    return make_image(size, [&](int x, int) { return (x + phase) / 2 % 2 * 255; });
  };
  const auto binary_noise = [&] {
    return make_image(size, [&](int, int) { return random.between(0, 1) * 255; });
  };
  // A ramp has the same gradient everywhere; against a descending one every disparity has almost the maximum
  // cost.
  const auto ramp = [&](int first, int slope, int rarity) {
    return make_image(size, [&, first, slope, rarity](int x, int) {
      return random.one_in(rarity) ? random.between(0, 255) : std::clamp(first + slope * x, 0, 255);
    });
  };
  switch (random.between(0, 5)) {
    case 0:
      return {flat(255), flat(0)};
    case 1:
      return {flat(0), flat(255)};
    case 2:
      return {bars(0), bars(2)};
    case 3: {  // almost the maximum cost everywhere: the minimum is a large sum too
      const int rarity = random.between(10, 200);
      return {flat(255), make_image(size, [&](int, int) { return random.one_in(rarity) ? 255 : 0; })};
    }
    case 4: {
      const int slope = random.between(1, 8);
      const int rarity = random.between(20, 400);
      GrayImage left = ramp(0, slope, rarity);
      return {std::move(left), ramp(255, -slope, rarity)};
    }
    default: {
      GrayImage left = binary_noise();
      return {std::move(left), binary_noise()};
    }
  }
}

}  // namespace

std::uint64_t Random::next() {
  std::uint64_t z = state_ += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

int Random::between(int minimum, int maximum) {
  const auto choices = static_cast<std::uint64_t>(maximum - minimum) + 1;
  return minimum + static_cast<int>(next() % choices);
}

std::string_view name_of(Content content) {
  switch (content) {
    case Content::kNoise:
      return "noise";
    case Content::kSmoothNoise:
      return "smooth noise";
    case Content::kSlantedPair:
      return "slanted pair";
    case Content::kConstant:
      return "constant";
    case Content::kTwoLevels:
      return "two levels";
    case Content::kExtremes:
      return "extremes";
  }
  return "?";
}

StereoPair random_pair(Content content, Size size, std::uint64_t seed) {
  Random random(seed);
  switch (content) {
    case Content::kNoise: {
      GrayImage left = noise(size, random);
      return {std::move(left), noise(size, random)};
    }
    case Content::kSmoothNoise: {
      const int radius = random.between(1, 3);
      GrayImage left = blurred(noise(size, random), radius);
      return {std::move(left), blurred(noise(size, random), radius)};
    }
    case Content::kSlantedPair:
      return slanted_pair(size, random);
    case Content::kConstant: {
      const int left = random.between(0, 255);
      const int right = random.between(0, 255);
      return {make_image(size, [&](int, int) { return left; }),
              make_image(size, [&](int, int) { return right; })};
    }
    case Content::kTwoLevels:
      return two_levels(size, random);
    case Content::kExtremes:
      return extremes(size, random);
  }
  std::abort();
}

}  // namespace stereod
