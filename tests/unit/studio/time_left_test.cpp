#include "ruche/studio/time_left.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace ruche;

TEST_CASE("time left: shrinks towards nothing over a usual release, its share grows towards all") {
    TimeLeft guess;
    auto now = TimeLeft::Clock::time_point{};
    const auto cost = [](int triangles) {
        return std::chrono::duration_cast<TimeLeft::Clock::duration>(
            std::chrono::duration<double>(1e-5 * std::pow(triangles, 1.2)));
    };
    guess.step(16000, 0, now);  // the flat sheet
    CHECK(guess.seconds() < 0.0);
    double whole = 0.0;
    for (const int triangles : {1000, 4000, 16000})
        whole += 7.0 * std::chrono::duration<double>(cost(triangles)).count();
    double spent = 0.0;
    double share = 0.0;
    for (const int triangles : {1000, 4000, 16000})
        for (int i = 0; i < 7; ++i) {
            now += cost(triangles);
            spent += std::chrono::duration<double>(cost(triangles)).count();
            guess.step(triangles, i, now);
            CHECK(guess.share() >= share);
            share = guess.share();
            if (i == 0 && triangles == 1000) continue;
            // Within a factor of two of what really is left, a step more or less.
            const double left = whole - spent;
            CHECK(guess.seconds() < 2.0 * left + 2.0 * std::chrono::duration<double>(cost(16000)).count());
            CHECK(guess.seconds() > 0.4 * left);
        }
    CHECK(share > 0.75);
}
