#include "daemon/capture/v4l2/camera_stream.h"

#include <algorithm>
#include <cerrno>

#include "core/base/text.h"

namespace stereod {
namespace {

// Numbers of buffers that a lease carries: the driver's from 0 on, then the decoded images.
constexpr int kFirstPicture = 1000;

}  // namespace

std::string describe(const StreamInfo& info) {
  if (info.pixels == nullptr) return {};
  const std::string how = info.converted ? " (converted by libv4l2)" : "";
  return fourcc_name(info.format.pixels) + " " + to_string(info.format.size) + " at " +
         significant(info.fps, 4) + "/s" + how;
}

CameraStream::CameraStream(VideoSystem& system, Size size) : system_(system), device_(system) {
  for (int i = 0; i < kImages; ++i) pictures_.emplace_back(size);
  image_on_loan_.resize(kImages);
}

CameraStream::~CameraStream() {
  stop();
  close();
}

std::optional<CameraFault> CameraStream::open(const StreamOptions& options) {
  std::optional<CameraFault> fault = set_up(options);
  if (fault) close();
  return fault;
}

std::optional<CameraFault> CameraStream::set_up(const StreamOptions& options) {
  const std::string& node = options.node;
  info_ = {};
  if (const int error = device_.open(node, false)) return fault_of(SetupStage::kOpen, error, node);
  if (const int error = device_.capability(info_.device))
    return fault_of(SetupStage::kCapability, error, node);
  if (!info_.device.captures || !info_.device.streams) {
    return CameraFault{CameraReason::kNoCamera, SetupStage::kCapability, 0,
                       node +
                           " gives no images; a camera's other node holds its metadata only. "
                           "'stereod --list-cameras' shows the right one"};
  }
  FormatRequest request;
  if (auto fault = choose(options, request)) return fault;
  if (request.convert) {
    if (const int error = device_.open(node, true)) return fault_of(SetupStage::kOpen, error, node);
  }
  if (auto fault = agree_on_format(options, request)) return fault;
  double got = 0;
  if (const int error = device_.set_rate(request.fps, got))
    return fault_of(SetupStage::kSetRate, error, node);
  if (got > 0) info_.fps = got;
  return map_buffers(node);
}

std::optional<CameraFault> CameraStream::choose(const StreamOptions& options, FormatRequest& request) {
  std::vector<std::uint32_t> formats;
  if (const int error = device_.formats(formats))
    return fault_of(SetupStage::kListFormats, error, options.node);
  std::vector<OfferedFormat> offers;
  for (const std::uint32_t pixels : formats) {
    bool offered = false;
    if (const int error = device_.offers_size(pixels, options.size, offered))
      return fault_of(SetupStage::kListSizes, error, options.node);
    if (!offered) continue;
    offers.push_back({pixels, device_.rates(pixels, options.size)});
  }
  const std::vector<FormatRequest> ladder = format_ladder(offers, options.format, options.fps);
  if (ladder.empty()) return no_format(options, offers);
  info_.fallback_levels = static_cast<int>(ladder.size());
  request =
      ladder[static_cast<std::size_t>(std::clamp(options.fallback_level, 0, info_.fallback_levels - 1))];
  return std::nullopt;
}

CameraFault CameraStream::no_format(const StreamOptions& options,
                                    const std::vector<OfferedFormat>& offers) const {
  std::string sentence = options.node + " (" + info_.device.card + ") has no " + to_string(options.size) +
                         (options.format == "auto" ? "" : " as " + options.format) + "; ";
  if (offers.empty()) {
    sentence += "'stereod --list-cameras' shows the sizes it has";
  } else {
    sentence += "at that size it offers ";
    for (std::size_t i = 0; i < offers.size(); ++i) {
      const PixelFormat* format = find_pixel_format(offers[i].pixels);
      sentence += (i > 0 ? ", " : "") +
                  (format != nullptr ? std::string(format->name) : fourcc_name(offers[i].pixels));
    }
  }
  return {CameraReason::kNoFormat, SetupStage::kListSizes, 0, std::move(sentence)};
}

std::optional<CameraFault> CameraStream::agree_on_format(const StreamOptions& options,
                                                         const FormatRequest& request) {
  // What is asked for, should the answer be that the bus is full.
  info_.format = {request.pixels, options.size, 0, 0};
  info_.pixels = find_pixel_format(request.pixels);
  info_.fps = request.fps;
  info_.converted = request.convert;
  if (const int error = device_.set_format(info_.format))
    return fault_of(SetupStage::kSetFormat, error, options.node);
  if (info_.format.pixels == request.pixels && info_.format.size == options.size) return std::nullopt;
  return CameraFault{CameraReason::kOtherFormat, SetupStage::kSetFormat, 0,
                     options.node + " was asked for " + fourcc_name(request.pixels) + " " +
                         to_string(options.size) + " and gives " + fourcc_name(info_.format.pixels) + " " +
                         to_string(info_.format.size) + "; set cameras.v4l2 to what it gives"};
}

std::optional<CameraFault> CameraStream::map_buffers(const std::string& node) {
  std::uint32_t count = kDriverBuffers;
  if (const int error = device_.request_buffers(count))
    return fault_of(SetupStage::kRequestBuffers, error, node);
  if (count < 2) return fault_of(SetupStage::kRequestBuffers, ENOMEM, node);
  for (std::uint32_t i = 0; i < std::min(count, 32u); ++i) {
    std::span<const std::uint8_t> memory;
    if (const int error = device_.map_buffer(i, memory)) return fault_of(SetupStage::kMapBuffer, error, node);
    buffers_.push_back(memory);
    if (memory.size() >= least_bytes(*info_.pixels, info_.format)) continue;
    return CameraFault{CameraReason::kOtherFormat, SetupStage::kMapBuffer, 0,
                       node + ": its buffers of " + std::to_string(memory.size()) +
                           " bytes are too small for " + describe(info_)};
  }
  const std::lock_guard lock(mutex_);
  buffer_on_loan_.assign(buffers_.size(), false);
  give_back_error_ = 0;
  return std::nullopt;
}

std::optional<CameraFault> CameraStream::start(std::int64_t exposure_ns) {
  const std::string& name = info_.device.card;
  buffers_seen_ = 0;
  timestamps_.begin(info_.fps > 0 ? static_cast<std::int64_t>(1e9 / info_.fps) : 0, exposure_ns);
  {
    const std::lock_guard lock(mutex_);
    for (std::uint32_t i = 0; i < buffers_.size(); ++i) {
      if (buffer_on_loan_[i]) continue;  // queued when it is given back
      if (const int error = device_.queue(i)) return fault_of(SetupStage::kQueue, error, name);
    }
    flowing_ = true;
  }
  // A camera may take a second to start; nobody who gives a buffer back waits for that.
  if (const int error = device_.stream_on()) {
    stop();
    return fault_of(SetupStage::kStart, error, name);
  }
  return std::nullopt;
}

FrameLease CameraStream::newest(int& error, SetupStage& step) noexcept {
  error = 0;
  FilledBuffer buffer;
  std::int64_t start_ns = 0;
  if (!dequeue_newest(buffer, start_ns, error, step)) return {};
  Frame frame;
  frame.captured_ns = start_ns;
  frame.sequence = buffer.sequence;
  if (info_.pixels->work == LumaWork::kNone) return lend_in_place(buffer, frame);
  step = SetupStage::kQueue;
  return lend_image(buffer, frame, error);
}

// Empties the driver's queue and keeps the newest buffer that may be a image; the others go back.
bool CameraStream::dequeue_newest(FilledBuffer& newest, std::int64_t& start_ns, int& error,
                                  SetupStage& step) noexcept {
  const std::size_t least = least_bytes(*info_.pixels, info_.format);
  bool have = false;
  // A driver that always has one more must not keep this thread here.
  for (std::size_t i = 0; i < 2 * buffers_.size(); ++i) {
    FilledBuffer buffer;
    step = SetupStage::kDequeue;
    error = device_.dequeue(buffer);
    if (error == EAGAIN) {
      error = 0;
      break;
    }
    if (error == 0 && buffer.index >= buffers_.size()) error = EINVAL;
    if (error != 0) break;
    count_missed(buffer.sequence);
    ++buffers_seen_;
    FrameDrop drop{};
    std::int64_t this_start_ns = 0;
    const bool good = is_complete(buffer, buffers_[buffer.index].size(), least, drop) &&
                      timestamps_.start_of_exposure(buffer, system_.now_ns(), this_start_ns, drop);
    step = SetupStage::kQueue;
    if (!good) {
      count(drop);
      requeue(buffer.index, error);
    } else {
      if (have) {
        count(FrameDrop::kSuperseded);
        requeue(newest.index, error);
      }
      newest = buffer;
      start_ns = this_start_ns;
      have = true;
    }
    if (error != 0) break;
  }
  const std::lock_guard lock(mutex_);
  if (error == 0 && give_back_error_ != 0) {
    error = give_back_error_;
    step = SetupStage::kGiveBack;
  }
  return have && error == 0;
}

// A stream may begin with any number, and a driver that goes back has begun anew.
void CameraStream::count_missed(std::uint32_t sequence) noexcept {
  const auto ahead = static_cast<std::int32_t>(sequence - next_sequence_);
  if (buffers_seen_ > 0 && ahead > 0) frames_missed_ += ahead;
  next_sequence_ = sequence + 1;
}

FrameLease CameraStream::lend_in_place(const FilledBuffer& buffer, Frame frame) noexcept {
  frame.luma = luma_in_place(*info_.pixels, info_.format, buffers_[buffer.index].data());
  const std::lock_guard lock(mutex_);
  buffer_on_loan_[buffer.index] = true;
  return {frame, *this, static_cast<int>(buffer.index)};
}

FrameLease CameraStream::lend_image(const FilledBuffer& buffer, Frame frame, int& error) noexcept {
  const int place = free_image();
  FrameDrop drop = FrameDrop::kNoRoom;
  bool good = place >= 0;
  if (good) {
    GrayImage& picture = pictures_[static_cast<std::size_t>(place)];
    const std::span<const std::uint8_t> bytes = buffers_[buffer.index].first(buffer.bytes);
    if (info_.pixels->work == LumaWork::kJpeg) {
      good = jpeg_.decode(bytes, picture.view(), drop);
    } else {
      scale_y10(bytes.data(), row_stride(*info_.pixels, info_.format), picture.view());
    }
    frame.luma = {picture.row(0), picture.size(), picture.view().stride(), 1};
  }
  if (!good) count(drop);
  requeue(buffer.index, error);
  if (!good) return {};
  const std::lock_guard lock(mutex_);
  image_on_loan_[static_cast<std::size_t>(place)] = true;
  return {frame, *this, kFirstPicture + place};
}

int CameraStream::free_image() noexcept {
  const std::lock_guard lock(mutex_);
  for (int i = 0; i < kImages; ++i) {
    if (!image_on_loan_[static_cast<std::size_t>(i)]) return i;
  }
  return -1;
}

void CameraStream::requeue(std::uint32_t index, int& error) noexcept {
  if (const int failure = device_.queue(index)) error = failure;
}

void CameraStream::give_back(int buffer) noexcept {
  const std::lock_guard lock(mutex_);
  if (buffer >= kFirstPicture) {
    image_on_loan_[static_cast<std::size_t>(buffer - kFirstPicture)] = false;
    return;
  }
  buffer_on_loan_[static_cast<std::size_t>(buffer)] = false;
  if (!flowing_) return;  // start() queues it, or close() frees it
  if (const int error = device_.queue(static_cast<std::uint32_t>(buffer))) give_back_error_ = error;
}

void CameraStream::stop() noexcept {
  {
    const std::lock_guard lock(mutex_);
    if (!flowing_) return;
    flowing_ = false;
    give_back_error_ = 0;
  }
  device_.stream_off();  // a driver that cannot do that is closed next, which stops it
}

bool CameraStream::on_loan() noexcept {
  const std::lock_guard lock(mutex_);
  return std::find(buffer_on_loan_.begin(), buffer_on_loan_.end(), true) != buffer_on_loan_.end();
}

void CameraStream::close() noexcept {
  for (const std::span<const std::uint8_t> memory : buffers_) device_.unmap_buffer(memory);
  buffers_.clear();
  const std::lock_guard lock(mutex_);
  buffer_on_loan_.clear();
  device_.close();
}

DropCounts CameraStream::drops() const noexcept {
  const std::lock_guard lock(mutex_);
  return drops_;
}

void CameraStream::count(FrameDrop drop) noexcept {
  const std::lock_guard lock(mutex_);
  ++drops_[drop];
  if (is_damage(drop)) last_damage_ = drop;
}

}  // namespace stereod
