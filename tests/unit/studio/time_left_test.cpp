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
    guess.step(91000, 0, now);  // the flat sheet
    CHECK(guess.seconds() < 0.0);
    const auto meshes = {3100, 13000, 91000};  // the torus, with elements of 0.25 mm
    double whole = 0.0;
    for (const int triangles : meshes) whole += 5.0 * std::chrono::duration<double>(cost(triangles)).count();
    double spent = 0.0;
    double share = 0.0;
    for (const int triangles : meshes)
        for (int i = 0; i < 5; ++i) {
            now += cost(triangles);
            spent += std::chrono::duration<double>(cost(triangles)).count();
            guess.step(triangles, i, now);
            CHECK(guess.share() >= share);
            share = guess.share();
            if (i == 0 && triangles == 3100) continue;
            // Within a factor of two of what really is left, a step more or less.
            const double left = whole - spent;
            CHECK(guess.seconds() < 2.0 * left + 2.0 * std::chrono::duration<double>(cost(91000)).count());
            CHECK(guess.seconds() > 0.4 * left);
        }
    CHECK(share > 0.75);
}
