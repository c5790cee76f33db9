// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pipeline/worker_scheduling.h"

#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <barrier>
#include <cstring>

namespace stereod {
namespace {

// Both apply to the calling thread and return 0 or an errno.
int set_priority(int priority) noexcept {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
}

int set_cpus(const std::vector<int>& cpus) noexcept {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int cpu : cpus) CPU_SET(static_cast<std::size_t>(cpu), &set);
  return pthread_setaffinity_np(pthread_self(), sizeof set, &set);
}

std::string refusal(const std::string& setting, int error, const std::string& remedy) {
  return "the system refused " + setting + " for the matching threads (" + std::strerror(error) +
         "): " + remedy;
}

}  // namespace

std::string schedule_workers(WorkerPool& pool, const SchedulingConfig& scheduling) {
  if (scheduling.priority == 0 && scheduling.cpus.empty()) return {};
  std::atomic<int> priority_error{0}, cpus_error{0};
  // Each job waits for all others, so every thread gets exactly one.
  std::barrier all(pool.workers());
  pool.run(pool.workers(), [&](int, int) {
    if (scheduling.priority > 0) {
      if (const int error = set_priority(scheduling.priority)) priority_error = error;
    }
    if (!scheduling.cpus.empty()) {
      if (const int error = set_cpus(scheduling.cpus)) cpus_error = error;
    }
    all.arrive_and_wait();
  });
  std::string refused;
  if (priority_error != 0) {
    refused = refusal("real-time priority " + std::to_string(scheduling.priority), priority_error,
                      "allow it in the unit (LimitRTPRIO, RestrictRealtime, SystemCallFilter)");
  }
  if (cpus_error != 0) {
    if (!refused.empty()) refused += "; ";
    refused += refusal("the CPUs in scheduling.cpus", cpus_error,
                       "name CPUs that this machine has and allow it in the unit (SystemCallFilter)");
  }
  return refused;
}

}  // namespace stereod
