// From two cameras to disparity rows on the network.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/match/speckle.h"
#include "core/worker_pool.h"
#include "daemon/capture/rig.h"
#include "daemon/config/config.h"
#include "daemon/pipeline/band_worker.h"
#include "daemon/pipeline/capture_thread.h"
#include "daemon/pipeline/frame_publisher.h"
#include "daemon/pipeline/left_publisher.h"
#include "daemon/pipeline/pairing_desk.h"
#include "daemon/pipeline/raw_publisher.h"

namespace stereod {

/// What one camera did since the start.
struct CameraFigures {
  SourceReport report;
  std::int64_t frames = 0;
  std::int64_t sequence_gaps = 0;
  double mean_brightness = 0;  ///< of the latest frame, 0…255
};

/// What the pipeline did; see PublisherFigures for what "recent" means.
struct PipelineFigures {
  CameraFigures left, right;
  PairingCounts pairing;
  PublisherFigures published;
};

/// Throws what the constructor of Pipeline would for frames of this size: std::invalid_argument with a
/// sentence.
void check_pipeline(const Config& config, Size size);

/// Runs these threads: one for each camera (CaptureThread), the matching thread, which takes pairs and is
/// itself the first of the workers, the other workers, and the publisher. After the first frame it allocates
/// nothing.
class Pipeline {
 public:
  /// Starts at once. The bus outlives it. Throws std::invalid_argument with a sentence if the configuration
  /// cannot work with frames of this size or on this CPU.
  Pipeline(const Config& config, Rig rig, MessageBus& bus);
  ~Pipeline();

  /// Stops cameras and workers, in the direction of the data. Rows not sent by then are dropped.
  void stop() noexcept;

  /// True once the cameras have played to their end and everything is published.
  bool finished() const noexcept { return finished_; }

  PipelineFigures take_figures();

  const Rig& rig() const { return rig_; }
  const Config& config() const { return config_; }
  /// For people: "block simd avx2, 2 workers".
  const std::string& matcher_description() const { return matcher_description_; }

 private:
  void matching_thread() noexcept;
  void match_pair(const LeasedPair& pair, OutputFrame& output);
  void prepare_maps(const LeasedPair& pair);
  void run_workers(const LeasedPair& pair, OutputFrame& output);
  void filter_frame(OutputFrame& output) noexcept;

  const Config config_;
  Rig rig_;
  const Size size_;
  std::string matcher_description_;
  std::optional<ScanPublisher> scan_publisher_;
  FramePublisher publisher_;
  PairingDesk desk_;
  WorkerPool pool_;
  std::vector<BandWorker> workers_;
  std::optional<SpeckleFilter> speckle_filter_;
  std::optional<RawPublisher> raw_publisher_;
  std::optional<LeftPublisher> left_publisher_;
  std::optional<RectifyMap> left_map_, right_map_;
  std::optional<ValidityMask> left_mask_, right_mask_;  // of the maps
  std::int64_t next_frame_ = 0;
  std::atomic<bool> stopping_{false};
  std::atomic<bool> finished_{false};
  std::optional<CaptureThread> left_thread_, right_thread_;
  std::thread matching_thread_;
};

}  // namespace stereod
