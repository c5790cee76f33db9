// SPDX-License-Identifier: BSD-3-Clause
// The thread that sends disparity rows and frame summaries.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "daemon/lcm/message_bus.h"
#include "daemon/lcm/message_encoder.h"
#include "daemon/publish/output_frame.h"
#include "daemon/publish/pacer.h"
#include "daemon/publish/published_pixels.h"
#include "daemon/publish/recent_values.h"
#include "daemon/publish/row_consumer.h"
#include "daemon/publish/rows_encoder.h"
#include "daemon/publish/wire_format.h"
#include "stereod/disparity_rows_t.hpp"
#include "stereod/frame_t.hpp"

namespace stereod {

/// Counts and timing of what was published.
struct PublisherStats {
  std::int64_t frames = 0;            ///< since the start
  std::int64_t messages_refused = 0;  ///< by the network, since the start
  frame_t latest{};                   ///< the summary of the latest frame
  // Since the previous take_stats().
  RecentValues latency_ms, match_ms, skew_ms, skew_magnitude_ms;
};

/// Sends the disparity rows of each frame, then its summary, and passes the rows to other outputs.
///
/// Owns two frames: the workers fill one while the other is sent. Workers announce blocks of rows as they
/// become final; the publisher thread sends the blocks in the order of their announcement, delayed by pacing.
/// Workers never wait for the network: the matching thread waits in acquire_frame() if both frames are in
/// use.
class FramePublisher {
 public:
  /// @p size is the size of the rectified image [px]; @p pixels selects what of it is published. @p bus and
  /// @p consumers must outlive the publisher.
  /// @throws std::invalid_argument if a block of rows does not fit in one message.
  FramePublisher(MessageBus& bus, const WireFormat& format, Size size, const PublishedPixels& pixels,
                 RowConsumers consumers = {});
  ~FramePublisher();
  FramePublisher(const FramePublisher&) = delete;
  FramePublisher& operator=(const FramePublisher&) = delete;

  /// Returns the number of blocks in a frame. Block b covers the published rows [b·rows_per_message, …).
  int blocks() const { return blocks_; }
  /// Returns the rows of the rectified image that a block covers, rows skipped by decimation included.
  RowRange block_rows(int block) const;

  /// Returns a frame to fill; waits until one is free. Returns null after stop().
  OutputFrame* acquire_frame() noexcept;
  /// Announces that the rows of a block are final. Any thread.
  void block_final(OutputFrame& frame, int block) noexcept;
  /// Hands the frame to the publisher. Every block was announced and frame.timing is complete.
  void frame_final(OutputFrame& frame) noexcept;

  /// Waits until everything announced is sent, or stop() is called.
  void drain() noexcept;
  /// Ends the thread; drops what was not sent.
  void stop() noexcept;

  PublisherStats take_stats() noexcept;
  /// Returns the number of frames published since the start.
  std::int64_t frames() const noexcept;

 private:
  struct Event {
    OutputFrame* frame;
    int block;  // kFrameFinal: the frame is complete
  };
  static constexpr int kFrameFinal = -1;
  static constexpr int kFrames = 2;

  void prepare_messages();
  void enqueue(Event event) noexcept;
  void run() noexcept;
  void send_block(const OutputFrame& frame, int block) noexcept;
  void notify_consumers(const OutputFrame& frame, int block) noexcept;
  void end_frame(const OutputFrame& frame) noexcept;
  void fill_summary(const FrameTiming& timing, std::int64_t sent_ns) noexcept;
  void count_frame() noexcept;
  RowRange published_rows(int block) const;
  double bytes_of_frame() const;

  MessageBus& bus_;
  const RowConsumers consumers_;
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

  // Used by the publisher thread only.
  MessageEncoder encoder_;
  Pacer pacer_;
  disparity_rows_t rows_message_{};
  frame_t summary_{};
  PixelCounts pixels_sent_;  // of the frame being sent
  std::int64_t refused_ = 0;
  std::thread thread_;
};

}  // namespace stereod
