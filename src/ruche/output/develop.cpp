#include "ruche/output/develop.hpp"

#include <algorithm>
#include <cmath>

#include "ruche/core/parallel.hpp"
#include "ruche/output/palette.hpp"

namespace ruche {
namespace {

/// Light to screen values: a soft shoulder near white, then sRGB.
unsigned char screen_value(float linear, float dither) {
    constexpr float knee = 0.82F;
    if (linear > knee) linear = knee + (1.0F - knee) * (1.0F - std::exp(-(linear - knee) / (1.0F - knee)));
    const float s = linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
    return static_cast<unsigned char>(std::clamp(255.0F * s + dither, 0.0F, 255.0F));
}

/// An ordered dither keeps soft backgrounds free of bands.
float dither_at(int x, int y) { return static_cast<float>((x * 5 + y * 3) % 8) / 8.0F + 0.0625F; }

}  // namespace

std::vector<Vec3f> backdrop(int width, int height, const Vec2f& middle) {
    const auto rgb = palette::paper.linear();
    const Vec3f paper(static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2]));
    std::vector<Vec3f> result(static_cast<std::size_t>(width) * height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float u = static_cast<float>(x) / width - middle.x(),
                        v = static_cast<float>(y) / height - middle.y();
            const float far = u * u + v * v;
            const Vec3f tint(1.0F - 0.26F * far, 1.0F - 0.31F * far, 1.0F - 0.38F * far);
            result[static_cast<std::size_t>(y) * width + x] = paper.cwiseProduct(tint);
        }
    return result;
}

void fade_borders(Film& film, const Borders& borders) {
    for (int y = 0; y < film.height; ++y)
        for (int x = borders.left; x < borders.right; ++x) {
            FilmPixel& p = film.at(x, y);
            const auto nearest = static_cast<float>(
                std::min({x - borders.left, borders.right - 1 - x, y, film.height - 1 - y}));
            const float inside = std::min(1.0F, nearest / borders.reach);
            const float smooth = inside * inside * (3.0F - 2.0F * inside);
            const float share = (1.0F - p.part) * (1.0F - smooth);
            if (share > 0.0F) p.light += share * (Vec3f::Ones() - p.light);
        }
}

Image print(const Film& film) {
    Image image{film.width, film.height, std::vector<unsigned char>(film.pixels.size() * 3), {}};
    parallel_for(static_cast<std::size_t>(film.height), [&](std::size_t y) {
        for (int x = 0; x < film.width; ++x) {
            const std::size_t i = y * film.width + x;
            const FilmPixel& p = film.pixels[i];
            const Vec3f colour = p.albedo.cwiseProduct(p.light) + p.gloss;
            for (int k = 0; k < 3; ++k)
                image.rgb[3 * i + k] = screen_value(colour[k], dither_at(x, static_cast<int>(y)));
        }
    });
    return image;
}

Image print_transparent(const Film& film) {
    Image image{film.width, film.height, std::vector<unsigned char>(film.pixels.size() * 3),
                std::vector<unsigned char>(film.pixels.size())};
    parallel_for(static_cast<std::size_t>(film.height), [&](std::size_t y) {
        for (int x = 0; x < film.width; ++x) {
            const std::size_t i = y * film.width + x;
            const FilmPixel& p = film.pixels[i];
            const float shadow = (1.0F - p.cover) * std::clamp(1.0F - p.light.mean(), 0.0F, 1.0F);
            const float alpha = p.cover + shadow;
            // The ground is black, so this is the sheet's light times its cover: the mean of sheet and
            // shadow.
            const Vec3f colour = (p.albedo.cwiseProduct(p.light) + p.gloss) / std::max(alpha, 1e-3F);
            for (int k = 0; k < 3; ++k) image.rgb[3 * i + k] = screen_value(colour[k], 0.5F);
            image.alpha[i] = static_cast<unsigned char>(std::clamp(255.0F * alpha + 0.5F, 0.0F, 255.0F));
        }
    });
    return image;
}

}  // namespace ruche
