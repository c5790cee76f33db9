// Fork and join over std::thread workers.
#pragma once

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <type_traits>
#include <vector>

namespace stereod {

/// A fixed set of workers. The caller of run() is worker 0 and works too; the others are threads that sleep
/// between runs. The pool has two states:
///   (1) idle: every thread waits for the next run to be announced;
///   (2) running: job numbers are handed out under the lock until none is left, then the last worker to
///   finish
///       wakes the caller.
/// run() allocates nothing. One thread at a time may call it.
class WorkerPool {
 public:
  /// 1…256 workers, so workers - 1 threads.
  explicit WorkerPool(int workers);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  int workers() const { return static_cast<int>(threads_.size()) + 1; }

  /// Calls job(number, worker) once for each number in [0, jobs), spread over the workers, and returns when
  /// all are done. The first exception out of a job is rethrown here, after the others have ended; jobs that
  /// had not begun by then are skipped.
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
