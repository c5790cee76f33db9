// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/lcm/receiver.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <utility>

namespace stereod {
namespace {

// A smaller buffer may lose rows of a 640×480 frame that arrives while the program is busy [bytes].
constexpr int kMinReceiveBuffer = 2 << 20;

/// Returns a regular expression, as LCM takes for channels, that matches this name only.
std::string literal_pattern(const std::string& channel) {
  std::string pattern;
  for (const char c : channel) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    if (!plain) pattern += '\\';
    pattern += c;
  }
  return pattern;
}

}  // namespace

LcmReceiver::LcmReceiver(const std::string& url)
    : url_(with_receive_buffer(checked_lcm_url(url), kReceiveBuffer, kernel_receive_buffer_limit())),
      lcm_(open_lcm(url_)) {}

void LcmReceiver::subscribe(const std::string& channel, Handler handler) {
  if (channel.empty() || channel.size() > LCM_MAX_CHANNEL_NAME_LENGTH) {
    throw BusError(
        "channel '" + channel + "': found " + std::to_string(channel.size()) + " characters, allowed 1…63",
        true);
  }
  subscribe_pattern(literal_pattern(channel),
                    [handler = std::move(handler)](std::string_view, std::int64_t,
                                                   std::span<const std::byte> data) { handler(data); });
}

void LcmReceiver::subscribe_all(const std::string& prefix, AnyHandler handler) {
  subscribe_pattern(literal_pattern(prefix) + "_.*", std::move(handler));
}

void LcmReceiver::subscribe_pattern(const std::string& pattern, AnyHandler handler) {
  subscriptions_.push_back(std::make_unique<Subscription>(Subscription{std::move(handler), nullptr}));
  lcm_subscription_t* subscription =
      lcm_subscribe(lcm_.get(), pattern.c_str(), &on_message, subscriptions_.back().get());
  if (subscription == nullptr || lcm_get_fileno(lcm_.get()) < 0) {
    throw BusError("LCM cannot receive on " + url() +
                       ": multicast sent by this machine does not come back; check its routes ('ip route get "
                       "239.255.76.67') and its firewall",
                   false);
  }
  lcm_subscription_set_queue_capacity(subscription, kQueueCapacity);
}

bool LcmReceiver::receive(std::chrono::milliseconds timeout) {
  const int result = lcm_handle_timeout(lcm_.get(), static_cast<int>(timeout.count()));
  for (const auto& subscription : subscriptions_) {
    if (subscription->error) std::rethrow_exception(std::exchange(subscription->error, nullptr));
  }
  if (result < 0) throw BusError("LCM delivers no more messages from " + url(), false);
  return result > 0;
}

// LCM is C code, so no exception may pass through it; receive() rethrows it.
void LcmReceiver::on_message(const lcm_recv_buf_t* message, const char* channel,
                             void* subscription) noexcept {
  auto& target = *static_cast<Subscription*>(subscription);
  if (target.error) return;
  try {
    const auto* data = static_cast<const std::byte*>(message->data);
    target.handler(channel, message->recv_utime, {data, message->data_size});
  } catch (...) {
    target.error = std::current_exception();
  }
}

std::optional<int> kernel_receive_buffer_limit() {
  std::ifstream file("/proc/sys/net/core/rmem_max");
  int limit = 0;
  if (!(file >> limit)) return std::nullopt;
  return limit;
}

LcmUrl with_receive_buffer(LcmUrl url, int wanted, std::optional<int> limit) {
  if (url.provider != "udpm" || url.option("recv_buf_size")) return url;
  url.options.emplace_back("recv_buf_size", std::to_string(std::min(wanted, limit.value_or(wanted))));
  return url;
}

std::optional<std::string> receive_buffer_advice(std::optional<int> limit) {
  if (!limit || *limit >= kMinReceiveBuffer) return std::nullopt;
  return "net.core.rmem_max is " + std::to_string(*limit) +
         " bytes, so received rows may be lost: run 'sudo sysctl -w net.core.rmem_max=" +
         std::to_string(LcmReceiver::kReceiveBuffer) + "'";
}

}  // namespace stereod
