#include "daemon/publish/frame_publisher.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <stdexcept>

#include "daemon/base/clocks.h"
#include "daemon/lcm/limits.h"

namespace stereod {
namespace {

constexpr int kHeaderAllowance = 256;  // channel name and the message's own fields
constexpr int kRoom = kMaxDatagram - kHeaderAllowance;
constexpr int kUsualRows = 16;                // fewer are lost more easily (docs/loss.md), more come later
constexpr std::int64_t kBurstBytes = 96'000;  // fits a default socket buffer (212,992 B with its overhead)

}  // namespace

int usual_rows_per_message(const WireFormat& format, int width) {
  return std::min(kUsualRows, kRoom / format.row_bytes(width));
}

std::optional<std::string> wire_problem(const WireFormat& format, Size published) {
  const int row_bytes = format.row_bytes(published.width);
  if (format.rows_per_message * row_bytes <= kRoom) return std::nullopt;
  return "found " + std::to_string(format.rows_per_message) + ", but rows of " + std::to_string(row_bytes) +
         " bytes are sent and a message holds " + std::to_string(kRoom) + ", so allowed are 1 to " +
         std::to_string(kRoom / row_bytes);
}

int WireFormat::bytes_per_value() const {
  return (min_disparity + disparities - 1) * units_per_pixel < 0xFF ? 1 : 2;
}

int WireFormat::row_bytes(int width) const {
  const int disparity = width * bytes_per_value() + (width + 7) / 8;
  return with_depth ? std::max(disparity, width * DepthPublisher::kBytesPerValue) : disparity;
}

FramePublisher::FramePublisher(MessageBus& bus, const WireFormat& format, Size size,
                               const PublishedPixels& pixels, const RowFollowers& followers)
    : bus_(bus),
      followers_(followers),
      format_(format),
      pixels_(pixels),
      blocks_((pixels.height + format.rows_per_message - 1) / format.rows_per_message),
      rows_channel_(format.prefix + "_DISPARITY"),
      frame_channel_(format.prefix + "_FRAME"),
      frames_{OutputFrame(size), OutputFrame(size)},
      events_(static_cast<std::size_t>(kFrames) * (static_cast<std::size_t>(blocks_) + 1)),
      encoder_(kMaxDatagram) {
  if (const auto problem = wire_problem(format, pixels.size())) throw std::invalid_argument(*problem);
  for (OutputFrame& frame : frames_) free_.push_back(&frame);
  reserve_rows(rows_message_, pixels.width, format.rows_per_message, format.bytes_per_value());
  rows_message_.width = pixels.width;
  rows_message_.height = pixels.height;
  rows_message_.left = pixels.left;
  rows_message_.top = pixels.top;
  rows_message_.decimation_x = pixels.decimation_x;
  rows_message_.decimation_y = pixels.decimation_y;
  rows_message_.min_disparity = format.min_disparity;
  rows_message_.disparities = format.disparities;
  rows_message_.scale = 1.0f / static_cast<float>(format.units_per_pixel);
  rows_message_.bytes_per_value = static_cast<std::int8_t>(format.bytes_per_value());
  rows_message_.invalid = format.invalid_value();
  frame_message_.width = pixels.width;
  frame_message_.height = frame_message_.rows = pixels.height;
  frame_message_.messages = blocks_;
  frame_message_.no_evidence_fraction = kUnknownFraction;
  frame_message_.prior_level = kNoPriorLevel;
  frame_message_.calibration_id = format.calibration_id;
  thread_ = std::thread([this] { run(); });
}

FramePublisher::~FramePublisher() { stop(); }

RowRange FramePublisher::published_rows(int block) const {
  const int first = block * format_.rows_per_message;
  return {first, std::min(first + format_.rows_per_message, pixels_.height)};
}

RowRange FramePublisher::block_rows(int block) const {
  const RowRange rows = published_rows(block);
  return {pixels_.top + rows.first * pixels_.decimation_y,
          std::min(pixels_.top + rows.end * pixels_.decimation_y, pixels_.rows().end)};
}

OutputFrame* FramePublisher::wait_free() noexcept {
  std::unique_lock lock(mutex_);
  frame_freed_.wait(lock, [this] { return stopping_ || !free_.empty(); });
  if (stopping_) return nullptr;
  OutputFrame* frame = free_.back();
  free_.pop_back();
  return frame;
}

void FramePublisher::block_final(OutputFrame& frame, int block) noexcept { enqueue({&frame, block}); }
void FramePublisher::frame_final(OutputFrame& frame) noexcept { enqueue({&frame, kFrameFinal}); }

void FramePublisher::enqueue(Event event) noexcept {
  const std::lock_guard lock(mutex_);
  events_[(first_event_ + event_count_++) % events_.size()] = event;
  event_added_.notify_one();
}

void FramePublisher::drain() noexcept {
  std::unique_lock lock(mutex_);
  all_sent_.wait(lock, [this] { return stopping_ || (event_count_ == 0 && !sending_); });
}

void FramePublisher::stop() noexcept {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    frame_freed_.notify_all();
    event_added_.notify_all();
    all_sent_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

std::int64_t FramePublisher::frames() const noexcept {
  const std::lock_guard lock(mutex_);
  return stats_.frames;
}

PublisherStats FramePublisher::take_stats() noexcept {
  const std::lock_guard lock(mutex_);
  const PublisherStats taken = stats_;
  stats_.latency_ms.clear();
  stats_.match_ms.clear();
  stats_.skew_ms.clear();
  stats_.skew_magnitude_ms.clear();
  return taken;
}

void FramePublisher::run() noexcept {
  std::unique_lock lock(mutex_);
  while (true) {
    event_added_.wait(lock, [this] { return stopping_ || event_count_ > 0; });
    if (stopping_) return;
    const Event event = events_[first_event_];
    first_event_ = (first_event_ + 1) % events_.size();
    --event_count_;
    sending_ = true;
    lock.unlock();
    if (event.block == kFrameFinal) {
      send_frame_message(*event.frame);
    } else {
      send_block(*event.frame, event.block);
    }
    lock.lock();
    sending_ = false;
    if (event.block == kFrameFinal) {
      free_.push_back(event.frame);
      frame_freed_.notify_one();
    }
    if (event_count_ == 0) all_sent_.notify_all();
  }
}

void FramePublisher::send_block(const OutputFrame& frame, int block) noexcept {
  rows_message_.utime = frame.timing.utime;
  rows_message_.frame = frame.timing.frame;
  const PixelCounts counts = encode_rows(frame.disparity.view(), published_rows(block), rows_message_);
  pixels_sent_.measured += counts.measured;
  pixels_sent_.filled += counts.filled;
  keep_pace(static_cast<std::size_t>(rows_message_.size + rows_message_.filled_size));
  if (!encoder_.publish(bus_, rows_channel_.c_str(), rows_message_)) ++refused_;
  notify_consumers(frame, block);
}

void FramePublisher::notify_consumers(const OutputFrame& frame, int block) noexcept {
  if (followers_.depth != nullptr) {
    const RowRange published = published_rows(block);
    keep_pace(static_cast<std::size_t>(published.count() * pixels_.width * DepthPublisher::kBytesPerValue));
    if (!followers_.depth->send_rows(frame.timing, frame.disparity.view(), published)) ++refused_;
  }
  if (followers_.scan == nullptr && followers_.cloud == nullptr) return;
  const RowRange rows = block_rows(block);
  for (int y = rows.first; y < rows.end; ++y) {
    if (followers_.scan != nullptr) followers_.scan->add_row(y, frame.disparity.row(y));
    if (followers_.cloud != nullptr) followers_.cloud->add_row(y, frame.disparity.row(y));
  }
}

void FramePublisher::send_frame_message(const OutputFrame& frame) noexcept {
  const FrameTiming& timing = frame.timing;
  const std::int64_t captured_ns = std::max(timing.left_ns, timing.right_ns);
  const std::int64_t sent_ns = monotonic_ns();
  const auto us = [](std::int64_t ns) { return static_cast<std::int32_t>(ns / 1000); };
  const double pixels = static_cast<double>(pixels_.width) * pixels_.height;
  frame_message_.utime = timing.utime;
  frame_message_.frame = timing.frame;
  frame_message_.measured_fraction = static_cast<float>(static_cast<double>(pixels_sent_.measured) / pixels);
  frame_message_.filled_fraction = static_cast<float>(static_cast<double>(pixels_sent_.filled) / pixels);
  frame_message_.left_sequence = timing.left_sequence;
  frame_message_.right_sequence = timing.right_sequence;
  frame_message_.skew_us = us(timing.right_ns - timing.left_ns);
  frame_message_.capture_to_start_us = us(timing.started_ns - captured_ns);
  frame_message_.rectify_us = us(timing.rectify_ns);
  frame_message_.match_us = us(timing.match_ns);
  frame_message_.filter_us = us(timing.filter_ns);
  frame_message_.publish_us = us(sent_ns - timing.matched_ns);
  frame_message_.latency_us = us(sent_ns - captured_ns);
  if (followers_.scan != nullptr && !followers_.scan->finish(frame_message_)) ++refused_;
  if (!encoder_.publish(bus_, frame_channel_.c_str(), frame_message_)) ++refused_;
  if (followers_.cloud != nullptr) {
    keep_pace(followers_.cloud->bytes());
    if (!followers_.cloud->finish(timing)) ++refused_;
  }

  const std::lock_guard lock(mutex_);
  ++stats_.frames;
  stats_.messages_refused = refused_;
  stats_.measured_fraction = frame_message_.measured_fraction;
  stats_.filled_fraction = frame_message_.filled_fraction;
  stats_.no_evidence_fraction = frame_message_.no_evidence_fraction;
  stats_.latency_ms.add(frame_message_.latency_us / 1e3);
  stats_.match_ms.add((frame_message_.match_us + frame_message_.filter_us) / 1e3);
  stats_.skew_ms.add(frame_message_.skew_us / 1e3);
  stats_.skew_magnitude_ms.add(std::abs(frame_message_.skew_us) / 1e3);
  pixels_sent_ = {};
}

double FramePublisher::bytes_of_frame() const {
  const int bytes = format_.bytes_per_value() + (format_.with_depth ? DepthPublisher::kBytesPerValue : 0);
  return static_cast<double>(pixels_.width) * pixels_.height * bytes;
}

// Lets a burst through, then no more bytes than the spread allows.
void FramePublisher::keep_pace(std::size_t bytes) noexcept {
  if (format_.pacing_s <= 0) return;
  const double ns_per_byte = format_.pacing_s * 1e9 / bytes_of_frame();
  const std::int64_t now = monotonic_ns();
  const auto burst_ns = static_cast<std::int64_t>(ns_per_byte * static_cast<double>(kBurstBytes));
  paced_until_ns_ = std::max(paced_until_ns_, now - burst_ns) +
                    static_cast<std::int64_t>(ns_per_byte * static_cast<double>(bytes));
  if (paced_until_ns_ > now) std::this_thread::sleep_for(std::chrono::nanoseconds(paced_until_ns_ - now));
}

}  // namespace stereod
