// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/lcm/bus.h"

#include <gtest/gtest.h>
#include <lcm/eventlog.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "daemon/lcm/receiver.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/network.h"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

// Not LCM's default port, so that tests outside a namespace do not meet other programs.
constexpr const char* kUrl = "udpm://239.255.76.67:17667?ttl=0";

#define SKIP_WITHOUT_MULTICAST() \
  if (const auto reason = why_no_multicast()) GTEST_SKIP() << *reason

BusError error_of(const std::string& url) {
  try {
    const LcmBus bus(url);
  } catch (const BusError& error) {
    return error;
  }
  return {"no error", false};
}

struct BadUrl {
  const char* url;
  const char* message;
  friend std::ostream& operator<<(std::ostream& out, const BadUrl& bad) { return out << bad.url; }
};

class BadUrls : public testing::TestWithParam<BadUrl> {};

TEST_P(BadUrls, Open_PermanentError) {
  const BusError error = error_of(GetParam().url);
  EXPECT_TRUE(error.permanent());
  const std::string text = error.what();
  EXPECT_NE(text.find(GetParam().message), std::string::npos) << text;
  EXPECT_NE(text.find(GetParam().url), std::string::npos) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
}

INSTANTIATE_TEST_SUITE_P(
    LcmBus, BadUrls,
    testing::Values(BadUrl{"garbage", "not of the form PROVIDER://NETWORK"},
                    BadUrl{"foo://x", "unknown provider 'foo', allowed udpm, file, memq"},
                    BadUrl{"tcpq://127.0.0.1:7700", "unknown provider 'tcpq'"},
                    BadUrl{"udpm://", "'' is not a multicast address"},
                    BadUrl{"udpm://hello:7667", "'hello' is not a multicast address"},
                    BadUrl{"udpm://192.168.1.1:7667", "'192.168.1.1' is not a multicast address"},
                    BadUrl{"udpm://239.255.76.67:0", "'0' is not a port"},
                    BadUrl{"udpm://239.255.76.67:99999", "'99999' is not a port"},
                    BadUrl{"udpm://239.255.76.67:7667?ttl=abc", "ttl is 'abc'"},
                    BadUrl{"udpm://239.255.76.67:7667?ttl=999", "ttl is '999'"},
                    BadUrl{"udpm://239.255.76.67:7667?ttl", "ttl is ''"},
                    BadUrl{"udpm://239.255.76.67:7667?recv_buf_size=-1", "recv_buf_size is '-1'"},
                    BadUrl{"udpm://239.255.76.67:7667?tll=1", "unknown option 'tll'"},
                    BadUrl{"file://", "path of the log file is missing"},
                    BadUrl{"file:///tmp/some.log", "needs ?mode=w"}));

TEST(LcmBus, LogWithoutDirectory_Error) {
  const BusError error = error_of("file:///no/such/directory/log?mode=w");
  EXPECT_FALSE(error.permanent());
  EXPECT_NE(std::string(error.what()).find("/no/such/directory: No such file or directory"),
            std::string::npos)
      << error.what();
}

/// Opens a bus in a network namespace without routes. Returns 0 for the expected error, 1 for another result,
/// 2 if no namespace can be created. Uses a child process, because a process cannot leave its namespace.
int outcome_without_route() {
  const pid_t child = fork();
  if (child == 0) {
    if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) _exit(2);
    const BusError error = error_of(kUrl);
    const bool names_remedy =
        std::string(error.what()).find("sudo ip route add 224.0.0.0/4 dev lo") != std::string::npos;
    _exit(!error.permanent() && names_remedy ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

TEST(LcmBus, NoMulticastRoute_Remedy) {
  const int outcome = outcome_without_route();
  if (outcome == 2) GTEST_SKIP() << "this machine does not allow users to create network namespaces";
  EXPECT_EQ(outcome, 0);
}

TEST(LcmBus, Published_Delivered) {
  SKIP_WITHOUT_MULTICAST();
  LcmReceiver receiver(kUrl);
  std::vector<std::string> got;
  receiver.subscribe("TEST.ONE", [&got](std::span<const std::byte> bytes) {
    got.emplace_back(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  });
  LcmBus bus(kUrl);
  EXPECT_TRUE(bus.publish("TESTXONE", "other", 5));  // "." in the name is not a wildcard
  EXPECT_TRUE(bus.publish("TEST.ONE", "hello", 5));
  const std::string large(200'000, 'x');
  EXPECT_TRUE(bus.publish("TEST.ONE", large.data(), large.size()));
  while (got.size() < 2 && receiver.receive(std::chrono::seconds(2))) {
  }
  ASSERT_EQ(got.size(), 2U);
  EXPECT_EQ(got[0], "hello");
  EXPECT_EQ(got[1], large);
  EXPECT_FALSE(receiver.receive(std::chrono::milliseconds(20)));
}

TEST(LcmBus, Publish_NoAllocation) {
  SKIP_WITHOUT_MULTICAST();
  if (!AllocationCounter::supported()) GTEST_SKIP() << "this build does not count allocations";
  LcmBus bus(kUrl);
  const std::vector<char> data(300'000);
  bool sent = bus.publish("TEST", data.data(), 1);  // GLib creates a mutex for the first message
  const AllocationCounter counter;
  for (const std::size_t size : {1, 100, 1500, 60'000, 65'000, 70'000, 300'000}) {
    sent = bus.publish("TEST", data.data(), size) && sent;
  }
  const auto allocations = counter.count();
  EXPECT_TRUE(sent);
  EXPECT_EQ(allocations, 0U);
}

// Disparities, left images and the status are published by different threads.
TEST(LcmBus, ThreadsOnOneLog_WholeMessages) {
  constexpr int kThreads = 4, kMessages = 2000;
  const TemporaryDirectory directory;
  const std::string file = (directory / "log").string();
  {
    LcmBus bus("file://" + file + "?mode=w");
    std::vector<std::jthread> threads;
    for (int t = 0; t < kThreads; ++t) {
      threads.emplace_back([&bus, t] {
        const std::string data(static_cast<std::size_t>(100 + 37 * t), static_cast<char>('a' + t));
        for (int i = 0; i < kMessages; ++i) bus.publish("TEST", data.data(), data.size());
      });
    }
  }
  const std::unique_ptr<lcm_eventlog_t, decltype(&lcm_eventlog_destroy)> log(
      lcm_eventlog_create(file.c_str(), "r"), lcm_eventlog_destroy);
  ASSERT_TRUE(log);
  int whole = 0;
  while (lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log.get())) {
    const std::string data(static_cast<const char*>(event->data), static_cast<std::size_t>(event->datalen));
    whole += data.find_first_not_of(data[0]) == data.npos ? 1 : 0;
    lcm_eventlog_free_event(event);
  }
  EXPECT_EQ(whole, kThreads * kMessages);
}

TEST(LcmBus, ChannelTooLong_Refused) {
  SKIP_WITHOUT_MULTICAST();
  LcmBus bus(kUrl);
  EXPECT_TRUE(bus.publish(std::string(63, 'C').c_str(), "x", 1));
  EXPECT_FALSE(bus.publish(std::string(64, 'C').c_str(), "x", 1));
}

TEST(LcmReceiver, HandlerThrows_Rethrown) {
  SKIP_WITHOUT_MULTICAST();
  LcmReceiver receiver(kUrl);
  receiver.subscribe("TEST_THROW",
                     [](std::span<const std::byte>) { throw std::runtime_error("from a handler"); });
  LcmBus bus(kUrl);
  bus.publish("TEST_THROW", "x", 1);
  EXPECT_THROW(receiver.receive(std::chrono::seconds(2)), std::runtime_error);
  EXPECT_FALSE(receiver.receive(std::chrono::milliseconds(20)));
}

TEST(LcmReceiver, ReceiveBuffer_AddedToUrl) {
  const LcmUrl url = parse_lcm_url(kUrl);
  const std::string plain = kUrl;
  EXPECT_EQ(with_receive_buffer(url, 4096, std::nullopt).text(), plain + "&recv_buf_size=4096");
  EXPECT_EQ(with_receive_buffer(url, 4096, 1000).text(), plain + "&recv_buf_size=1000");
  const std::string own = plain + "&recv_buf_size=77";
  EXPECT_EQ(with_receive_buffer(parse_lcm_url(own), 4096, std::nullopt).text(), own);
  EXPECT_EQ(with_receive_buffer(parse_lcm_url("memq://"), 4096, std::nullopt).text(), "memq://");
}

TEST(LcmReceiver, SmallKernelLimit_Advice) {
  EXPECT_FALSE(receive_buffer_advice(std::nullopt));
  EXPECT_FALSE(receive_buffer_advice(4 << 20));
  const auto instruction = receive_buffer_advice(212992);
  ASSERT_TRUE(instruction);
  EXPECT_NE(instruction->find("sudo sysctl -w net.core.rmem_max="), std::string::npos);
}

TEST(LcmUrl, Empty_EnvironmentThenDefault) {
  unsetenv("LCM_DEFAULT_URL");
  EXPECT_EQ(effective_lcm_url(""), kDefaultLcmUrl);
  setenv("LCM_DEFAULT_URL", "memq://", 1);
  EXPECT_EQ(effective_lcm_url(""), "memq://");
  EXPECT_EQ(effective_lcm_url(kUrl), kUrl);
  unsetenv("LCM_DEFAULT_URL");
}

TEST(LcmUrl, Udpm_AddressAndPort) {
  EXPECT_EQ(udpm_address(parse_lcm_url("udpm://239.1.2.3")), std::pair(std::string("239.1.2.3"), 7667));
  EXPECT_EQ(udpm_address(parse_lcm_url("udpm://239.1.2.3:99?ttl=1")),
            std::pair(std::string("239.1.2.3"), 99));
}

}  // namespace
}  // namespace stereod
