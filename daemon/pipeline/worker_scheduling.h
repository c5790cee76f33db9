// SPDX-License-Identifier: BSD-3-Clause
// Real-time priority and CPU affinity of the matching threads.
#pragma once

#include <string>

#include "core/base/worker_pool.h"
#include "daemon/config/config.h"

namespace stereod {

/// Applies the configured priority and CPUs to every thread of @p pool, the calling thread included. Call it
/// on the thread that will call run(), before the first run(). Returns a "; "-separated list of settings that
/// the system refused, each with the remedy; empty on success.
std::string schedule_workers(WorkerPool& pool, const SchedulingConfig& scheduling);

}  // namespace stereod
