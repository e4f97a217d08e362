#include "ruche/core/parallel.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <stdexcept>
#include <vector>

using namespace ruche;

TEST_CASE("parallel_for: every index is visited exactly once at any thread count") {
    const int before = thread_count();
    for (const int threads : {1, 2, 5}) {
        set_thread_count(threads);
        std::vector<int> visits(1000, 0);
        parallel_for(visits.size(), [&](std::size_t i) { ++visits[i]; });
        CHECK(visits == std::vector<int>(1000, 1));
    }
    set_thread_count(before);
}

TEST_CASE("parallel_for: an exception in a body reaches the caller and the pool works on") {
    CHECK_THROWS_AS(parallel_for(100,
                                 [](std::size_t i) {
                                     if (i == 37) throw std::runtime_error("37");
                                 }),
                    std::runtime_error);
    std::vector<int> visits(10, 0);
    parallel_for(10, [&](std::size_t i) { ++visits[i]; });
    CHECK(std::accumulate(visits.begin(), visits.end(), 0) == 10);
}

TEST_CASE("parallel_for: nested calls run serially and do not deadlock") {
    std::vector<int> sums(8, 0);
    parallel_for(8, [&](std::size_t i) { parallel_for(10, [&](std::size_t) { ++sums[i]; }); });
    CHECK(sums == std::vector<int>(8, 10));
}

TEST_CASE("parallel for with workers: each item once, no two at the same time on one worker's workspace") {
    const int before = thread_count();
    for (const int threads : {1, 2, 5}) {
        set_thread_count(threads);
        std::vector<std::atomic<int>> done(1000);
        std::vector<std::atomic<int>> busy(threads);
        std::atomic<bool> clash = false;
        parallel_for_workers(done.size(), [&](std::size_t i, int worker) {
            if (worker < 0 || worker >= threads || busy[worker].fetch_add(1) != 0) clash = true;
            ++done[i];
            busy[worker].fetch_sub(1);
        });
        CHECK_FALSE(clash);
        CHECK(std::all_of(done.begin(), done.end(), [](const auto& count) { return count == 1; }));
    }
    set_thread_count(before);
}
