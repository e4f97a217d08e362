#include "ruche/cli/interrupt.hpp"

#include <pthread.h>

#include <csignal>
#include <cstdlib>
#include <thread>

namespace ruche {

static std::atomic<bool> stop_asked = false;
static std::atomic<bool> watched = false;

const std::atomic<bool>& interrupted() { return stop_asked; }

void watch_for_interrupts() { watched = true; }

/// As if nobody had waited for the signal: a shell's loop ends with a program that ended so.
[[noreturn]] static void end_by(int signal, const sigset_t& blocked) {
    std::signal(signal, SIG_DFL);
    pthread_sigmask(SIG_UNBLOCK, &blocked, nullptr);
    (void)std::raise(signal);
    constexpr int ended_by_signal = 128;
    std::_Exit(ended_by_signal + signal);
}

void run_beside_signals(std::function<void()> program) {
    sigset_t stops;
    sigemptyset(&stops);
    sigaddset(&stops, SIGINT);
    sigaddset(&stops, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &stops, nullptr);  // for the threads to come, too
    // The kernel gives a signal to a process' first thread where that waits for it, and not to a thread that
    // BLAS has begun before main, which does not block it.
    std::thread(std::move(program)).detach();
    for (;;) {
        int signal = 0;
        if (sigwait(&stops, &signal) != 0) continue;
        if (!watched || stop_asked.exchange(true)) end_by(signal, stops);
    }
}

}  // namespace ruche
