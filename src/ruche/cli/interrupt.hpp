#pragma once

#include <atomic>

namespace ruche {

/// Set by the first Ctrl-C (SIGINT) or SIGTERM after `watch_for_interrupts`; a second one ends the program at
/// once.
const std::atomic<bool>& interrupted();
void watch_for_interrupts();

}  // namespace ruche
