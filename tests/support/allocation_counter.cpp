// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/allocation_counter.h"

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define STEREOD_COUNTS_ALLOCATIONS 1
#else
#define STEREOD_COUNTS_ALLOCATIONS 0
#endif

namespace stereod {
namespace {

// Constant-initialized, because the first allocations precede all constructors.
constinit std::atomic<std::uint64_t> allocations{0};

}  // namespace

AllocationCounter::AllocationCounter() : at_start_(allocations.load()) {}

bool AllocationCounter::supported() { return STEREOD_COUNTS_ALLOCATIONS != 0; }

std::uint64_t AllocationCounter::count() const { return allocations.load() - at_start_; }

}  // namespace stereod

#if STEREOD_COUNTS_ALLOCATIONS

// glibc lets a program replace malloc ("Replacing malloc" in its manual). These functions count and call
// those of glibc by their internal names.
extern "C" {

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

void* malloc(std::size_t size) {
  ++stereod::allocations;
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  ++stereod::allocations;
  return __libc_calloc(count, size);
}

void* realloc(void* memory, std::size_t size) {
  ++stereod::allocations;
  return __libc_realloc(memory, size);
}

void* memalign(std::size_t alignment, std::size_t size) {
  ++stereod::allocations;
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++stereod::allocations;
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  ++stereod::allocations;
  void* const allocated = __libc_memalign(alignment, size);
  if (allocated == nullptr) return ENOMEM;
  *memory = allocated;
  return 0;
}

}  // extern "C"

#endif
