// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pipeline/worker_scheduling.h"

#include <gmock/gmock.h>
#include <sched.h>

#include <barrier>
#include <mutex>
#include <thread>

namespace stereod {
namespace {

/// The scheduling of each thread of a pool.
struct Threads {
  std::string refused;
  std::vector<int> policies, priorities, cpus;  // cpus: the number that a thread may use
};

/// Applies the settings to a pool on a thread of its own, so that this thread keeps its scheduling.
Threads scheduled(const SchedulingConfig& scheduling) {
  Threads threads;
  std::thread([&] {
    WorkerPool pool(3);
    threads.refused = schedule_workers(pool, scheduling);
    std::barrier all(pool.workers());
    std::mutex mutex;
    pool.run(pool.workers(), [&](int, int) {
      sched_param parameters{};
      cpu_set_t cpus;
      sched_getparam(0, &parameters);
      sched_getaffinity(0, sizeof cpus, &cpus);
      {
        const std::lock_guard lock(mutex);
        threads.policies.push_back(sched_getscheduler(0));
        threads.priorities.push_back(parameters.sched_priority);
        threads.cpus.push_back(CPU_COUNT(&cpus));
      }
      all.arrive_and_wait();
    });
  }).join();
  return threads;
}

int allowed_cpu() {
  cpu_set_t cpus;
  sched_getaffinity(0, sizeof cpus, &cpus);
  std::size_t cpu = 0;
  while (!CPU_ISSET(cpu, &cpus)) ++cpu;
  return static_cast<int>(cpu);
}

TEST(WorkerScheduling, Default_Unchanged) {
  const Threads threads = scheduled({});
  EXPECT_EQ(threads.refused, "");
  EXPECT_THAT(threads.policies, testing::Each(SCHED_OTHER));
}

TEST(WorkerScheduling, Cpus_EveryWorker) {
  SchedulingConfig scheduling;
  scheduling.cpus = {allowed_cpu()};
  const Threads threads = scheduled(scheduling);
  EXPECT_EQ(threads.refused, "");
  EXPECT_THAT(threads.cpus, testing::ElementsAre(1, 1, 1));
}

TEST(WorkerScheduling, MissingCpus_Reported) {
  SchedulingConfig scheduling;
  scheduling.cpus = {1023};
  EXPECT_EQ(
      scheduled(scheduling).refused,
      "the system refused the CPUs in scheduling.cpus for the matching threads (Invalid argument): name CPUs "
      "that this machine has and allow it in the unit (SystemCallFilter)");
}

TEST(WorkerScheduling, Priority_SetOrReported) {
  SchedulingConfig scheduling;
  scheduling.priority = 5;
  const Threads threads = scheduled(scheduling);
  if (threads.refused.empty()) {
    EXPECT_THAT(threads.policies, testing::Each(SCHED_FIFO));
    EXPECT_THAT(threads.priorities, testing::ElementsAre(5, 5, 5));
  } else {
    EXPECT_EQ(
        threads.refused,
        "the system refused real-time priority 5 for the matching threads (Operation not permitted): allow "
        "it in the unit (LimitRTPRIO, RestrictRealtime, SystemCallFilter)");
    EXPECT_THAT(threads.policies, testing::Each(SCHED_OTHER));
  }
}

}  // namespace
}  // namespace stereod
