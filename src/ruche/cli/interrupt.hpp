#pragma once

#include <atomic>
#include <functional>

namespace ruche {

/// Set by the first Ctrl-C (SIGINT) or SIGTERM after `watch_for_interrupts`; a second one, or one before,
/// ends the program at once.
const std::atomic<bool>& interrupted();
void watch_for_interrupts();

/// Runs the program on a thread of its own, while this one, the process' first, waits for signals and never
/// returns: the program ends by itself. No thread has to run a signal's handler, because METIS puts its own
/// in the place of any other while it orders, one that only the thread that called METIS survives. Throws
/// std::system_error where there is no room for a thread.
[[noreturn]] void run_beside_signals(std::function<void()> program);

}  // namespace ruche
