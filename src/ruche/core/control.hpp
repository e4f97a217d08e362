#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <string_view>

namespace ruche {

/// A long computation tells its caller how far it is. The library never prints.
struct Progress {
    std::string_view phase;  ///< "mesh", "release", "picture", ...
    double fraction = 0.0;   ///< of this phase, 0 to 1; negative when it cannot be known
    std::string text;        ///< one line for a person, such as "iteration 4: residual 2.1e-03 N"
};

struct Iterate;  // statics/iterate.hpp; only handed on here

/// What a caller gives to a long computation: where to report, a flag that asks it to stop at the next safe
/// point, and when its time is over.
struct Control {
    using Clock = std::chrono::steady_clock;
    std::function<void(const Progress&)> report;
    const std::atomic<bool>* stop = nullptr;
    Clock::time_point deadline = Clock::time_point::max();
    /// Shown the shapes that a release passes through, the flat sheet first. Called on the thread that
    /// solves, which waits for it.
    std::function<void(const Iterate&)> watch;

    void say(const Progress& progress) const {
        if (report) report(progress);
    }
    bool stopped() const { return stop != nullptr && stop->load(std::memory_order_relaxed); }
    bool timed_out() const { return deadline != Clock::time_point::max() && Clock::now() >= deadline; }
};

}  // namespace ruche
