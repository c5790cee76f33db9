// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/subpixel_bias.h"

#include <algorithm>
#include <cmath>

#include "tests/support/wave_texture.h"

namespace stereod {

double SubpixelBias::largest_mean_error() const {
  double largest = 0;
  for (const double error : mean_error) largest = std::max(largest, std::fabs(error));
  return largest;
}

SubpixelBias sweep_plane(const SubpixelSweep& sweep, const SubpixelMatch& match) {
  constexpr int kSteps = SubpixelBias::kSteps;
  SubpixelBias bias;
  std::array<double, kSteps> answers{};
  double judged = 0;
  double all_answers = 0;
  double squares = 0;
  for (int texture = 0; texture < sweep.textures; ++texture) {
    const WaveTexture waves(static_cast<std::uint64_t>(texture + 1));
    for (int plane = 0; plane < sweep.pixels * kSteps; ++plane) {
      const double truth = sweep.min_disparity + static_cast<double>(plane) / kSteps;
      const auto step = static_cast<std::size_t>(plane % kSteps);
      const auto noise_seed = static_cast<std::uint64_t>(1000 * texture + plane);
      const DisparityImage found = match(plane_pair(waves, sweep.size, truth, sweep.noise, noise_seed));
      for (int y = sweep.margin; y < sweep.size.height - sweep.margin; ++y) {
        for (int x = sweep.margin; x < sweep.size.width - sweep.margin; ++x) {
          ++judged;
          const double error = found.at(x, y) / static_cast<double>(kSubpixelUnits) - truth;
          if (found.at(x, y) == kInvalidDisparity || std::fabs(error) >= 1) continue;
          bias.mean_error[step] += error;
          answers[step] += 1;
          bias.share[static_cast<std::size_t>(found.at(x, y) % kSubpixelUnits)] += 1;
          all_answers += 1;
          squares += error * error;
        }
      }
    }
  }
  for (std::size_t i = 0; i < kSteps; ++i) bias.mean_error[i] /= std::max(1.0, answers[i]);
  for (double& share : bias.share) share /= std::max(1.0, all_answers);
  bias.rms_error = std::sqrt(squares / std::max(1.0, all_answers));
  bias.answered = all_answers / judged;
  return bias;
}

}  // namespace stereod
