#include "daemon/pipeline/worker_scheduling.h"

#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <barrier>
#include <cstring>

namespace stereod {
namespace {

// Errno values, of the calling thread.
int take_priority(int priority) noexcept {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
}

int take_cpus(const std::vector<int>& cpus) noexcept {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int cpu : cpus) CPU_SET(static_cast<std::size_t>(cpu), &set);
  return pthread_setaffinity_np(pthread_self(), sizeof set, &set);
}

std::string refusal(const std::string& what, int error) {
  return "the system refuses the workers " + what + " (" +
         std::strerror(error) +  // NOLINT(concurrency-mt-unsafe)
         ")";
}

}  // namespace

std::string schedule_workers(WorkerPool& pool, const SchedulingConfig& scheduling) {
  if (scheduling.priority == 0 && scheduling.cpus.empty()) return {};
  std::atomic<int> priority_error{0}, cpus_error{0};
  // A job that waits for all the others is done by one thread each.
  std::barrier all(pool.workers());
  pool.run(pool.workers(), [&](int, int) {
    if (scheduling.priority > 0) {
      if (const int error = take_priority(scheduling.priority)) priority_error = error;
    }
    if (!scheduling.cpus.empty()) {
      if (const int error = take_cpus(scheduling.cpus)) cpus_error = error;
    }
    all.arrive_and_wait();
  });
  std::string refused;
  if (priority_error != 0) {
    refused = refusal("real-time priority " + std::to_string(scheduling.priority), priority_error) +
              "; the unit must permit it (LimitRTPRIO, RestrictRealtime, SystemCallFilter)";
  }
  if (cpus_error != 0) {
    if (!refused.empty()) refused += "; ";
    refused += refusal("the CPUs of scheduling.cpus", cpus_error) +
               "; there must be one of them, and the unit must permit it (SystemCallFilter)";
  }
  return refused;
}

}  // namespace stereod
