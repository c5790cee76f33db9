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

constexpr double kMaxPacing = 0.1;  // s; slow cameras need no more, and a stop should not wait for it

WireFormat wire_format(const Config& config, Size published, const std::string& calibration_id = {}) {
  WireFormat format;
  format.prefix = config.lcm.prefix;
  format.calibration_id = calibration_id;
  format.min_disparity = config.matcher.min_disparity;
  format.disparities = config.matcher.disparities;
  format.units_per_pixel = config.matcher.units_per_pixel();
  format.with_depth = config.publish.depth;
  format.rows_per_message =
      config.lcm.rows_per_message.value_or(usual_rows_per_message(format, published.width));
  const double fps = config.cameras.fps > 0 ? config.cameras.fps : 30;
  format.pacing_s = std::min(config.lcm.pacing / fps, kMaxPacing);
  return format;
}

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

// What is published of images of this size. Throws std::invalid_argument if there is no such region.
PublishedPixels published_pixels(const PublishConfig& publish, Size size) {
  if (size.width > kMaxImageSide || size.height > kMaxImageSide) {
    throw std::invalid_argument("the cameras give images of " + to_string(size) +
                                "; what can be published is " + std::to_string(kMaxImageSide) + " a side");
  }
  if (const auto problem = region_problem(publish, size)) throw std::invalid_argument(*problem);
  return {publish, size};
}

SourceLayout layout_of(const LumaView& luma) { return {luma.size, luma.row_stride, luma.pixel_stride}; }

}  // namespace

void check_pipeline(const Config& config, Size size) {
  const PublishedPixels pixels = published_pixels(config.publish, size);
  if (const auto problem = wire_problem(wire_format(config, pixels.size()), pixels.size()))
    throw std::invalid_argument(*problem);
  BandWorker(config.matcher, size, pixels.columns());
}

// What else is made of the rows; needs a calibration.
RowFollowers Pipeline::make_followers(MessageBus& bus) {
  if (!calibration_) return {};
  const std::string& prefix = config_.lcm.prefix;
  RowFollowers followers;
  if (config_.scan.enabled) {
    followers.scan =
        &scan_publisher_.emplace(bus, prefix, config_.scan, scan_geometry(*calibration_, config_.matcher));
  }
  if (config_.publish.depth) {
    followers.depth = &depth_publisher_.emplace(bus, prefix, *calibration_, config_.matcher, pixels_,
                                                wire_format(config_, pixels_.size()).rows_per_message);
  }
  if (config_.publish.cloud) {
    followers.cloud = &cloud_publisher_.emplace(bus, prefix, *calibration_, config_.matcher, pixels_,
                                                config_.publish.cloud_decimation);
  }
  return followers;
}

// The braces see to it that the calibration is copied before the rig is moved.
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
      publisher_(bus, wire_format(config, pixels_.size(), calibration_ ? calibration_->id : ""), size_,
                 pixels_, make_followers(bus)),
      pool_(config.worker_count()),
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
  if (left && right) prepare_maps(*left, *right);
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
    other.cameras_.reset();  // which closes the devices
    cameras_->start();
  }
  other.cameras_.reset();
  start();
}

// Ends the frame it is at and sends it all; the cameras go on.
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
  if (started_) cameras_->pair_queue().clear();  // the leases end before their sources do
}

std::int64_t Pipeline::frames_published() const noexcept { return frames_before_ + publisher_.frames(); }

PipelineStats Pipeline::take_stats() {
  PipelineStats stats{cameras_->stats(), publisher_.take_stats(), epipolar_monitor_.stats()};
  stats.published.frames += frames_before_;
  stats.published.messages_refused += refused_before_;
  if (raw_publisher_) stats.published.messages_refused += raw_publisher_->refused();
  if (left_publisher_) stats.published.messages_refused += left_publisher_->refused();
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
  while (OutputFrame* output = publisher_.wait_free()) {
    std::optional<LeasedPair> pair = cameras_->pair_queue().wait_pair(retiring_);
    if (!pair || stopping_) break;
    match_pair(*pair, *output);
  }
  publisher_.drain();
  finished_ = !retiring_;
}

void Pipeline::match_pair(const LeasedPair& pair, OutputFrame& output) {
  FrameTiming& timing = output.timing;
  timing.frame = next_frame_++;
  const std::int64_t own_utime = pair.left.frame().utime;
  timing.utime = own_utime != 0 ? own_utime : wall_us_of(pair.left_ns);
  timing.left_ns = pair.left_ns;
  timing.right_ns = pair.right_ns;
  timing.left_sequence = pair.left.frame().sequence;
  timing.right_sequence = pair.right.frame().sequence;
  prepare_maps(layout_of(pair.left.frame().luma), layout_of(pair.right.frame().luma));
  timing.started_ns = monotonic_ns();
  run_workers(pair, output);
  timing.filter_ns = 0;
  if (speckle_filter_) filter_frame(output);
  timing.matched_ns = monotonic_ns();
  const std::int64_t match_ns = timing.matched_ns - timing.started_ns;
  publisher_.frame_final(output);
  // After what is urgent.
  epipolar_monitor_.frame_matched({*left_map_, *left_masks_.whole, pair.left.frame().luma.data},
                                  {*right_map_, *right_masks_.whole, pair.right.frame().luma.data}, match_ns);
  if (raw_publisher_) raw_publisher_->offer(pair, timing.utime);
}

// The tables are made when the first frame shows how its pixels lie in memory, and again if that ever
// changes.
void Pipeline::prepare_maps(const SourceLayout& left, const SourceLayout& right) {
  const Interpolation interpolation = config_.rectify.interpolation;
  const ColumnRange matched = columns_to_match(config_.matcher, size_, pixels_.columns());
  const auto prepare = [&](std::optional<RectifyMap>& map, Masks& masks, const SourceLayout& layout,
                           const CameraCalibration* camera) {
    if (map && map->layout() == layout) return;
    map.emplace(camera != nullptr ? RectifyMap(*camera, layout, interpolation)
                                  : RectifyMap::identity(layout));
    masks.whole.emplace(map->mask());
    if (matched.count() == size_.width) return;
    masks.matched.emplace(Size{matched.count(), size_.height},
                          [&](int x, int y) { return map->offset(matched.first + x, y) >= 0; });
  };
  prepare(left_map_, left_masks_, left, calibration_ ? &calibration_->left : nullptr);
  prepare(right_map_, right_masks_, right, calibration_ ? &calibration_->right : nullptr);
}

void Pipeline::run_workers(const LeasedPair& pair, OutputFrame& output) {
  GrayImage* const left_image = left_publisher_ ? left_publisher_->take_if_due() : nullptr;
  const BandWorker::Job job{pair,   *left_map_, *right_map_, left_masks_.matching(), right_masks_.matching(),
                            output, publisher_, left_image,  !speckle_filter_};
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
  if (left_image == nullptr) return;
  // The left image is a whole one, whatever was matched.
  const std::uint8_t* source = pair.left.frame().luma.data;
  left_map_->gray_rows(source, {0, pixels_.rows().first}, left_image->view());
  left_map_->gray_rows(source, {pixels_.rows().end, size_.height}, left_image->view());
  left_publisher_->send(output.timing.utime);
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
