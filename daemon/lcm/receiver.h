// SPDX-License-Identifier: BSD-3-Clause
// Receives from LCM in a client program.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/lcm/handle.h"

namespace stereod {

/// Subscribes with buffers large enough for a program that is briefly late. One thread.
class LcmReceiver {
 public:
  /// Receives one message; its bytes are valid during the call.
  using Handler = std::function<void(std::span<const std::byte>)>;

  /// @p url as in effective_lcm_url(). A udpm URL without recv_buf_size gets kReceiveBuffer, or what the
  /// kernel allows.
  /// @throws BusError
  explicit LcmReceiver(const std::string& url);

  /// Calls @p handler from receive() for each message on @p channel (a name, not a pattern).
  /// @throws BusError if the network does not deliver multicast back to this machine.
  void subscribe(const std::string& channel, Handler handler);

  /// Receives a message with its channel and the time of reception [µs since the Unix epoch].
  using AnyHandler = std::function<void(std::string_view, std::int64_t, std::span<const std::byte>)>;

  /// Does the same for every channel that starts with @p prefix and '_'.
  void subscribe_all(const std::string& prefix, AnyHandler handler);

  /// Waits for one message and handles it. Returns false if none arrived in time.
  /// @throws what the handler throws, and BusError at the end of a log file.
  bool receive(std::chrono::milliseconds timeout);

  /// Returns the URL in use, receive buffer included.
  std::string url() const { return url_.text(); }

  static constexpr int kReceiveBuffer = 4 << 20;  ///< [bytes]
  static constexpr int kQueueCapacity = 10000;    ///< [messages per channel]; LCM's default is 30

 private:
  struct Subscription {
    AnyHandler handler;
    std::exception_ptr error;
  };
  void subscribe_pattern(const std::string& pattern, AnyHandler handler);
  static void on_message(const lcm_recv_buf_t* message, const char* channel, void* subscription) noexcept;

  LcmUrl url_;
  std::vector<std::unique_ptr<Subscription>> subscriptions_;  // outlive lcm_, which points at them
  LcmHandle lcm_;
};

/// Returns the maximum receive buffer that the kernel allows (net.core.rmem_max) [bytes]; nothing if unknown.
std::optional<int> kernel_receive_buffer_limit();

/// Returns @p url with a receive buffer of min(wanted, limit) bytes. Returns it unchanged if it has one or is
/// not udpm.
LcmUrl with_receive_buffer(LcmUrl url, int wanted, std::optional<int> limit);

/// Returns what to do if @p limit [bytes] is too small for a frame sent in a burst; nothing if it is
/// sufficient.
std::optional<std::string> receive_buffer_advice(std::optional<int> limit);

}  // namespace stereod
