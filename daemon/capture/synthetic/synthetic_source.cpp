// SPDX-License-Identifier: BSD-3-Clause
// Rendering the loop, and lending its images.
#include "daemon/capture/synthetic/synthetic_source.h"

#include <algorithm>
#include <numeric>
#include <thread>
#include <utility>

#include "core/base/worker_pool.h"
#include "daemon/capture/synthetic/synthetic_scene.h"

namespace stereod {

SyntheticSource::SyntheticSource(std::shared_ptr<Loop> loop, int camera)
    : loop_(std::move(loop)), camera_(camera), images_(loop_->images[camera]) {}

FrameLease SyntheticSource::next(std::chrono::milliseconds timeout) noexcept {
  const std::optional<FrameTick> tick = loop_->clock.wait(camera_, timeout);
  if (!tick) return {};
  streaming_ = true;
  const auto index = loop_->order[static_cast<std::size_t>(tick->number) % loop_->order.size()];
  const ImageView<const std::uint8_t> image = images_[index].view();
  Frame frame;
  frame.luma = {image.row(0), image.size(), image.stride(), 1};
  frame.captured_ns = tick->captured_ns;
  frame.sequence = static_cast<std::uint32_t>(tick->number);
  return {frame, *this, static_cast<int>(index)};
}

void SyntheticSource::give_back(int) noexcept { loop_->clock.give_back(camera_); }

SourceState SyntheticSource::state() const noexcept {
  return streaming_ ? SourceState::kStreaming : SourceState::kWaiting;
}

namespace {

// Renders images 0 … count − 1 of both cameras by `render(camera, image)`.
template <typename Render>
void render_all(SyntheticSource::Loop& loop, int count, Render&& render) {
  for (std::vector<GrayImage>& images : loop.images) images.resize(static_cast<std::size_t>(count));
  WorkerPool pool(static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 4U)));
  pool.run(count, [&](int image, int) {
    for (const int camera : {0, 1}) {
      loop.images[camera][static_cast<std::size_t>(image)] = render(camera, image);
    }
  });
}

Calibration render_room(SyntheticSource::Loop& loop, const SyntheticOptions& options) {
  const SyntheticScene scene(options.size, options.frames);
  render_all(loop, options.frames, [&](int camera, int frame) {
    return camera == 0 ? scene.render_left(frame) : scene.render_right(frame);
  });
  loop.order.resize(static_cast<std::size_t>(options.frames));
  std::iota(loop.order.begin(), loop.order.end(), 0);
  return scene.calibration();
}

// Image 0 shows no board. Then two images for each place: on the way there, and at rest.
Calibration render_board(SyntheticSource::Loop& loop, const SyntheticOptions& options) {
  constexpr int kImages = 1 + 2 * kBoardPlaces;
  constexpr double kBaseline = 0.06;  // [m]
  const SyntheticScene scene(options.size, kImages, kBaseline, false);
  const double focal = scene.calibration().left.projection.fx;
  // Slightly less than the field of view: the cameras do not look in exactly the same direction.
  const double half_width = 0.4 * options.size.width / focal,
               half_height = 0.47 * options.size.height / focal;
  const std::vector<BoardPlace> places =
      varied_places(kPracticeBoard, half_width, half_height, kBaseline, kBoardPlaces);
  render_all(loop, kImages, [&](int camera, int image) {
    const auto render = [&](const SyntheticBoard* board) {
      return camera == 0 ? scene.render_left(image, board) : scene.render_right(image, board);
    };
    if (image == 0) return render(nullptr);
    const auto number = static_cast<std::size_t>(image - 1) / 2;
    BoardPlace place = places[number];
    if (image % 2 == 1) {
      const Vector3 &from = places[number > 0 ? number - 1 : places.size() - 1].origin_m,
                    &to = place.origin_m;
      place.origin_m = {(from.x + to.x) / 2, (from.y + to.y) / 2, (from.z + to.z) / 2};
    }
    const SyntheticBoard board(kPracticeBoard, place, focal);
    return render(&board);
  });
  const std::size_t passing = 2,
                    resting = options.fps > 0 ? static_cast<std::size_t>(2 * options.fps) + 1 : 4;
  for (std::size_t image = 0; image < kImages; ++image) {
    loop.order.insert(loop.order.end(), image % 2 == 1 ? passing : resting, image);
  }
  return scene.calibration();
}

}  // namespace

SyntheticPair make_synthetic_pair(const SyntheticOptions& options) {
  const auto loop = std::shared_ptr<SyntheticSource::Loop>(new SyntheticSource::Loop{
      {}, {}, FrameClock(options.fps, {std::chrono::nanoseconds(0), options.skew})});
  Calibration calibration = options.board ? render_board(*loop, options) : render_room(*loop, options);
  return {std::make_unique<SyntheticSource>(loop, 0), std::make_unique<SyntheticSource>(loop, 1),
          std::move(calibration)};
}

}  // namespace stereod
