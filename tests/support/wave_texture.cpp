// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/wave_texture.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace stereod {
namespace {

constexpr int kWaves = 100;
constexpr double kMinWavelength = 3.3;  // px
constexpr double kMaxWavelength = 50;
constexpr double kContrast = 40;  // [gray levels] standard deviation
constexpr double kTwoPi = 2 * std::numbers::pi;

/// Returns a number in [0, 1).
double fraction(Random& random) { return static_cast<double>(random.next() >> 11U) * 0x1p-53; }

double normal(Random& random) {
  // Box and Muller. 1 − u, because 0 has no logarithm.
  return std::sqrt(-2 * std::log(1 - fraction(random))) * std::cos(kTwoPi * fraction(random));
}

}  // namespace

WaveTexture::WaveTexture(std::uint64_t seed) {
  Random random(seed);
  double power = 0;
  for (int i = 0; i < kWaves; ++i) {
    const double wavelength = kMinWavelength * std::pow(kMaxWavelength / kMinWavelength, fraction(random));
    const double direction = kTwoPi * fraction(random);
    Wave wave{};
    wave.cycles_x = std::cos(direction) / wavelength;
    wave.cycles_y = std::sin(direction) / wavelength;
    wave.phase = kTwoPi * fraction(random);
    const double half_turn = std::numbers::pi * wave.cycles_x;  // over the width of a pixel
    const double averaged = half_turn == 0 ? 1 : std::sin(half_turn) / half_turn;
    wave.amplitude = std::sqrt(wavelength) * averaged;
    power += wave.amplitude * wave.amplitude / 2;
    waves_.push_back(wave);
  }
  for (Wave& wave : waves_) wave.amplitude *= kContrast / std::sqrt(power);
}

GrayImage WaveTexture::image(Size size, double shift, double noise, std::uint64_t noise_seed) const {
  Random random(noise_seed);
  GrayImage image(size);
  std::vector<double> row(static_cast<std::size_t>(size.width));
  for (int y = 0; y < size.height; ++y) {
    std::fill(row.begin(), row.end(), 128.0);
    for (const Wave& wave : waves_) {
      const double start = wave.phase + kTwoPi * (wave.cycles_y * y - wave.cycles_x * shift);
      std::complex<double> value = std::polar(wave.amplitude, start);
      const std::complex<double> step = std::polar(1.0, kTwoPi * wave.cycles_x);
      for (double& sum : row) {
        sum += value.real();
        value *= step;
      }
    }
    for (int x = 0; x < size.width; ++x) {
      const double gray = row[static_cast<std::size_t>(x)] + (noise > 0 ? noise * normal(random) : 0);
      image.at(x, y) = static_cast<std::uint8_t>(std::clamp(std::lround(gray), 0L, 255L));
    }
  }
  return image;
}

StereoPair plane_pair(const WaveTexture& texture, Size size, double disparity, double noise,
                      std::uint64_t noise_seed) {
  return {texture.image(size, disparity, noise, 2 * noise_seed),
          texture.image(size, 0, noise, 2 * noise_seed + 1)};
}

}  // namespace stereod
