// SPDX-License-Identifier: BSD-3-Clause
// Matches stereo pairs and publishes the result.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/base/worker_pool.h"
#include "core/match/speckle.h"
#include "daemon/capture/stereo_capture.h"
#include "daemon/capture/stereo_source.h"
#include "daemon/config/config.h"
#include "daemon/pipeline/band_worker.h"
#include "daemon/pipeline/camera_rectification.h"
#include "daemon/pipeline/epipolar_monitor.h"
#include "daemon/publish/frame_publisher.h"
#include "daemon/publish/left_publisher.h"
#include "daemon/publish/raw_publisher.h"
#include "daemon/publish/row_outputs.h"

namespace stereod {

/// Counts and timing of the cameras, of what was published, and of the calibration check.
struct PipelineStats : CaptureStats {
  PublisherStats published;
  EpipolarStats epipolar;
};

/// Checks that frames of this size [px] can be matched and published.
/// @throws std::invalid_argument what the constructor of Pipeline would throw.
void check_pipeline(const Config& config, Size size);

/// Owns the matching threads of one configuration.
///
/// Threads: one capture thread per camera (StereoCapture), the matching thread, which takes pairs and is also
/// worker 0, workers 1…n−1, and the publisher thread. Left and raw images, if configured, have a sending
/// thread each. Allocates nothing after the first frame.
///
/// Immutable. To change settings, construct a second Pipeline and call take_over(): it inherits the cameras
/// (unless it was constructed with its own), the counters and the frame numbers.
class Pipeline {
 public:
  /// Starts capturing and matching. @p bus must outlive the pipeline.
  /// @throws std::invalid_argument if the configuration cannot work with frames of this size or on this CPU.
  Pipeline(const Config& config, StereoSource rig, MessageBus& bus);

  /// Prepares a pipeline that starts with take_over(). @p cameras are those of the pipeline to replace, or
  /// others that were not started. @p bus must outlive the pipeline.
  /// @throws std::invalid_argument if the configuration cannot work with frames of this size or on this CPU.
  Pipeline(const Config& config, std::optional<Calibration> calibration,
           std::shared_ptr<StereoCapture> cameras, MessageBus& bus);
  ~Pipeline();

  /// Waits until @p other has finished its current frame, then continues in its place. Stops the cameras of
  /// @p other if this pipeline has its own. A pair that arrives during the handover is kept unless a newer
  /// one replaces it. @p other must not be used afterwards.
  void take_over(Pipeline& other);

  /// Stops the cameras, then the threads in the direction of the data. Drops rows that were not sent.
  void stop() noexcept;

  /// Returns true once the cameras have played to their end and everything is published.
  bool finished() const noexcept { return finished_; }

  /// Returns true if nothing is to be done until the cameras deliver a pair.
  bool waits_for_cameras() const noexcept { return cameras_->pair_queue().consumer_waits(); }
  /// Returns the number of frames published since the start, by replaced pipelines as well.
  std::int64_t frames_published() const noexcept;

  PipelineStats take_stats();

  const StereoSource& rig() const { return cameras_->rig(); }
  const std::shared_ptr<StereoCapture>& cameras() const { return cameras_; }
  const std::optional<Calibration>& calibration() const { return calibration_; }
  const Config& config() const { return config_; }
  /// Returns a description like "semiglobal simd avx2, 2 workers".
  const std::string& matcher_description() const { return matcher_description_; }
  /// Returns which settings of `scheduling` the system refused; empty if none, or before the matching thread
  /// started. Any thread.
  std::string scheduling_problem() const;

 private:
  void start();
  void retire() noexcept;
  void matching_thread() noexcept;
  void match_pair(const LeasedPair& pair, OutputFrame& output);
  void prepare_rectification(const SourceLayout& left, const SourceLayout& right);
  void run_workers(const LeasedPair& pair, OutputFrame& output);
  void submit_left_image(const LeasedPair& pair, GrayImage& image, std::int64_t utime);
  void filter_frame(OutputFrame& output) noexcept;
  std::int64_t images_refused() const noexcept;

  const Config config_;
  std::shared_ptr<StereoCapture> cameras_;
  const std::optional<Calibration> calibration_;
  const Size size_;
  const PublishedPixels pixels_;
  std::string matcher_description_;
  const OwnedRowConsumers row_consumers_;
  FramePublisher publisher_;
  WorkerPool pool_;
  std::vector<BandWorker> workers_;
  std::optional<SpeckleFilter> speckle_filter_;
  std::optional<RawPublisher> raw_publisher_;
  std::optional<LeftPublisher> left_publisher_;
  CameraRectification left_, right_;
  EpipolarMonitor epipolar_monitor_;
  mutable std::mutex scheduling_mutex_;
  std::string scheduling_problem_;
  std::int64_t next_frame_ = 0;
  std::int64_t frames_before_ = 0, refused_before_ = 0;  // of replaced pipelines
  bool started_ = false;
  std::atomic<bool> retiring_{false};
  std::atomic<bool> stopping_{false};
  std::atomic<bool> finished_{false};
  std::thread matching_thread_;
};

}  // namespace stereod
