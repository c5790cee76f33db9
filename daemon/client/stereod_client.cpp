// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/client/stereod_client.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace stereod {
namespace {

/// Returns a regular expression, as LCM subscribes to, that matches only @p channel.
std::string literal_pattern(const std::string& channel) {
  std::string pattern;
  for (const char c : channel) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    if (!plain) pattern += '\\';
    pattern += c;
  }
  return pattern;
}

/// Returns the URL in effect with a receive buffer of at most what the kernel allows; a larger one makes LCM complain.
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

struct StereoClient::Subscription {
  StereoClient& client;
  Receiver receive;
  lcm_subscription_t* handle = nullptr;
};

void StereoClient::LcmCloser::operator()(lcm_t* lcm) const noexcept { lcm_destroy(lcm); }

StereoClient::StereoClient() : assembler_([this](StereoFrame&& frame) { hand_over(std::move(frame)); }) {}

StereoClient::StereoClient(const Options& options) : StereoClient() {
  const std::string url = url_with_buffer(options);
  owned_.reset(lcm_create(url.c_str()));
  if (!owned_) {
    throw std::runtime_error("cannot open LCM with the URL '" + url +
                             "': use PROVIDER://NETWORK, and check the route to its multicast group");
  }
  lcm_ = owned_.get();
  latest_only_ = options.latest_only;
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
  const std::pair<const char*, Receiver> channels[] = {{"_DISPARITY", &StereoClient::take_rows},
                                                       {"_FRAME", &StereoClient::take_frame},
                                                       {"_CAMERA_INFO", &StereoClient::take_camera_info}};
  for (const auto& [suffix, receive] : channels) {
    const std::string channel = prefix + suffix;
    auto subscription = std::make_unique<Subscription>(Subscription{*this, receive});
    if (prefix.empty() || channel.size() > LCM_MAX_CHANNEL_NAME_LENGTH) {
      throw std::runtime_error("invalid LCM channel '" + channel +
                               "': a prefix is needed, and a name has at most 63 characters");
    }
    subscription->handle =
        lcm_subscribe(lcm_, literal_pattern(channel).c_str(), &StereoClient::on_message, subscription.get());
    if (subscription->handle == nullptr || lcm_get_fileno(lcm_) < 0) {
      throw std::runtime_error("cannot receive LCM channel '" + channel +
                               "': check that multicast of this machine is looped back to it");
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
    (client.*target.receive)(message->data, message->data_size);
  } catch (...) {  // LCM is C: no exception may pass through it
    if (!client.owned_) std::terminate();
    client.error_ = std::current_exception();
  }
}

bool StereoClient::handle(int timeout_ms) {
  constexpr int kMaxMessages = 10'000;  // a consumer that cannot keep up still gets frames
  int result = lcm_handle_timeout(lcm_, timeout_ms);
  const bool any = result > 0;
  for (int i = 0; i < kMaxMessages && result > 0 && !error_; ++i) result = lcm_handle_timeout(lcm_, 0);
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  if (waiting_ && on_frame_) {
    StereoFrame frame = std::move(*waiting_);
    waiting_.reset();
    on_frame_(std::move(frame));
  }
  if (result < 0 && !any) throw std::runtime_error("LCM delivers no more messages");
  return any;
}

int StereoClient::file_descriptor() const { return lcm_get_fileno(lcm_); }

void StereoClient::hand_over(StereoFrame&& frame) {
  frame.camera = camera_;
  if (latest_only_) {
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
