#pragma once

#include <cstddef>
#include <functional>

namespace ruche {

/// Number of threads that `parallel_for` uses; by default the cores of the machine.
int thread_count();

/// Sets it for the whole process (1 = no threads at all).
void set_thread_count(int count);

/// Calls `body(i)` for i in [0, count), each exactly once, on several threads; returns when all are done.
/// The order is not defined: for results that do not depend on the thread count, `body(i)` must write only to
/// what belongs to i. The first exception thrown by a body is thrown again here. Nested calls run serially.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body);

/// The same with the number of the thread at work, in [0, thread_count()), for workspaces.
void parallel_for_workers(std::size_t count, const std::function<void(std::size_t, int)>& body);

}  // namespace ruche
