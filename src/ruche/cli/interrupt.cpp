#include "ruche/cli/interrupt.hpp"

#include <csignal>

namespace ruche {

static std::atomic<bool> stop_asked = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

const std::atomic<bool>& interrupted() { return stop_asked; }

void watch_for_interrupts() {
    struct sigaction reaction = {};
    reaction.sa_handler = [](int) { stop_asked = true; };
    // The handler is taken away when it runs: the second signal finds the default, which ends the program.
    reaction.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
    sigaction(SIGINT, &reaction, nullptr);
    sigaction(SIGTERM, &reaction, nullptr);
}

}  // namespace ruche
