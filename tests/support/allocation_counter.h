// SPDX-License-Identifier: BSD-3-Clause
// Counts allocations, for tests of code that promises to allocate nothing.
#pragma once

#include <cstdint>

namespace stereod {

/// Counts the allocations of all threads from its construction on: malloc and its relatives, and so operator
/// new. Linking allocation_counter.cpp replaces them for the whole program. Only with glibc and without
/// sanitizers, which replace them too.
class AllocationCounter {
 public:
  AllocationCounter();

  /// Returns whether this build counts allocations. Tests skip otherwise.
  static bool supported();

  /// Returns the allocations since the construction; 0 if not supported.
  std::uint64_t count() const;

 private:
  std::uint64_t at_start_;
};

}  // namespace stereod
