// SPDX-License-Identifier: BSD-3-Clause
#include "core/base/worker_pool.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace stereod {

WorkerPool::WorkerPool(int workers) {
  if (workers < 1 || workers > 256) {
    throw std::invalid_argument("a worker pool has 1 to 256 workers, not " + std::to_string(workers));
  }
  threads_.reserve(static_cast<std::size_t>(workers) - 1);
  for (int worker = 1; worker < workers; ++worker) {
    threads_.emplace_back([this, worker] { thread_main(worker); });
  }
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  work_announced_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void WorkerPool::run_erased(int jobs, void* job, ErasedJob call) {
  std::unique_lock lock(mutex_);
  job_ = job;
  call_ = call;
  jobs_ = jobs;
  next_job_ = 0;
  if (jobs > 1) work_announced_.notify_all();
  take_jobs(0, lock);
  work_done_.wait(lock, [this] { return jobs_running_ == 0; });
  if (first_error_) std::rethrow_exception(std::exchange(first_error_, nullptr));
}

void WorkerPool::thread_main(int worker) {
  std::unique_lock lock(mutex_);
  while (true) {
    work_announced_.wait(lock, [this] { return stopping_ || next_job_ < jobs_; });
    if (stopping_) return;
    take_jobs(worker, lock);
  }
}

// Called and left with the lock held; released while a job runs.
void WorkerPool::take_jobs(int worker, std::unique_lock<std::mutex>& lock) {
  while (next_job_ < jobs_) {
    const int number = next_job_++;
    ++jobs_running_;
    lock.unlock();
    std::exception_ptr error;
    try {
      call_(job_, number, worker);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    --jobs_running_;
    if (error) {
      if (!first_error_) first_error_ = error;
      next_job_ = jobs_;
    }
  }
  if (jobs_running_ == 0) work_done_.notify_one();
}

}  // namespace stereod
