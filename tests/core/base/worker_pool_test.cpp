// SPDX-License-Identifier: BSD-3-Clause
#include "core/base/worker_pool.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/allocation_counter.h"

namespace stereod {
namespace {

TEST(WorkerPool, BadWorkerCount_Throws) {
  EXPECT_THROW(WorkerPool(0), std::invalid_argument);
  EXPECT_THROW(WorkerPool(-3), std::invalid_argument);
  EXPECT_THROW(WorkerPool(257), std::invalid_argument);
  EXPECT_EQ(WorkerPool(1).workers(), 1);
  EXPECT_EQ(WorkerPool(7).workers(), 7);
}

TEST(WorkerPool, EveryJob_RunsOnce) {
  for (const int workers : {1, 2, 3, 5, 16}) {
    WorkerPool pool(workers);
    for (const int jobs : {0, 1, 2, workers - 1, workers, workers + 1, 1000}) {
      std::vector<std::atomic<int>> runs(static_cast<std::size_t>(jobs));
      pool.run(jobs, [&](int number, int) { ++runs.at(static_cast<std::size_t>(number)); });
      for (int number = 0; number < jobs; ++number) {
        ASSERT_EQ(runs[static_cast<std::size_t>(number)], 1)
            << "job " << number << " of " << jobs << ", " << workers << " workers";
      }
    }
  }
}

TEST(WorkerPool, WorkerNumber_BelongsToOneThread) {
  constexpr int kWorkers = 4;
  WorkerPool pool(kWorkers);
  std::array<std::atomic<int>, kWorkers> busy{};
  std::array<std::atomic<std::size_t>, kWorkers> thread_of{};
  std::atomic<int> clashes = 0;
  const std::hash<std::thread::id> hash;
  for (int round = 0; round < 50; ++round) {
    pool.run(40, [&](int, int worker) {
      const auto slot = static_cast<std::size_t>(worker);
      if (worker < 0 || worker >= kWorkers) {
        ++clashes;
        return;
      }
      if (busy[slot].exchange(1) != 0) ++clashes;
      const std::size_t me = hash(std::this_thread::get_id());
      const std::size_t before = thread_of[slot].exchange(me);
      if (before != 0 && before != me) ++clashes;
      std::this_thread::yield();
      busy[slot] = 0;
    });
  }
  EXPECT_EQ(clashes, 0);
  EXPECT_EQ(thread_of[0], hash(std::this_thread::get_id())) << "the caller is worker 0";
}

TEST(WorkerPool, Workers_RunConcurrently) {
  // Each job waits until all have begun, so the run ends only if every worker has taken one.
  constexpr int kWorkers = 5;
  WorkerPool pool(kWorkers);
  std::atomic<int> begun = 0;
  pool.run(kWorkers, [&](int, int) {
    ++begun;
    while (begun < kWorkers) std::this_thread::yield();
  });
  EXPECT_EQ(begun, kWorkers);
}

TEST(WorkerPool, Writes_VisibleAfterRun) {
  WorkerPool pool(3);
  std::vector<int> plain(1000, 0);
  for (int round = 1; round <= 20; ++round) {
    pool.run(1000, [&](int number, int) { plain[static_cast<std::size_t>(number)] += number; });
    ASSERT_EQ(std::accumulate(plain.begin(), plain.end(), 0), round * 999 * 1000 / 2);
  }
}

TEST(WorkerPool, JobThrows_RethrowsAndGoesOn) {
  for (const int workers : {1, 2, 4}) {
    WorkerPool pool(workers);
    for (int round = 0; round < 20; ++round) {
      std::atomic<int> running = 0;
      try {
        pool.run(100, [&](int number, int) {
          ++running;
          if (number == 5) {
            --running;
            throw std::runtime_error("job 5 failed");
          }
          std::this_thread::yield();
          --running;
        });
        FAIL() << "no exception";
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "job 5 failed");
      }
      ASSERT_EQ(running, 0) << "run() returned before every job had ended";
      std::atomic<int> runs = 0;
      pool.run(100, [&](int, int) { ++runs; });
      ASSERT_EQ(runs, 100) << "the run after the exception";
    }
  }
}

TEST(WorkerPool, SeveralThrow_RethrowsOne) {
  WorkerPool pool(4);
  for (int round = 0; round < 50; ++round) {
    EXPECT_THROW(pool.run(8, [](int number, int) { throw std::runtime_error(std::to_string(number)); }),
                 std::runtime_error);
    EXPECT_NO_THROW(pool.run(8, [](int, int) {}));
  }
}

TEST(WorkerPool, ThousandsOfRuns_AllJobsRun) {
  for (const int workers : {2, 3, 8}) {
    WorkerPool pool(workers);
    std::atomic<int> runs = 0;
    for (int round = 0; round < 5000; ++round) pool.run(round % 7, [&](int, int) { ++runs; });
    int expected = 0;
    for (int round = 0; round < 5000; ++round) expected += round % 7;
    EXPECT_EQ(runs, expected);
  }
}

TEST(WorkerPool, ManyPools_ComeAndGo) {
  for (int round = 0; round < 200; ++round) {
    WorkerPool pool(1 + round % 6);
    std::atomic<int> runs = 0;
    if (round % 3 != 0) {
      pool.run(4, [&](int, int) { ++runs; });
      ASSERT_EQ(runs, 4);
    }
  }
}

TEST(AllocationCounter, EveryKindAndThread_Counted) {
  if (!AllocationCounter::supported()) GTEST_SKIP() << "allocations cannot be counted in this build";
  // A volatile pointer, because the compiler may remove the allocation otherwise.
  void* volatile memory = nullptr;
  const auto counts = [&](auto&& allocate, auto&& release) {
    const AllocationCounter counter;
    memory = allocate();
    const bool counted = counter.count() > 0;
    release(memory);
    return counted;
  };
  const auto plain_delete = [](void* m) { ::operator delete(m); };
  const auto aligned_delete = [](void* m) { ::operator delete (m, std::align_val_t{64}); };
  EXPECT_TRUE(counts([] { return ::operator new(16); }, plain_delete));
  EXPECT_TRUE(counts([] { return ::operator new (64, std::align_val_t{64}); }, aligned_delete));
  EXPECT_TRUE(counts([] { return std::malloc(16); }, [](void* m) { std::free(m); }));
  EXPECT_TRUE(counts([] { return std::calloc(4, 4); }, [](void* m) { std::free(m); }));
  const AllocationCounter counter;
  std::thread([&] { memory = std::malloc(16); }).join();
  EXPECT_GT(counter.count(), 0U);
  std::free(memory);
  const AllocationCounter quiet;
  EXPECT_EQ(quiet.count(), 0U);
}

TEST(WorkerPool, Run_AllocatesNothing) {
  if (!AllocationCounter::supported()) GTEST_SKIP() << "allocations cannot be counted in this build";
  WorkerPool pool(4);
  std::atomic<int> runs = 0;
  const auto job = [&](int, int) { ++runs; };
  for (int round = 0; round < 100; ++round) pool.run(8, job);
  const AllocationCounter counter;
  for (int round = 0; round < 1000; ++round) pool.run(8, job);
  EXPECT_EQ(counter.count(), 0U);
  EXPECT_EQ(runs, 1100 * 8);
}

}  // namespace
}  // namespace stereod
