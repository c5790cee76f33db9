// Receiving from LCM in a client program.
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

/// Subscribes with buffers large enough that a reader which is a little late loses nothing.
class LcmReceiver {
 public:
  /// Takes one message; its bytes are valid during the call.
  using Handler = std::function<void(std::span<const std::byte>)>;

  /// `url` as in effective_lcm_url(). A udpm URL without recv_buf_size gets kReceiveBuffer, or as much of it
  /// as the kernel allows. Throws BusError.
  explicit LcmReceiver(const std::string& url);

  /// Calls `handler` for each message on `channel` (not a pattern), from within receive(). Throws BusError if
  /// the network does not carry multicast back to this machine.
  void subscribe(const std::string& channel, Handler handler);

  /// Takes a message with its channel and the time it was received, µs since the Unix epoch.
  using AnyHandler = std::function<void(std::string_view, std::int64_t, std::span<const std::byte>)>;

  /// The same for every channel that begins with `prefix` and '_'.
  void subscribe_all(const std::string& prefix, AnyHandler handler);

  /// Waits for one message and handles it; false if none came in time. Throws what the handler throws, and
  /// BusError at the end of a log file.
  bool receive(std::chrono::milliseconds timeout);

  /// The URL in use, receive buffer included.
  std::string url() const { return url_.text(); }

  static constexpr int kReceiveBuffer = 4 << 20;  ///< bytes
  static constexpr int kQueueCapacity = 10000;    ///< messages per channel; LCM's default is 30

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

/// The most bytes the kernel lets a program ask for as a receive buffer (net.core.rmem_max); nothing if
/// unknown.
std::optional<int> kernel_receive_buffer_limit();

/// `url` with a receive buffer of `wanted` bytes, or of `limit` if that is less, unless it has one already or
/// is not udpm.
LcmUrl with_receive_buffer(LcmUrl url, int wanted, std::optional<int> limit);

/// What to do if `limit` is too small for a frame sent in one go, as a sentence; nothing if it is fine.
std::optional<std::string> receive_buffer_advice(std::optional<int> limit);

}  // namespace stereod
