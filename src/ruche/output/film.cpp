#include "ruche/output/film.hpp"

#include <algorithm>
#include <cmath>

#include "ruche/core/parallel.hpp"

namespace ruche {
namespace {

constexpr int passes = 4;

float alikeness(const FilmPixel& a, const FilmPixel& b, float tolerance) {
    const float bend = std::max(0.0F, a.normal.dot(b.normal));
    const float bend4 = bend * bend * bend * bend;
    const float off = a.normal.dot(a.position - b.position) / tolerance;
    const float part = 3.0F * (a.part - b.part);
    return bend4 * bend4 * bend4 * bend4 * std::exp(-off * off - part * part);
}

}  // namespace

void develop_light(Film& film, float plane_tolerance) {
    for (FilmPixel& p : film.pixels) {
        if (p.samples == 0.0F) continue;
        for (Vec3f* v : {&p.albedo, &p.light, &p.gloss, &p.normal, &p.position}) *v /= p.samples;
        p.part /= p.samples;
        p.samples = 1.0F;
    }
    constexpr float kernel[3] = {0.375F, 0.25F, 0.0625F};
    std::vector<Vec3f> smoothed(film.pixels.size());
    for (int pass = 0, step = 1; pass < passes; ++pass, step *= 2) {
        parallel_for(static_cast<std::size_t>(film.height), [&](std::size_t row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < film.width; ++x) {
                const FilmPixel& here = film.at(x, y);
                Vec3f sum = Vec3f::Zero();
                float weights = 0.0F;
                for (int j = -2; j <= 2; ++j)
                    for (int i = -2; i <= 2; ++i) {
                        const int u = x + i * step, v = y + j * step;
                        if (u < 0 || v < 0 || u >= film.width || v >= film.height) continue;
                        const FilmPixel& there = film.at(u, v);
                        if (there.samples == 0.0F) continue;
                        const float w =
                            kernel[std::abs(i)] * kernel[std::abs(j)] *
                            (i == 0 && j == 0 ? 1.0F : alikeness(here, there, plane_tolerance * step));
                        sum += w * there.light;
                        weights += w;
                    }
                smoothed[row * film.width + x] = weights > 0.0F ? Vec3f(sum / weights) : here.light;
            }
        });
        for (std::size_t i = 0; i < smoothed.size(); ++i) film.pixels[i].light = smoothed[i];
    }
}

}  // namespace ruche
