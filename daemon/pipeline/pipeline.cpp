// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pipeline/pipeline.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/base/cpu.h"
#include "core/base/text.h"
#include "daemon/base/clocks.h"
#include "daemon/lcm/limits.h"
#include "daemon/pipeline/worker_scheduling.h"

namespace stereod {
namespace {

std::string describe(const Config& config) {
  std::string text(name_of(config.matcher.method));
  text += " ";
  text += name_of(config.matcher.implementation);
  if (config.matcher.implementation == Implementation::kSimd) {
    text += " " + std::string(name_of(resolve_isa(config.matcher.isa)));
  }
  const int workers = config.worker_count();
  return text + ", " + std::to_string(workers) + (workers == 1 ? " worker" : " workers");
}

/// Returns the published pixels of images of this size.
/// @throws std::invalid_argument if the images are too large or do not contain the region.
PublishedPixels published_pixels(const PublishConfig& publish, Size size) {
  if (size.width > kMaxImageSide || size.height > kMaxImageSide) {
    throw std::invalid_argument("found images of " + to_string(size) + " px, allowed: up to " +
                                std::to_string(kMaxImageSide) + " px per side");
  }
  if (const auto problem = region_problem(publish, size)) throw std::invalid_argument(*problem);
  return {publish, size};
}

SourceLayout layout_of(const LumaView& luma) { return {luma.size, luma.row_stride, luma.pixel_stride}; }

FrameTiming origin_of(const LeasedPair& pair, std::int64_t frame) {
  FrameTiming timing;
  timing.frame = frame;
  const std::int64_t recorded_utime = pair.left.frame().utime;
  timing.utime = recorded_utime != 0 ? recorded_utime : wall_us_of(pair.left_ns);
  timing.left_ns = pair.left_ns;
  timing.right_ns = pair.right_ns;
  timing.left_sequence = pair.left.frame().sequence;
  timing.right_sequence = pair.right.frame().sequence;
  return timing;
}

}  // namespace

void check_pipeline(const Config& config, Size size) {
  const PublishedPixels pixels = published_pixels(config.publish, size);
  if (const auto problem = wire_problem(wire_format(config, pixels.size()), pixels.size())) {
    throw std::invalid_argument(*problem);
  }
  BandWorker(config.matcher, size, pixels.columns());
}

// Braces fix the order of evaluation: the calibration is copied before the rig is moved.
Pipeline::Pipeline(const Config& config, StereoSource rig, MessageBus& bus)
    : Pipeline{config, std::optional<Calibration>(rig.calibration),
               std::make_shared<StereoCapture>(config.cameras, std::move(rig)), bus} {
  cameras_->start();
  start();
}

Pipeline::Pipeline(const Config& config, std::optional<Calibration> calibration,
                   std::shared_ptr<StereoCapture> cameras, MessageBus& bus)
    : config_(config),
      cameras_(std::move(cameras)),
      calibration_(std::move(calibration)),
      size_(cameras_->rig().left->frame_size()),
      pixels_(published_pixels(config.publish, size_)),
      matcher_description_(describe(config)),
      row_consumers_(make_row_consumers(bus, config, calibration_, pixels_)),
      publisher_(bus, wire_format(config, pixels_.size(), calibration_ ? calibration_->id : ""), size_,
                 pixels_, references_to(row_consumers_)),
      pool_(config.worker_count()),
      left_(calibration_ ? &calibration_->left : nullptr, config.rectify.interpolation,
            columns_to_match(config.matcher, size_, pixels_.columns())),
      right_(calibration_ ? &calibration_->right : nullptr, config.rectify.interpolation,
             columns_to_match(config.matcher, size_, pixels_.columns())),
      epipolar_monitor_(size_, config.matcher.min_disparity, config.matcher.disparities) {
  for (int worker = 0; worker < pool_.workers(); ++worker) {
    workers_.emplace_back(config.matcher, size_, pixels_.columns());
  }
  if (config.matcher.speckle_size > 0) {
    speckle_filter_.emplace(Size{pixels_.columns().count(), pixels_.rows().count()});
  }
  if (config.lcm.raw_images) {
    raw_publisher_.emplace(bus, config.lcm.prefix, config.lcm.raw_images_per_second, size_);
  }
  if (config.lcm.left_image.enabled) {
    left_publisher_.emplace(bus, config.lcm.prefix, config.lcm.left_image, size_);
  }
  const auto left = cameras_->pair_queue().layout(Side::kLeft);
  const auto right = cameras_->pair_queue().layout(Side::kRight);
  if (left && right) prepare_rectification(*left, *right);
}

Pipeline::~Pipeline() { stop(); }

void Pipeline::start() {
  started_ = true;
  matching_thread_ = std::thread([this] { matching_thread(); });
}

void Pipeline::take_over(Pipeline& other) {
  other.retire();
  const PublisherStats published = other.take_stats().published;
  frames_before_ = published.frames;
  refused_before_ = published.messages_refused;
  next_frame_ = other.next_frame_;
  if (cameras_ != other.cameras_) {
    other.cameras_->stop();
    cameras_->count_on_from(*other.cameras_);
    other.cameras_.reset();  // closes the devices, which these cameras may need
    cameras_->start();
  }
  other.cameras_.reset();
  start();
}

// Finishes and sends the current frame; the cameras keep running.
void Pipeline::retire() noexcept {
  retiring_ = true;
  cameras_->pair_queue().wake_consumer();
  if (matching_thread_.joinable()) matching_thread_.join();
  started_ = false;
}

void Pipeline::stop() noexcept {
  stopping_ = true;
  if (started_) cameras_->stop();
  publisher_.stop();
  if (raw_publisher_) raw_publisher_->stop();
  if (left_publisher_) left_publisher_->stop();
  if (matching_thread_.joinable()) matching_thread_.join();
  if (started_) cameras_->pair_queue().clear();  // leases must end before their sources
}

std::int64_t Pipeline::frames_published() const noexcept { return frames_before_ + publisher_.frames(); }

std::int64_t Pipeline::images_refused() const noexcept {
  return (raw_publisher_ ? raw_publisher_->refused() : 0) +
         (left_publisher_ ? left_publisher_->refused() : 0);
}

PipelineStats Pipeline::take_stats() {
  PipelineStats stats{cameras_->stats(), publisher_.take_stats(), epipolar_monitor_.stats()};
  stats.published.frames += frames_before_;
  stats.published.messages_refused += refused_before_ + images_refused();
  return stats;
}

std::string Pipeline::scheduling_problem() const {
  const std::lock_guard lock(scheduling_mutex_);
  return scheduling_problem_;
}

void Pipeline::matching_thread() noexcept {
  {
    const std::lock_guard lock(scheduling_mutex_);
    scheduling_problem_ = schedule_workers(pool_, config_.scheduling);
  }
  while (OutputFrame* output = publisher_.acquire_frame()) {
    std::optional<LeasedPair> pair = cameras_->pair_queue().wait_pair(retiring_);
    if (!pair || stopping_) break;
    match_pair(*pair, *output);
  }
  publisher_.drain();
  finished_ = !retiring_;
}

void Pipeline::match_pair(const LeasedPair& pair, OutputFrame& output) {
  const LumaView& left = pair.left.frame().luma;
  const LumaView& right = pair.right.frame().luma;
  FrameTiming& timing = output.timing;
  timing = origin_of(pair, next_frame_++);
  prepare_rectification(layout_of(left), layout_of(right));
  timing.started_ns = monotonic_ns();
  run_workers(pair, output);
  if (speckle_filter_) filter_frame(output);
  timing.matched_ns = monotonic_ns();
  const std::int64_t match_ns = timing.matched_ns - timing.started_ns;
  const std::int64_t utime = timing.utime;
  publisher_.frame_final(output);  // from here on the publisher owns the frame
  // Work that is not urgent comes last.
  epipolar_monitor_.frame_matched({left_.map(), left_.mask(), left.data},
                                  {right_.map(), right_.mask(), right.data}, match_ns);
  if (raw_publisher_) raw_publisher_->offer({left, utime}, {right, utime + pair.skew_ns() / 1000});
}

void Pipeline::prepare_rectification(const SourceLayout& left, const SourceLayout& right) {
  left_.prepare(left);
  right_.prepare(right);
}

void Pipeline::run_workers(const LeasedPair& pair, OutputFrame& output) {
  GrayImage* const left_image = left_publisher_ ? left_publisher_->claim() : nullptr;
  const BandWorker::Job job{pair, left_, right_, output, publisher_, left_image, !speckle_filter_};
  const int blocks = publisher_.blocks();
  const int bands = std::min(pool_.workers(), blocks);
  pool_.run(bands, [&](int band, int /*worker*/) {
    workers_[static_cast<std::size_t>(band)].run(job, band_rows(blocks, band, bands));
  });
  std::int64_t rectify_ns = 0, match_ns = 0;
  for (int band = 0; band < bands; ++band) {
    rectify_ns += workers_[static_cast<std::size_t>(band)].rectify_ns();
    match_ns += workers_[static_cast<std::size_t>(band)].match_ns();
  }
  output.timing.rectify_ns = rectify_ns / bands;
  output.timing.match_ns = match_ns / bands;
  if (left_image != nullptr) submit_left_image(pair, *left_image, output.timing.utime);
}

// The workers copied the published rows only; the left image has all rows.
void Pipeline::submit_left_image(const LeasedPair& pair, GrayImage& image, std::int64_t utime) {
  const std::uint8_t* source = pair.left.frame().luma.data;
  left_.map().gray_rows(source, {0, pixels_.rows().first}, image.view());
  left_.map().gray_rows(source, {pixels_.rows().end, size_.height}, image.view());
  left_publisher_->submit(utime);
}

void Pipeline::filter_frame(OutputFrame& output) noexcept {
  const std::int64_t begin = monotonic_ns();
  const MatcherOptions& options = config_.matcher;
  const Size region{pixels_.columns().count(), pixels_.rows().count()};
  const ImageView<std::int16_t> published(output.disparity.row(pixels_.top) + pixels_.left, region.width,
                                          region.height, output.disparity.view().stride());
  speckle_filter_->apply(published, options.speckle_size,
                         options.speckle_max_diff * options.units_per_pixel());
  output.timing.filter_ns = monotonic_ns() - begin;
  for (int block = 0; block < publisher_.blocks(); ++block) publisher_.block_final(output, block);
}

}  // namespace stereod
