#include "daemon/capture/synthetic_source.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "core/worker_pool.h"
#include "daemon/capture/synthetic_scene.h"

namespace stereod {

SyntheticSource::SyntheticSource(std::shared_ptr<Loop> loop, int camera)
    : loop_(std::move(loop)), camera_(camera), pictures_(loop_->pictures[camera]) {}

FrameLease SyntheticSource::next(std::chrono::milliseconds timeout) noexcept {
  const std::optional<FrameTick> tick = loop_->clock.wait(camera_, timeout);
  if (!tick) return {};
  streaming_ = true;
  const auto index = static_cast<std::size_t>(tick->number) % pictures_.size();
  const ImageView<const std::uint8_t> picture = pictures_[index].view();
  Frame frame;
  frame.luma = {picture.row(0), picture.size(), picture.stride(), 1};
  frame.captured_ns = tick->captured_ns;
  frame.sequence = static_cast<std::uint32_t>(tick->number);
  return {frame, *this, static_cast<int>(index)};
}

void SyntheticSource::give_back(int) noexcept { loop_->clock.give_back(camera_); }

SourceState SyntheticSource::state() const noexcept {
  return streaming_ ? SourceState::kStreaming : SourceState::kWaiting;
}

SyntheticPair make_synthetic_pair(const SyntheticOptions& options) {
  const SyntheticScene scene(options.size, options.frames);
  const auto loop = std::shared_ptr<SyntheticSource::Loop>(
      new SyntheticSource::Loop{{}, FrameClock(options.fps, {std::chrono::nanoseconds(0), options.skew})});
  for (std::vector<GreyImage>& pictures : loop->pictures)
    pictures.resize(static_cast<std::size_t>(options.frames));

  WorkerPool pool(static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 4U)));
  pool.run(options.frames, [&](int frame, int) {
    const auto index = static_cast<std::size_t>(frame);
    loop->pictures[0][index] = scene.render_left(frame);
    loop->pictures[1][index] = scene.render_right(frame);
  });
  return {std::make_unique<SyntheticSource>(loop, 0), std::make_unique<SyntheticSource>(loop, 1),
          scene.calibration()};
}

}  // namespace stereod
