// SPDX-License-Identifier: BSD-3-Clause
// Buffers: mapped, queued, dequeued, lent, given back.
#include "daemon/capture/v4l2/camera_stream.h"

#include <algorithm>
#include <cerrno>

namespace stereod::v4l2 {
namespace {

// Buffer numbers of a lease: the driver's buffers from 0 on, the images of the pool from here on.
constexpr int kFirstImage = 1000;

}  // namespace

CameraStream::CameraStream(VideoSystem& system, Size size)
    : system_(system), device_(system), images_(size) {}

CameraStream::~CameraStream() {
  stop();
  close();
}

std::optional<CameraFault> CameraStream::open(const StreamOptions& options) {
  std::optional<CameraFault> fault = set_up_device(device_, options, info_);
  if (!fault) fault = map_buffers(options.node);
  if (fault) close();
  return fault;
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
    if (memory.size() >= min_buffer_bytes(*info_.pixel_format, info_.format)) continue;
    return CameraFault{CameraReason::kOtherFormat, SetupStage::kMapBuffer, 0,
                       node + ": buffers of " + std::to_string(memory.size()) + " bytes are too small for " +
                           describe(info_)};
  }
  const std::lock_guard lock(mutex_);
  buffer_on_loan_.assign(buffers_.size(), false);
  give_back_error_ = 0;
  return std::nullopt;
}

std::optional<CameraFault> CameraStream::start(std::int64_t exposure_ns) {
  const std::string& name = info_.device.card;
  buffers_seen_ = 0;
  buffers_since_frame_ = 0;
  timestamps_.reset(frame_time_ns(), exposure_ns);
  {
    const std::lock_guard lock(mutex_);
    for (std::uint32_t i = 0; i < buffers_.size(); ++i) {
      if (buffer_on_loan_[i]) continue;  // give_back() queues it
      if (const int error = device_.queue(i)) return fault_of(SetupStage::kQueue, error, name);
    }
    started_ = true;
  }
  // Outside the lock: a camera may take a second to start, and give_back() must not wait for it.
  if (const int error = device_.stream_on()) {
    stop();
    return fault_of(SetupStage::kStart, error, name);
  }
  return std::nullopt;
}

FrameLease CameraStream::newest(int& error, SetupStage& stage) noexcept {
  error = 0;
  FilledBuffer buffer;
  std::int64_t start_ns = 0;
  if (!dequeue_newest(buffer, start_ns, error, stage)) return {};
  Frame frame;
  frame.captured_ns = start_ns;
  frame.sequence = buffer.sequence;
  stage = SetupStage::kQueue;
  const bool in_place = info_.pixel_format->work == LumaWork::kNone;
  FrameLease lease = in_place ? lend_in_place(buffer, frame) : lend_decoded(buffer, frame, error);
  if (lease) buffers_since_frame_ = 0;
  return lease;
}

// Empties the driver's queue and keeps the newest usable buffer; the others are requeued.
bool CameraStream::dequeue_newest(FilledBuffer& newest, std::int64_t& start_ns, int& error,
                                  SetupStage& stage) noexcept {
  const std::size_t min_bytes = min_buffer_bytes(*info_.pixel_format, info_.format);
  bool found = false;
  // The limit is for a driver whose queue never becomes empty.
  for (std::size_t i = 0; i < 2 * buffers_.size(); ++i) {
    FilledBuffer buffer;
    stage = SetupStage::kDequeue;
    error = device_.dequeue(buffer);
    if (error == EAGAIN) {
      error = 0;
      break;
    }
    if (error == 0 && buffer.index >= buffers_.size()) error = EINVAL;
    if (error != 0) break;
    count_missed(buffer.sequence);
    ++buffers_seen_;
    ++buffers_since_frame_;
    FrameDrop drop{};
    std::int64_t this_start_ns = 0;
    const bool usable = is_complete(buffer, buffers_[buffer.index].size(), min_bytes, drop) &&
                        timestamps_.start_of_exposure(buffer, system_.now_ns(), this_start_ns, drop);
    stage = SetupStage::kQueue;
    if (!usable) {
      count(drop);
      requeue(buffer.index, error);
    } else {
      if (found) {
        count(FrameDrop::kSuperseded);
        requeue(newest.index, error);
      }
      newest = buffer;
      start_ns = this_start_ns;
      found = true;
    }
    if (error != 0) break;
  }
  const std::lock_guard lock(mutex_);
  if (error == 0 && give_back_error_ != 0) {
    error = give_back_error_;
    stage = SetupStage::kGiveBack;
  }
  return found && error == 0;
}

// A stream may begin with any number. A number that goes back means that the driver started to count again.
void CameraStream::count_missed(std::uint32_t sequence) noexcept {
  const auto ahead = static_cast<std::int32_t>(sequence - next_sequence_);
  if (buffers_seen_ > 0 && ahead > 0) frames_missed_ += ahead;
  next_sequence_ = sequence + 1;
}

FrameLease CameraStream::lend_in_place(const FilledBuffer& buffer, Frame frame) noexcept {
  frame.luma = luma_in_place(*info_.pixel_format, info_.format, buffers_[buffer.index].data());
  const std::lock_guard lock(mutex_);
  buffer_on_loan_[buffer.index] = true;
  return {frame, *this, static_cast<int>(buffer.index)};
}

FrameLease CameraStream::lend_decoded(const FilledBuffer& buffer, Frame frame, int& error) noexcept {
  const int index = images_.find_free();
  FrameDrop drop = FrameDrop::kNoRoom;
  bool decoded = index >= 0;
  if (decoded) {
    GrayImage& image = images_.image(index);
    const std::span<const std::uint8_t> bytes = buffers_[buffer.index].first(buffer.bytes);
    if (info_.pixel_format->work == LumaWork::kJpeg) {
      decoded = jpeg_.decode(bytes, image.view(), drop);
    } else {
      scale_y10(bytes.data(), row_stride(*info_.pixel_format, info_.format), image.view());
    }
    frame.luma = {image.row(0), image.size(), image.view().stride(), 1};
  }
  if (!decoded) count(drop);
  requeue(buffer.index, error);
  if (!decoded) return {};
  images_.lend(index);
  return {frame, *this, kFirstImage + index};
}

void CameraStream::requeue(std::uint32_t index, int& error) noexcept {
  if (const int failure = device_.queue(index)) error = failure;
}

void CameraStream::give_back(int buffer) noexcept {
  if (buffer >= kFirstImage) return images_.give_back(buffer - kFirstImage);
  const std::lock_guard lock(mutex_);
  buffer_on_loan_[static_cast<std::size_t>(buffer)] = false;
  if (!started_) return;  // start() queues it, or close() unmaps it
  if (const int error = device_.queue(static_cast<std::uint32_t>(buffer))) give_back_error_ = error;
}

void CameraStream::stop() noexcept {
  {
    const std::lock_guard lock(mutex_);
    if (!started_) return;
    started_ = false;
    give_back_error_ = 0;
  }
  device_.stream_off();  // on failure the stream is closed next, which stops it too
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

}  // namespace stereod::v4l2
