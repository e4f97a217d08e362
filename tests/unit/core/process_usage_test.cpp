#include "ruche/core/process_usage.hpp"

#include <doctest/doctest.h>

#include <ctime>
#include <thread>
#include <vector>

using namespace ruche;

TEST_CASE("process usage: processor time counts the work of every thread") {
    // What the other thread worked by its own clock; the rest of the process may work at the same time.
    const auto thread_seconds = [] {
        timespec time{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    };
    const double begin = processor_seconds();
    double worked = 0.0;
    std::thread other([&] {
        while (worked < 0.05) {
            worked = thread_seconds();
        }
    });
    other.join();
    CHECK(processor_seconds() - begin >= worked);
}

TEST_CASE("process usage: peak memory grows by what is touched, and does not shrink") {
    const double before = peak_megabytes();
    {
        const std::vector<char> block(200'000'000, 1);
        CHECK(peak_megabytes() - before > 150.0);
    }
    CHECK(peak_megabytes() - before > 150.0);
}
