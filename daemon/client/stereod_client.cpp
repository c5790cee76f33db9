#include "daemon/client/stereod_client.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace stereod {
namespace {

constexpr int kSubpixels = 16;       // units in a pixel, if they are not whole pixels
constexpr int kMaxSide = 4096;       // px; no message can ask for gigabytes
constexpr int kMaxDisparity = 4096;  // px
constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

// Numbers further away than these are another numbering, not a loss. At 30 frames a second: 3 s without
// reception, half a second of lateness.
constexpr std::int64_t kMaxForward = 100;
constexpr double kMaxPeriod_us = 60e6;  // of frames
constexpr std::int64_t kMaxBackward = 16;
constexpr int kMessagesToFollow = 3;

bool is_image_size(int width, int height) {
  return width >= 1 && width <= kMaxSide && height >= 1 && height <= kMaxSide;
}

/// Fixed-point units in a pixel for a scale in pixels per unit; 0 if the wire format does not have it.
int units_of(float scale) {
  if (scale == 1.0F) return 1;
  return scale == 1.0F / kSubpixels ? kSubpixels : 0;
}

StereoFrame empty_frame(std::int64_t frame, std::int64_t utime, int width, int height) {
  StereoFrame result;
  result.frame = frame;
  result.utime = utime;
  result.disparity = DisparityMap(width, height);
  result.row_present.assign(static_cast<std::size_t>(height), false);
  result.rows_expected = height;
  return result;
}

bool same_search(const StereoFrame& frame, const disparity_rows_t& m) {
  return frame.units_per_pixel == units_of(m.scale) && frame.min_disparity == m.min_disparity &&
         frame.disparities == m.disparities && frame.grid == RowBlock(m).grid();
}

/// `count` columns or rows, `step` apart from `first` on, all within an image that can be.
bool is_sane_axis(int first, int step, int count) {
  return first >= 0 && first < kMaxSide && step >= 1 && step <= kMaxSide &&
         first + (count - 1) * step < kMaxSide;
}

/// Puts the row's filled disparities beside its measured ones.
void copy_filled_row(const RowBlock& block, int y, StereoFrame& out) {
  if (out.filled.width() == 0) out.filled = DisparityMap(out.disparity.width(), out.disparity.height());
  for (int x = 0; x < out.filled.width(); ++x) {
    if (block.is_filled(x, y)) out.filled.row(y)[x] = block.at(x, y, Pixels::kMeasuredOrFilled);
  }
}

/// Rows received, of those that were published.
void limit_received(StereoFrame& frame) {
  frame.rows_received = std::min(frame.rows_received, frame.rows_expected);
}

}  // namespace

bool is_valid(const disparity_rows_t& m) {
  if (m.frame < 0 || m.utime < 0 || !is_image_size(m.width, m.height)) return false;
  if (m.first_row < 0 || m.row_count < 1 || m.row_count > m.height || m.first_row > m.height - m.row_count) {
    return false;
  }
  if (!is_sane_axis(m.left, m.decimation_x, m.width) || !is_sane_axis(m.top, m.decimation_y, m.height)) {
    return false;
  }
  if (m.min_disparity < 0 || m.min_disparity > kMaxDisparity) return false;
  if (m.disparities < 1 || m.disparities > kMaxDisparity || units_of(m.scale) == 0) return false;
  if (m.bytes_per_value != 1 && m.bytes_per_value != 2) return false;
  if (m.invalid < 0 || m.invalid > (m.bytes_per_value == 1 ? 0xFF : 0xFFFF)) return false;
  const int filled_size = (m.width + 7) / 8 * m.row_count;
  // If there are none, what lcm-gen makes leaves those of the message decoded before.
  if (m.filled_size != 0 &&
      (m.filled_size != filled_size || m.filled.size() != static_cast<std::size_t>(m.filled_size))) {
    return false;
  }
  const int pixels = m.width * m.row_count;  // at most 2^24
  if (m.confidence_size != 0 &&
      (m.confidence_size != pixels || m.confidence.size() != static_cast<std::size_t>(pixels))) {
    return false;
  }
  if (m.encoding != 0) return false;
  const int expected_size = pixels * m.bytes_per_value;
  return m.size == expected_size && m.data.size() == static_cast<std::size_t>(m.size);
}

bool is_valid(const frame_t& m) {
  const auto is_fraction = [](float value) { return value >= 0.0F && value <= 1.0F; };
  return m.frame >= 0 && m.utime >= 0 && is_image_size(m.width, m.height) && m.rows >= 1 &&
         m.rows <= m.height && m.messages >= 0 && is_fraction(m.measured_fraction) &&
         is_fraction(m.filled_fraction) &&
         (m.no_evidence_fraction == -1.0F || is_fraction(m.no_evidence_fraction));
}

double CameraGeometry::depth_m(double disparity_px) const {
  const double shift = disparity_px + disparity_offset;
  return shift > 0 ? fx * baseline_m / shift : std::numeric_limits<double>::infinity();
}

StereoPoint CameraGeometry::point(double x, double y, double disparity_px) const {
  const double z = depth_m(disparity_px);
  return {static_cast<float>((x - cx) * z / fx), static_cast<float>((y - cy) * z / fy),
          static_cast<float>(z)};
}

std::optional<CameraGeometry> geometry_of(const camera_info_t& m) {
  const bool finite = std::isfinite(m.fx) && std::isfinite(m.fy) && std::isfinite(m.cx) &&
                      std::isfinite(m.cy) && std::isfinite(m.baseline_m) && std::isfinite(m.disparity_offset);
  if (m.calibrated == 0 || !finite || m.fx <= 0 || m.fy <= 0 || m.baseline_m <= 0) return std::nullopt;
  return CameraGeometry{m.fx, m.fy, m.cx, m.cy, m.baseline_m, m.disparity_offset};
}

float StereoFrame::disparity_px(int x, int y, Pixels pixels) const {
  std::int16_t value = disparity.at(x, y);
  if (value == DisparityMap::kNone && pixels == Pixels::kMeasuredOrFilled && filled.width() > 0) {
    value = filled.at(x, y);
  }
  return value == DisparityMap::kNone ? kNoNumber
                                      : static_cast<float>(value) / static_cast<float>(units_per_pixel);
}

float StereoFrame::depth_m(int x, int y, Pixels pixels) const {
  const float px = disparity_px(x, y, pixels);
  if (std::isnan(px) || !camera) return kNoNumber;
  return static_cast<float>(camera->depth_m(static_cast<double>(px)));
}

StereoPoint StereoFrame::point(int x, int y, Pixels pixels) const {
  const float z = depth_m(x, y, pixels);
  if (!std::isfinite(z)) return {kNoNumber, kNoNumber, kNoNumber};
  return camera->point(grid.image_x(x), grid.image_y(y), static_cast<double>(disparity_px(x, y, pixels)));
}

std::vector<float> StereoFrame::depths_m(Pixels pixels) const {
  std::vector<float> depths;
  depths.reserve(static_cast<std::size_t>(disparity.width()) * static_cast<std::size_t>(disparity.height()));
  for (int y = 0; y < disparity.height(); ++y) {
    for (int x = 0; x < disparity.width(); ++x) depths.push_back(depth_m(x, y, pixels));
  }
  return depths;
}

std::vector<StereoPoint> StereoFrame::points(int step, Pixels pixels) const {
  std::vector<StereoPoint> points;
  for (int y = 0; y < disparity.height(); y += step) {
    for (int x = 0; x < disparity.width(); x += step) {
      const StereoPoint candidate = point(x, y, pixels);
      if (std::isfinite(candidate.z)) points.push_back(candidate);
    }
  }
  return points;
}

bool RowBlock::is_filled(int x, int y) const {
  if (!has_filled()) return false;
  const auto row_bytes = static_cast<std::size_t>((message_.width + 7) / 8);
  const std::size_t index =
      static_cast<std::size_t>(y - message_.first_row) * row_bytes + static_cast<std::size_t>(x / 8);
  return (message_.filled[index] >> (x % 8) & 1) != 0;
}

std::int16_t RowBlock::at(int x, int y, Pixels pixels) const {
  if (pixels == Pixels::kMeasured && is_filled(x, y)) return DisparityMap::kNone;
  const auto index =
      static_cast<std::size_t>(y - message_.first_row) * static_cast<std::size_t>(message_.width) +
      static_cast<std::size_t>(x);
  const std::uint8_t* in = message_.data.data() + index * static_cast<std::size_t>(message_.bytes_per_value);
  const int value = message_.bytes_per_value == 1 ? in[0] : in[0] | in[1] << 8;
  // What 16 bits with a sign cannot hold is no disparity either.
  const bool valid = value != message_.invalid && value <= std::numeric_limits<std::int16_t>::max();
  return valid ? static_cast<std::int16_t>(value) : DisparityMap::kNone;
}

void RowBlock::copy_row(int y, std::int16_t* out, Pixels pixels) const {
  for (int x = 0; x < message_.width; ++x) out[x] = at(x, y, pixels);
}

std::string describe_problems(const ReceptionCounts& counts) {
  std::string words;
  const auto add = [&words](const std::string& sentence) { words += (words.empty() ? "" : " ") + sentence; };
  if (counts.restarts >= 3) {
    add("The numbering of frames began anew " + std::to_string(counts.restarts) +
        " times: either stereod keeps restarting, or two of them publish on the same channels; give each its "
        "own "
        "lcm.prefix.");
  }
  if (counts.messages_of_another > 0) {
    add(std::to_string(counts.messages_of_another) +
        " messages were about other frames of the same numbers: another stereod publishes on the same "
        "channels; "
        "give each its own lcm.prefix.");
  }
  if (const auto others = counts.messages_ignored - counts.messages_of_another; others > 0) {
    add(std::to_string(others) +
        " messages were no messages of this stereod: another program, or a stereod of another version, "
        "publishes "
        "on its channels.");
  }
  if (counts.rows_lost > 0 || counts.frames_missing > 0) {
    add(std::to_string(counts.rows_lost) + " of " + std::to_string(counts.rows_expected) +
        " rows were lost: the program is slower than the stream, or the kernel's receive buffer is small "
        "(net.core.rmem_max).");
  }
  return words;
}

void FrameAssembler::take(const disparity_rows_t& m) {
  if (!is_valid(m)) return count_ignored();
  Slot* slot = slot_for(m.frame, m.utime, m.width, m.height);
  if (slot == nullptr) return;
  if (slot->state == State::kHandedOver) {
    const auto first = slot->out.row_present.begin() + m.first_row;
    const auto known = std::count(first, first + m.row_count, true);
    counts_.rows_duplicate += known;
    if (known < m.row_count) ++counts_.messages_late;
    return;
  }
  StereoFrame& out = slot->out;
  if (!std::exchange(slot->has_rows, true)) {
    out.units_per_pixel = units_of(m.scale);
    out.min_disparity = m.min_disparity;
    out.disparities = m.disparities;
    out.grid = RowBlock(m).grid();
  } else if (!same_search(out, m)) {
    return count_ignored();
  }
  const RowBlock block(m);
  for (int row = 0; row < m.row_count; ++row) {
    const int y = m.first_row + row;
    if (out.row_present[static_cast<std::size_t>(y)]) {
      ++counts_.rows_duplicate;
      continue;
    }
    out.row_present[static_cast<std::size_t>(y)] = true;
    ++out.rows_received;
    block.copy_row(y, out.disparity.row(y));
    if (block.has_filled()) copy_filled_row(block, y, out);
  }
  limit_received(out);
  if (out.complete()) complete(*slot);
}

void FrameAssembler::take(const frame_t& m) {
  if (!is_valid(m)) return count_ignored();
  Slot* slot = slot_for(m.frame, m.utime, m.width, m.height);
  if (slot == nullptr) return;
  if (slot->state == State::kHandedOver || slot->out.summary) return;
  slot->out.summary = m;
  slot->out.rows_expected = m.rows;
  limit_received(slot->out);
  if (slot->out.complete()) complete(*slot);
}

void FrameAssembler::finish() {
  if (!started_) return;
  for (std::int64_t frame = oldest_open_; frame < newest_; ++frame) settle(frame, false);
  settle(newest_, true);
  started_ = false;
  jump_messages_ = 0;
}

/// The slot of a frame that is still open or was just handed over; nullptr (and a count) if the message is to
/// be passed over.
FrameAssembler::Slot* FrameAssembler::slot_for(std::int64_t frame, std::int64_t utime, int width,
                                               int height) {
  if (!started_) {
    begin_numbering(frame);
  } else if (!belongs_to_numbering(frame, utime)) {
    if (!follow_jump(frame)) {
      count_ignored();
      return nullptr;
    }
  } else {
    jump_messages_ = 0;
  }
  if (frame > newest_) advance_to(frame);
  // The first frame heard may have been overtaken by the one after it.
  if (frame == newest_ - 1 && oldest_open_ == joined_ && joined_ == newest_) oldest_open_ = joined_ = frame;
  if (frame < oldest_open_) {
    ++counts_.messages_late;
    return nullptr;
  }
  Slot& slot = this->slot(frame);
  if (slot.state == State::kAbsent) {
    slot.out = empty_frame(frame, utime, width, height);
    slot.has_rows = false;
    slot.state = State::kOpen;
    height_ = height;
    if (frame == newest_) newest_utime_ = utime;
  } else if (slot.out.utime != utime || slot.out.row_present.size() != static_cast<std::size_t>(height) ||
             (slot.state == State::kOpen && slot.out.disparity.width() != width)) {
    count_ignored();
    ++counts_.messages_of_another;
    return nullptr;
  }
  return &slot;
}

/// Whether a message continues the numbering. A lower number with a later exposure is a daemon that began
/// anew.
bool FrameAssembler::belongs_to_numbering(std::int64_t frame, std::int64_t utime) const {
  if (frame == newest_) return true;
  if (frame > newest_) {
    const double step = static_cast<double>(frame - newest_);
    const double time_us = static_cast<double>(utime) - static_cast<double>(newest_utime_);
    return step <= kMaxForward && (newest_utime_ == 0 || (time_us >= 0 && time_us <= step * kMaxPeriod_us));
  }
  return newest_ - frame <= kMaxBackward && utime <= newest_utime_;
}

/// Counts messages that agree on another numbering; true when there are enough of them to go over to it.
bool FrameAssembler::follow_jump(std::int64_t frame) {
  const std::int64_t step = frame - jump_frame_;  // neither is negative
  const bool agrees = jump_messages_ > 0 && step >= -1 && step <= kMaxBackward;
  jump_messages_ = agrees ? jump_messages_ + 1 : 1;
  jump_frame_ = frame;
  if (jump_messages_ < kMessagesToFollow) return false;
  finish();
  ++counts_.restarts;
  begin_numbering(frame);
  return true;
}

void FrameAssembler::begin_numbering(std::int64_t frame) {
  started_ = true;
  joined_ = oldest_open_ = newest_ = frame;
  newest_utime_ = 0;
  jump_messages_ = 0;
}

void FrameAssembler::advance_to(std::int64_t frame) {
  while (oldest_open_ < frame - 1) settle(oldest_open_++, false);
  newest_ = frame;
}

/// Closes a frame's books and frees its slot. `last`: the listening ends with it.
void FrameAssembler::settle(std::int64_t frame, bool last) {
  Slot& slot = this->slot(frame);
  const bool here = slot.state != State::kAbsent && slot.out.frame == frame;
  if (!here) {
    ++counts_.frames_expected;
    ++counts_.frames_missing;
    counts_.rows_expected += height_;
    counts_.rows_lost += height_;
    return;
  }
  if (slot.out.complete() || !(last || frame == joined_)) count_settled(slot);
  if (slot.state == State::kOpen) hand_over(slot);
  slot.state = State::kAbsent;
}

void FrameAssembler::count_settled(const Slot& slot) {
  ++counts_.frames_expected;
  ++(slot.out.complete() ? counts_.frames_complete : counts_.frames_incomplete);
  counts_.rows_expected += slot.out.rows_expected;
  counts_.rows_received += slot.out.rows_received;
  counts_.rows_lost += slot.out.rows_expected - slot.out.rows_received;
}

/// The newest frame makes the one before it final.
void FrameAssembler::complete(Slot& slot) {
  const std::int64_t before = slot.out.frame - 1;
  Slot& other = this->slot(before);
  if (other.state == State::kOpen && other.out.frame == before) hand_over(other);
  hand_over(slot);
}

/// Gives the frame away, but keeps what is needed to know its duplicates and to count it.
void FrameAssembler::hand_over(Slot& slot) {
  StereoFrame kept;
  kept.frame = slot.out.frame;
  kept.utime = slot.out.utime;
  kept.row_present = slot.out.row_present;
  kept.rows_expected = slot.out.rows_expected;
  kept.rows_received = slot.out.rows_received;
  kept.summary = slot.out.summary;
  slot.state = State::kHandedOver;
  StereoFrame handed = std::exchange(slot.out, std::move(kept));
  handler_(std::move(handed));
}

namespace {

constexpr std::size_t kFingerprintBytes = 8;
constexpr std::size_t kMaxMessage = 1U << 28;  // LCM's own limit

/// What is left of a message while it is walked through.
struct Rest {
  const std::uint8_t* bytes;
  std::size_t size;

  bool skip(std::size_t count) {
    if (count > size) return false;
    bytes += count;
    size -= count;
    return true;
  }
  /// Takes a big-endian length off the front; false if it is not there or absurd.
  bool take_length(std::size_t& length) {
    if (size < 4) return false;
    length =
        std::size_t{bytes[0]} << 24 | std::size_t{bytes[1]} << 16 | std::size_t{bytes[2]} << 8 | bytes[3];
    return skip(4) && length <= kMaxMessage;
  }
  bool skip_string() {
    std::size_t length = 0;
    return take_length(length) && length > 0 && length <= size && bytes[length - 1] == 0 && skip(length);
  }
  bool skip_array(std::size_t bytes_each) {
    std::size_t length = 0;
    return take_length(length) && skip(length * bytes_each);
  }
  bool skip_field(char kind) {
    switch (kind) {
      case 'b':
        return skip(1);
      case 'i':
        return skip(4);
      case 'd':
        return skip(8);
      case 's':
        return skip_string();
      case 'v':
        return skip_array(1);
      case 'f':
        return skip_array(4);
      case 'z':
        return size >= 4 && std::all_of(bytes, bytes + 4, [](std::uint8_t b) { return b == 0; }) && skip(4);
      default:
        return false;
    }
  }
};

/// LCM takes channels as regular expressions; this one means the name and nothing else.
std::string literal_pattern(const std::string& channel) {
  std::string pattern;
  for (const char c : channel) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    if (!plain) pattern += '\\';
    pattern += c;
  }
  return pattern;
}

/// The URL that counts, with a receive buffer as large as the kernel allows: more makes LCM complain.
std::string url_with_buffer(const StereoClient::Options& options) {
  std::string url = options.url;
  if (url.empty()) {
    const char* from_environment = std::getenv("LCM_DEFAULT_URL");
    url = from_environment != nullptr && *from_environment != '\0' ? from_environment
                                                                   : "udpm://239.255.76.67:7667?ttl=0";
  }
  if (url.compare(0, 7, "udpm://") != 0 || url.find("recv_buf_size") != std::string::npos) return url;
  int limit = options.receive_buffer;
  std::ifstream("/proc/sys/net/core/rmem_max") >> limit;
  const int bytes = limit > 0 ? std::min(limit, options.receive_buffer) : options.receive_buffer;
  return url + (url.find('?') == std::string::npos ? '?' : '&') + "recv_buf_size=" + std::to_string(bytes);
}

}  // namespace

bool has_layout(const void* bytes, std::size_t size, std::string_view layout) noexcept {
  Rest rest{static_cast<const std::uint8_t*>(bytes), size};
  if (size > kMaxMessage || !rest.skip(kFingerprintBytes)) return false;
  for (const char kind : layout) {
    if (!rest.skip_field(kind)) return false;
  }
  return rest.size == 0;
}

struct StereoClient::Subscription {
  StereoClient& client;
  Taker take;
  lcm_subscription_t* handle = nullptr;
};

void StereoClient::LcmCloser::operator()(lcm_t* lcm) const noexcept { lcm_destroy(lcm); }

StereoClient::StereoClient() : assembler_([this](StereoFrame&& frame) { hand_over(std::move(frame)); }) {}

StereoClient::StereoClient(const Options& options) : StereoClient() {
  const std::string url = url_with_buffer(options);
  owned_.reset(lcm_create(url.c_str()));
  if (!owned_) {
    throw std::runtime_error("LCM cannot be opened with the URL '" + url +
                             "': is it PROVIDER://NETWORK, and does a route lead to its multicast group?");
  }
  lcm_ = owned_.get();
  newest_frame_only_ = options.latest_only;
  subscribe(options.prefix, options.queue_messages);
}

StereoClient::StereoClient(lcm_t* lcm, const std::string& prefix) : StereoClient() {
  lcm_ = lcm;
  subscribe(prefix, Options().queue_messages);
}

StereoClient::~StereoClient() {
  for (const auto& subscription : subscriptions_) lcm_unsubscribe(lcm_, subscription->handle);
}

std::unique_ptr<StereoClient> StereoClient::unconnected() {
  return std::unique_ptr<StereoClient>(new StereoClient);
}

void StereoClient::subscribe(const std::string& prefix, int queue_messages) {
  const std::pair<const char*, Taker> channels[] = {{"_DISPARITY", &StereoClient::take_rows},
                                                    {"_FRAME", &StereoClient::take_frame},
                                                    {"_CAMERA_INFO", &StereoClient::take_camera_info}};
  for (const auto& [ending, take] : channels) {
    const std::string channel = prefix + ending;
    auto subscription = std::make_unique<Subscription>(Subscription{*this, take});
    if (prefix.empty() || channel.size() > LCM_MAX_CHANNEL_NAME_LENGTH) {
      throw std::runtime_error("LCM has no channel '" + channel + "': a name has up to 63 characters.");
    }
    subscription->handle =
        lcm_subscribe(lcm_, literal_pattern(channel).c_str(), &StereoClient::on_message, subscription.get());
    if (subscription->handle == nullptr || lcm_get_fileno(lcm_) < 0) {
      throw std::runtime_error("LCM cannot receive '" + channel +
                               "': does what this machine sends to the multicast group come back to it?");
    }
    lcm_subscription_set_queue_capacity(subscription->handle, queue_messages);
    subscriptions_.push_back(std::move(subscription));
  }
}

void StereoClient::on_message(const lcm_recv_buf_t* message, const char* /*channel*/, void* subscription) {
  const Subscription& target = *static_cast<const Subscription*>(subscription);
  StereoClient& client = target.client;
  if (client.error_) return;
  try {
    (client.*target.take)(message->data, message->data_size);
  } catch (...) {  // LCM is C: no exception may pass through it
    if (!client.owned_) std::terminate();
    client.error_ = std::current_exception();
  }
}

bool StereoClient::handle(int timeout_ms) {
  constexpr int kAtOnce = 10'000;  // messages; whoever cannot keep up still gets its frames
  int result = lcm_handle_timeout(lcm_, timeout_ms);
  const bool any = result > 0;
  for (int i = 0; i < kAtOnce && result > 0 && !error_; ++i) result = lcm_handle_timeout(lcm_, 0);
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  if (waiting_ && on_frame_) {
    StereoFrame frame = std::move(*waiting_);
    waiting_.reset();
    on_frame_(std::move(frame));
  }
  if (result < 0 && !any) throw std::runtime_error("LCM delivers nothing more.");
  return any;
}

int StereoClient::file_descriptor() const { return lcm_get_fileno(lcm_); }

void StereoClient::hand_over(StereoFrame&& frame) {
  frame.camera = camera_;
  if (newest_frame_only_) {
    if (waiting_) ++frames_skipped_;
    waiting_ = std::move(frame);
  } else if (on_frame_) {
    on_frame_(std::move(frame));
  }
}

void StereoClient::take_rows(const void* bytes, std::size_t size) {
  if (!decode_message(bytes, size, rows_) || !is_valid(rows_)) return assembler_.count_ignored();
  if (on_rows_) on_rows_(RowBlock(rows_));
  assembler_.take(rows_);
}

void StereoClient::take_frame(const void* bytes, std::size_t size) {
  frame_t summary{};
  if (!decode_message(bytes, size, summary)) return assembler_.count_ignored();
  assembler_.take(summary);
}

void StereoClient::take_camera_info(const void* bytes, std::size_t size) {
  camera_info_t info{};
  if (!decode_message(bytes, size, info)) return assembler_.count_ignored();
  camera_ = geometry_of(info);
  if (on_camera_info_) on_camera_info_(info);
}

}  // namespace stereod
