// Real-time priority and CPUs of the threads that match.
#pragma once

#include <string>

#include "core/base/worker_pool.h"
#include "daemon/config/config.h"

namespace stereod {

/// Gives every thread of the pool, the calling one among them, the priority and the CPUs that the
/// configuration asks for. What the system refused, as a sentence; empty if all is as it should be. To be
/// called by the thread that will call run(), before it does.
std::string schedule_workers(WorkerPool& pool, const SchedulingConfig& scheduling);

}  // namespace stereod
