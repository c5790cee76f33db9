// Counts the memory that a program asks for, to hold the code that promises to allocate nothing to its word.
#pragma once

#include <cstdint>

namespace stereod {

/// Counts from its construction every allocation of every thread: malloc and its relatives, so operator new
/// too. Linking allocation_counter.cpp replaces them for the whole program (glibc only; under a sanitizer the
/// sanitizer has replaced them already, and nothing is counted).
class AllocationCounter {
 public:
  AllocationCounter();

  /// Whether this build counts at all. A test that finds it does not skips, and says so.
  static bool supported();

  /// Allocations since the construction; 0 where not supported.
  std::uint64_t count() const;

 private:
  std::uint64_t at_start_;
};

}  // namespace stereod
