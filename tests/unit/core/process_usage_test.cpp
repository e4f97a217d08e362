#include "ruche/core/process_usage.hpp"

#include <doctest/doctest.h>

#include <chrono>
#include <thread>
#include <vector>

using namespace ruche;

TEST_CASE("process usage: processor time counts the work of every thread and no sleep") {
    const double begin = processor_seconds();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    CHECK(processor_seconds() - begin < 0.09);
    const auto work = [] {
        const double start = processor_seconds();
        while (processor_seconds() - start < 0.05) {
        }
    };
    std::thread other(work);
    other.join();
    CHECK(processor_seconds() - begin >= 0.05);
}

TEST_CASE("process usage: peak memory grows by what is touched, and does not shrink") {
    const double before = peak_megabytes();
    {
        const std::vector<char> block(200'000'000, 1);
        CHECK(peak_megabytes() - before > 150.0);
    }
    CHECK(peak_megabytes() - before > 150.0);
}
