// From two cameras to disparity rows on the network.
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
#include "daemon/pipeline/epipolar_monitor.h"
#include "daemon/publish/frame_publisher.h"
#include "daemon/publish/left_publisher.h"
#include "daemon/publish/raw_publisher.h"

namespace stereod {

/// What the pipeline did; see PublisherStats for what "recent" means.
struct PipelineStats : CaptureStats {
  PublisherStats published;
  EpipolarStats alignment;
};

/// Throws what the constructor of Pipeline would for frames of this size: std::invalid_argument with a
/// sentence.
void check_pipeline(const Config& config, Size size);

/// Runs these threads: one for each camera (Cameras), the matching thread, which takes pairs and is itself
/// the first of the workers, the other workers, and the publisher. After the first frame it allocates
/// nothing.
///
/// Settings do not change during its life. Other settings are another pipeline, which is made while this one
/// works and then takes over its cameras (or brings its own), its counts and the numbering of frames.
class Pipeline {
 public:
  /// Starts at once. The bus outlives it. Throws std::invalid_argument with a sentence if the configuration
  /// cannot work with frames of this size or on this CPU.
  Pipeline(const Config& config, StereoSource rig, MessageBus& bus);

  /// Gets ready to take over from another pipeline, and throws as above. The cameras are that one's, or
  /// others that were not started yet.
  Pipeline(const Config& config, std::optional<Calibration> calibration,
           std::shared_ptr<StereoCapture> cameras, MessageBus& bus);
  ~Pipeline();

  /// Lets the other pipeline end the frame it is at, stops its cameras if these are others, and starts. A
  /// pair that comes meanwhile is kept if there is no newer one. The other one is of no use any more.
  void take_over(Pipeline& other);

  /// Stops cameras and workers, in the direction of the data. Rows not sent by then are dropped.
  void stop() noexcept;

  /// True once the cameras have played to their end and everything is published.
  bool finished() const noexcept { return finished_; }

  /// Nothing is to be done until the cameras bring a pair.
  bool waits_for_cameras() const noexcept { return cameras_->pair_queue().consumer_waits(); }
  /// Frames published since the start.
  std::int64_t frames_published() const noexcept;

  PipelineStats take_stats();

  const StereoSource& rig() const { return cameras_->rig(); }
  const std::shared_ptr<StereoCapture>& cameras() const { return cameras_; }
  const std::optional<Calibration>& calibration() const { return calibration_; }
  const Config& config() const { return config_; }
  /// For people: "semiglobal simd avx2, 2 workers".
  const std::string& matcher_description() const { return matcher_description_; }
  /// What of `scheduling` the system refused, as a sentence; empty if nothing, or not known yet. Any thread.
  std::string scheduling_problem() const;

 private:
  RowFollowers make_followers(MessageBus& bus);
  void start();
  void retire() noexcept;
  void matching_thread() noexcept;
  void match_pair(const LeasedPair& pair, OutputFrame& output);
  void prepare_maps(const SourceLayout& left, const SourceLayout& right);
  void run_workers(const LeasedPair& pair, OutputFrame& output);
  void filter_frame(OutputFrame& output) noexcept;

  const Config config_;
  std::shared_ptr<StereoCapture> cameras_;
  const std::optional<Calibration> calibration_;
  const Size size_;
  const PublishedPixels pixels_;
  std::string matcher_description_;
  std::optional<ScanPublisher> scan_publisher_;
  std::optional<DepthPublisher> depth_publisher_;
  std::optional<CloudPublisher> cloud_publisher_;
  FramePublisher publisher_;
  WorkerPool pool_;
  std::vector<BandWorker> workers_;
  std::optional<SpeckleFilter> speckle_filter_;
  std::optional<RawPublisher> raw_publisher_;
  std::optional<LeftPublisher> left_publisher_;
  std::optional<RectifyMap> left_map_, right_map_;
  /// Of a map: of all columns, and of those that are matched if these are fewer.
  struct Masks {
    std::optional<ValidityMask> whole, matched;
    const ValidityMask& matching() const { return matched ? *matched : *whole; }
  };
  Masks left_masks_, right_masks_;
  mutable std::mutex scheduling_mutex_;
  std::string scheduling_problem_;
  EpipolarMonitor epipolar_monitor_;
  std::int64_t next_frame_ = 0;
  std::int64_t frames_before_ = 0,
               refused_before_ = 0;  // published by, and refused to, those taken over from
  bool started_ = false;
  std::atomic<bool> retiring_{false};
  std::atomic<bool> stopping_{false};
  std::atomic<bool> finished_{false};
  std::thread matching_thread_;
};

}  // namespace stereod
