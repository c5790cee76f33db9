// The thread that brings disparity rows to the network, at a pace receivers can follow.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "daemon/lcm/message_bus.h"
#include "daemon/lcm/message_encoder.h"
#include "daemon/publish/cloud_publisher.h"
#include "daemon/publish/depth_publisher.h"
#include "daemon/publish/output_frame.h"
#include "daemon/publish/published_pixels.h"
#include "daemon/publish/recent_values.h"
#include "daemon/publish/rows_encoder.h"
#include "daemon/publish/scan_publisher.h"
#include "stereod/disparity_rows_t.hpp"
#include "stereod/frame_t.hpp"

namespace stereod {

/// frame_t's values for what is not known.
inline constexpr float kUnknownFraction = -1;
inline constexpr std::int8_t kNoPriorLevel = -1;

/// How disparity goes onto the wire.
struct WireFormat {
  std::string prefix;          ///< of the channels
  std::string calibration_id;  ///< as in camera_info_t; empty: uncalibrated
  int rows_per_message = 1;
  int min_disparity = 0;
  int disparities = 1;
  int units_per_pixel = 1;
  bool with_depth = false;  ///< the same rows go out once more, as depth
  double pacing_s = 0;      ///< time over which one frame's rows are spread out; 0: sent as they come

  /// 1 if every value and the invalid one fit in a byte, else 2.
  int bytes_per_value() const;
  /// What a row takes in a message at most, the bits of its filled pixels included.
  int row_bytes(int width) const;
  int invalid_value() const { return bytes_per_value() == 1 ? 0xFF : 0xFFFF; }
};

/// As many rows as a message is best given where nobody says otherwise: 16, or less if rows of this width
/// leave no room for so many.
int usual_rows_per_message(const WireFormat& format, int width);

/// Why disparity images of this size (what of them is published) cannot go onto the wire like this, as a
/// sentence; nothing if they can.
std::optional<std::string> wire_problem(const WireFormat& format, Size published);

/// Figures about what was published. The recent ones are since the last take_stats().
struct PublisherStats {
  std::int64_t frames = 0;
  std::int64_t messages_refused = 0;
  // Of the latest frame, as in frame_t.
  double measured_fraction = 0, filled_fraction = 0, no_evidence_fraction = kUnknownFraction;
  RecentValues latency_ms, match_ms, skew_ms, skew_magnitude_ms;
};

/// What is shown the rows as well, because it is made of them; null: nothing. They outlive the publisher.
struct RowFollowers {
  ScanPublisher* scan = nullptr;
  DepthPublisher* depth = nullptr;
  CloudPublisher* cloud = nullptr;
};

/// Two frames are in it at most: one that workers fill and one that is being sent. Workers announce blocks of
/// rows as they become final; the thread sends each at once, unless that is faster than the pace: then it
/// waits, so that a burst does not overrun the receivers' socket buffers. Workers never wait for the network.
class FramePublisher {
 public:
  /// `size`: of the rectified image, `pixels`: what of it is published. Throws std::invalid_argument with a
  /// sentence if a block of rows does not fit in one message.
  FramePublisher(MessageBus& bus, const WireFormat& format, Size size, const PublishedPixels& pixels,
                 const RowFollowers& followers = {});
  ~FramePublisher();
  FramePublisher(const FramePublisher&) = delete;
  FramePublisher& operator=(const FramePublisher&) = delete;

  /// Rows are announced by blocks: block b is the published rows [b·rows_per_message, …).
  int blocks() const { return blocks_; }
  /// The rows of the rectified image that a block is made of, those between the published ones included.
  RowRange block_rows(int block) const;

  /// A frame to fill; waits until one is free. Null once stop() was called.
  OutputFrame* wait_free() noexcept;
  /// A block's rows are final. Any thread.
  void block_final(OutputFrame& frame, int block) noexcept;
  /// Every block was announced and frame.timing are complete; the frame belongs to the publisher from here on.
  void frame_final(OutputFrame& frame) noexcept;

  /// Waits until everything announced is sent.
  void drain() noexcept;
  /// Ends the thread; what was not sent is dropped.
  void stop() noexcept;

  PublisherStats take_stats() noexcept;
  /// Published since the start.
  std::int64_t frames() const noexcept;

 private:
  struct Event {
    OutputFrame* frame;
    int block;  // kFrameFinal: the frame is complete
  };
  static constexpr int kFrameFinal = -1;
  static constexpr int kFrames = 2;

  void enqueue(Event event) noexcept;
  void run() noexcept;
  void send_block(const OutputFrame& frame, int block) noexcept;
  void notify_consumers(const OutputFrame& frame, int block) noexcept;
  void send_frame_message(const OutputFrame& frame) noexcept;
  RowRange published_rows(int block) const;
  double bytes_of_frame() const;
  void keep_pace(std::size_t bytes) noexcept;

  MessageBus& bus_;
  const RowFollowers followers_;
  const WireFormat format_;
  const PublishedPixels pixels_;
  const int blocks_;
  const std::string rows_channel_, frame_channel_;

  mutable std::mutex mutex_;
  std::condition_variable frame_freed_, event_added_, all_sent_;
  OutputFrame frames_[kFrames];
  std::vector<OutputFrame*> free_;
  std::vector<Event> events_;  // a ring with room for all blocks of all frames
  std::size_t first_event_ = 0, event_count_ = 0;
  bool sending_ = false;
  bool stopping_ = false;
  PublisherStats stats_;

  // The publisher thread's own.
  MessageEncoder encoder_;
  disparity_rows_t rows_message_{};
  frame_t frame_message_{};
  PixelCounts pixels_sent_;  // of the frame being sent
  std::int64_t refused_ = 0;
  std::int64_t paced_until_ns_ = 0;
  std::thread thread_;
};

}  // namespace stereod
