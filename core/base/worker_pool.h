// SPDX-License-Identifier: BSD-3-Clause
// Fork and join over std::thread workers.
#pragma once

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <type_traits>
#include <vector>

namespace stereod {

/// A fixed set of workers. The thread that calls run() is worker 0; the others are threads of the pool, which
/// sleep between runs. The pool has two states:
///   (1) idle: every thread waits until a run is announced;
///   (2) running: job numbers are handed out under the lock until all are taken, then the last worker to
///       finish wakes the caller.
/// run() allocates nothing. Only one thread at a time may call it.
class WorkerPool {
 public:
  /// Starts @p workers − 1 threads. @p workers [1…256].
  /// @throws std::invalid_argument if @p workers is out of range, std::system_error if a thread cannot be
  /// started.
  explicit WorkerPool(int workers);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  int workers() const { return static_cast<int>(threads_.size()) + 1; }

  /// Calls @p job(number, worker) once for each number in [0, @p jobs), spread over the workers, and returns
  /// when all calls have returned. If a job throws, jobs not yet begun are skipped, and the first exception
  /// is rethrown once the running ones have ended.
  template <typename Job>
  void run(int jobs, Job&& job) {
    run_erased(jobs, const_cast<void*>(static_cast<const void*>(&job)),
               [](void* erased, int number, int worker) {
                 (*static_cast<std::remove_reference_t<Job>*>(erased))(number, worker);
               });
  }

 private:
  using ErasedJob = void (*)(void* job, int number, int worker);

  void run_erased(int jobs, void* job, ErasedJob call);
  void thread_main(int worker);
  void take_jobs(int worker, std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;
  std::condition_variable work_announced_;
  std::condition_variable work_done_;
  void* job_ = nullptr;
  ErasedJob call_ = nullptr;
  int jobs_ = 0;
  int next_job_ = 0;
  int jobs_running_ = 0;
  bool stopping_ = false;
  std::exception_ptr first_error_;
  std::vector<std::thread> threads_;
};

}  // namespace stereod
