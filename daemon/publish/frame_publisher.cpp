// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/publish/frame_publisher.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "daemon/base/clocks.h"
#include "daemon/lcm/limits.h"

namespace stereod {
namespace {

// "Not known" in frame_t.
constexpr float kUnknownFraction = -1;
constexpr std::int8_t kNoPriorLevel = -1;

}  // namespace

FramePublisher::FramePublisher(MessageBus& bus, const WireFormat& format, Size size,
                               const PublishedPixels& pixels, RowConsumers consumers)
    : bus_(bus),
      consumers_(std::move(consumers)),
      format_(format),
      pixels_(pixels),
      blocks_((pixels.height + format.rows_per_message - 1) / format.rows_per_message),
      rows_channel_(format.prefix + "_DISPARITY"),
      frame_channel_(format.prefix + "_FRAME"),
      frames_{OutputFrame(size), OutputFrame(size)},
      events_(static_cast<std::size_t>(kFrames) * (static_cast<std::size_t>(blocks_) + 1)),
      encoder_(kMaxDatagram),
      pacer_(format.pacing_s, bytes_of_frame()) {
  if (const auto problem = wire_problem(format, pixels.size())) throw std::invalid_argument(*problem);
  for (OutputFrame& frame : frames_) free_.push_back(&frame);
  prepare_messages();
  thread_ = std::thread([this] { run(); });
}

FramePublisher::~FramePublisher() { stop(); }

void FramePublisher::prepare_messages() {
  reserve_rows(rows_message_, pixels_.width, format_.rows_per_message, format_.bytes_per_value());
  rows_message_.width = pixels_.width;
  rows_message_.height = pixels_.height;
  rows_message_.left = pixels_.left;
  rows_message_.top = pixels_.top;
  rows_message_.decimation_x = pixels_.decimation_x;
  rows_message_.decimation_y = pixels_.decimation_y;
  rows_message_.min_disparity = format_.min_disparity;
  rows_message_.disparities = format_.disparities;
  rows_message_.scale = 1.0f / static_cast<float>(format_.units_per_pixel);
  rows_message_.bytes_per_value = static_cast<std::int8_t>(format_.bytes_per_value());
  rows_message_.invalid = format_.invalid_value();
  summary_.width = pixels_.width;
  summary_.height = summary_.rows = pixels_.height;
  summary_.messages = blocks_;
  summary_.no_evidence_fraction = kUnknownFraction;
  summary_.prior_level = kNoPriorLevel;
  summary_.calibration_id = format_.calibration_id;
  stats_.latest = summary_;
}

RowRange FramePublisher::published_rows(int block) const {
  const int first = block * format_.rows_per_message;
  return {first, std::min(first + format_.rows_per_message, pixels_.height)};
}

RowRange FramePublisher::block_rows(int block) const {
  const RowRange rows = published_rows(block);
  return {pixels_.top + rows.first * pixels_.decimation_y,
          std::min(pixels_.top + rows.end * pixels_.decimation_y, pixels_.rows().end)};
}

OutputFrame* FramePublisher::acquire_frame() noexcept {
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
  PublisherStats taken = stats_;
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
      end_frame(*event.frame);
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
  pacer_.wait_to_send(static_cast<std::size_t>(rows_message_.size + rows_message_.filled_size));
  if (!encoder_.publish(bus_, rows_channel_.c_str(), rows_message_)) ++refused_;
  notify_consumers(frame, block);
}

void FramePublisher::notify_consumers(const OutputFrame& frame, int block) noexcept {
  const FinalRows rows{frame.timing, frame.disparity.view(), published_rows(block), block_rows(block)};
  for (RowConsumer& consumer : consumers_) {
    if (const std::size_t bytes = consumer.bytes_for_rows(rows.published.count())) pacer_.wait_to_send(bytes);
    consumer.take_rows(rows);
  }
}

void FramePublisher::end_frame(const OutputFrame& frame) noexcept {
  fill_summary(frame.timing, monotonic_ns());
  ScanSummary scan;
  for (RowConsumer& consumer : consumers_) {
    if (const auto summary = consumer.end_rows(frame.timing)) scan = *summary;
  }
  summary_.stop = scan.stop ? 1 : 0;
  summary_.stop_reason = static_cast<std::int8_t>(scan.stop_reason);
  summary_.nearest_m = scan.nearest_m;
  summary_.scan_us = scan.scan_us;
  if (!encoder_.publish(bus_, frame_channel_.c_str(), summary_)) ++refused_;
  for (RowConsumer& consumer : consumers_) {
    if (const std::size_t bytes = consumer.bytes_at_end()) pacer_.wait_to_send(bytes);
    consumer.end_frame(frame.timing);
  }
  count_frame();
  pixels_sent_ = {};
}

void FramePublisher::fill_summary(const FrameTiming& timing, std::int64_t sent_ns) noexcept {
  const std::int64_t captured_ns = std::max(timing.left_ns, timing.right_ns);
  const auto us = [](std::int64_t ns) { return static_cast<std::int32_t>(ns / 1000); };
  const double pixels = static_cast<double>(pixels_.width) * pixels_.height;
  summary_.utime = timing.utime;
  summary_.frame = timing.frame;
  summary_.measured_fraction = static_cast<float>(static_cast<double>(pixels_sent_.measured) / pixels);
  summary_.filled_fraction = static_cast<float>(static_cast<double>(pixels_sent_.filled) / pixels);
  summary_.left_sequence = timing.left_sequence;
  summary_.right_sequence = timing.right_sequence;
  summary_.skew_us = us(timing.right_ns - timing.left_ns);
  summary_.capture_to_start_us = us(timing.started_ns - captured_ns);
  summary_.rectify_us = us(timing.rectify_ns);
  summary_.match_us = us(timing.match_ns);
  summary_.filter_us = us(timing.filter_ns);
  summary_.publish_us = us(sent_ns - timing.matched_ns);
  summary_.latency_us = us(sent_ns - captured_ns);
}

void FramePublisher::count_frame() noexcept {
  std::int64_t refused = refused_;
  for (const RowConsumer& consumer : consumers_) refused += consumer.refused();
  const std::lock_guard lock(mutex_);
  ++stats_.frames;
  stats_.messages_refused = refused;
  stats_.latest = summary_;
  stats_.latency_ms.add(summary_.latency_us / 1e3);
  stats_.match_ms.add((summary_.match_us + summary_.filter_us) / 1e3);
  stats_.skew_ms.add(summary_.skew_us / 1e3);
  stats_.skew_magnitude_ms.add(std::abs(summary_.skew_us) / 1e3);
}

// Excludes the bits of filled pixels, a small share.
double FramePublisher::bytes_of_frame() const {
  double bytes = static_cast<double>(pixels_.width) * pixels_.height * format_.bytes_per_value();
  for (const RowConsumer& consumer : consumers_) {
    bytes += static_cast<double>(consumer.bytes_for_rows(pixels_.height));
  }
  return bytes;
}

}  // namespace stereod
