#include "ruche/output/film.hpp"

#include <algorithm>
#include <cmath>

#include "ruche/core/parallel.hpp"

namespace ruche {
namespace {

constexpr int passes = 5;
constexpr int gloss_passes = 3;  ///< gloss has detail of its own: less smoothing

float alikeness(const FilmPixel& a, const FilmPixel& b, float tolerance) {
    if (a.part == 0.0F && b.part == 0.0F) return 1.0F;  // the ground is one plane
    const float bend = std::max(0.0F, a.normal.dot(b.normal));
    const float bend4 = bend * bend * bend * bend;
    const float off = a.normal.dot(a.position - b.position) / tolerance;
    const float part = 3.0F * (a.part - b.part);
    const float unlike = 1.0F + off * off + part * part;
    return bend4 * bend4 * bend4 * bend4 / (unlike * unlike * unlike);
}

struct Smoothed {
    Vec3f light, gloss;
};

/// Weighted mean over a 3 x 3 neighbourhood whose points lie `step` apart.
Smoothed smooth(const Film& film, int x, int y, int step, float plane_tolerance) {
    constexpr float kernel[2] = {0.5F, 0.25F};
    const FilmPixel& here = film.at(x, y);
    Smoothed sum{Vec3f::Zero(), Vec3f::Zero()};
    float weights = 0.0F;
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
            const int u = x + i * step, v = y + j * step;
            if (u < 0 || v < 0 || u >= film.width || v >= film.height) continue;
            const FilmPixel& there = film.at(u, v);
            if (there.samples == 0.0F) continue;
            const bool same = i == 0 && j == 0;
            const float w =
                kernel[std::abs(i)] * kernel[std::abs(j)] *
                (same ? 1.0F : alikeness(here, there, plane_tolerance * static_cast<float>(step)));
            sum.light += w * there.light;
            sum.gloss += w * there.gloss;
            weights += w;
        }
    if (weights > 0.0F) return {sum.light / weights, sum.gloss / weights};
    return {here.light, here.gloss};
}

}  // namespace

void develop_light(Film& film, float plane_tolerance) {
    for (FilmPixel& p : film.pixels) {
        if (p.samples == 0.0F) continue;
        for (Vec3f* v : {&p.albedo, &p.light, &p.gloss, &p.normal, &p.position}) *v /= p.samples;
        p.part /= p.samples;
        p.cover /= p.samples;
        p.samples = 1.0F;
    }
    std::vector<Smoothed> smoothed(film.pixels.size());
    for (int pass = 0, step = 1; pass < passes; ++pass, step *= 2) {
        parallel_for(static_cast<std::size_t>(film.height), [&](std::size_t y) {
            for (int x = 0; x < film.width; ++x)
                smoothed[y * film.width + x] = smooth(film, x, static_cast<int>(y), step, plane_tolerance);
        });
        for (std::size_t i = 0; i < smoothed.size(); ++i) {
            film.pixels[i].light = smoothed[i].light;
            if (pass < gloss_passes) film.pixels[i].gloss = smoothed[i].gloss;
        }
    }
}

}  // namespace ruche
