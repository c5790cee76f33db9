#include "calib/live/frame_feed.h"

#include <string>

namespace stereod {

namespace {

GrayImage copied(const LumaView& luma) {
  GrayImage picture(luma.size);
  for (int y = 0; y < luma.size.height; ++y) {
    const std::uint8_t* from = luma.data + y * luma.row_stride;
    std::uint8_t* to = picture.row(y);
    for (int x = 0; x < luma.size.width; ++x) to[x] = from[x * luma.pixel_stride];
  }
  return picture;
}

}  // namespace

CameraFeed::CameraFeed(const Config& config)
    : rig_(open_stereo_source(config)),
      waits_(config.cameras.fps == 0),
      pairing_(config.cameras.pairing_tolerance_ns()),
      left_thread_([this] { read(*rig_.left, Side::kLeft); }),
      right_thread_([this] { read(*rig_.right, Side::kRight); }) {}

CameraFeed::~CameraFeed() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  rig_.left->stop();
  rig_.right->stop();
}

void CameraFeed::read(FrameSource& source, Side side) {
  constexpr std::chrono::milliseconds kPatience{200};
  for (;;) {
    FrameLease lease = source.next(kPatience);
    std::unique_lock lock(mutex_);
    if (stopping_) break;
    if (!lease) {
      if (source.state() == SourceState::kFinished) break;
      continue;
    }
    const std::uint64_t taken_before = taken_;
    GrayImage picture = copied(lease.frame().luma);
    pairing_.add(side, std::move(picture), lease.frame().captured_ns);
    changed_.notify_all();
    // The lease holds the source back until the pair that this frame belongs to is taken.
    if (waits_) changed_.wait(lock, [&] { return stopping_ || taken_ != taken_before; });
  }
  const std::lock_guard lock(mutex_);
  --running_;
  changed_.notify_all();
}

std::optional<ImagePair> CameraFeed::next(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, timeout, [&] { return pairing_.has_pair() || running_ == 0; });
  auto pair = pairing_.take();
  if (!pair) return std::nullopt;
  ++taken_;
  changed_.notify_all();
  return ImagePair{"pair " + std::to_string(taken_), std::move(pair->left), std::move(pair->right)};
}

bool CameraFeed::finished() const {
  const std::lock_guard lock(mutex_);
  return running_ == 0 && !pairing_.has_pair();
}

}  // namespace stereod
