#include "ruche/output/render.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "ruche/core/parallel.hpp"

namespace ruche {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr int first_samples = 2;     ///< per picture element
constexpr int edge_samples = 6;      ///< more where they disagree
constexpr float key_share = 0.54F;   ///< of the light on the open ground
constexpr float key_radius = 0.24F;  ///< tangent of the softbox's half angle
constexpr float through_fabric = 0.30F;
constexpr float rough_limit = 0.30F;  ///< a rough surface mirrors no more than this at grazing angles
constexpr float start = 6e-4F;        ///< rays start so far off a surface

/// Random numbers of one picture element: an additive recurrence (R2, Roberts 2018) with hashed offsets.
class Dice {
  public:
    Dice(int x, int y)
        : seed_(static_cast<std::uint32_t>(x) * 0x9E3779B1U ^ static_cast<std::uint32_t>(y) * 0x85EBCA77U) {}

    Vec2f roll(int sample, std::uint32_t use) const {
        const float n = static_cast<float>(sample);
        return {fraction(offset(2 * use) + n * 0.7548776662F),
                fraction(offset(2 * use + 1) + n * 0.5698402910F)};
    }

  private:
    float offset(std::uint32_t k) const {
        std::uint32_t h = seed_ + k * 0xC2B2AE3DU;
        h = (h ^ (h >> 16U)) * 0x7FEB352DU;
        h = (h ^ (h >> 15U)) * 0x846CA68BU;
        h ^= h >> 16U;
        return static_cast<float>(h >> 8U) * (1.0F / 16777216.0F);
    }
    static float fraction(float value) { return value - std::floor(value); }

    std::uint32_t seed_;
};

/// A vector turned from a frame in which z is `axis`.
Vec3f turned(const Vec3f& v, const Vec3f& axis) {
    const Vec3f x = axis.unitOrthogonal();
    return v.x() * x + v.y() * axis.cross(x) + v.z() * axis;
}

Vec3f cosine_direction(const Vec3f& normal, const Vec2f& dice) {
    const float r = std::sqrt(dice.x()), turn = 2.0F * pi * dice.y();
    return turned({r * std::cos(turn), r * std::sin(turn), std::sqrt(std::max(0.0F, 1.0F - dice.x()))},
                  normal);
}

class Photographer {
  public:
    Photographer(const Shot& shot, const std::vector<Vec3f>& ground, int width)
        : shot_(shot), stage_(*shot.stage), ground_(ground), width_(width) {
        // From the left, over the photographer's shoulder.
        key_ =
            (-0.62F * shot.camera.right + 0.45F * shot.camera.up - 0.85F * shot.camera.forward).normalized();
        float open = 0.0F;
        constexpr int count = 256;
        for (int i = 0; i < count; ++i)
            open += sky(
                cosine_direction(Vec3f::UnitZ(), Vec2f((i + 0.5F) / count, std::fmod(i * 0.618034F, 1.0F))));
        sky_strength_ = (1.0F - key_share) * count / open;
        key_strength_ = key_share / key_.z();
    }

    void sample(FilmPixel& pixel, int x, int y, int n) const {
        const Dice dice(x, y);
        const Vec2f at = Vec2f(static_cast<float>(x), static_cast<float>(y)) + dice.roll(n, 0);
        const Ray ray{.origin = shot_.camera.position, .direction = shot_.camera.direction(at)};
        RayHit hit;
        pixel.samples += 1.0F;
        const bool met = stage_.scene.intersect(ray, hit);
        if (met) {
            photograph_sheet(pixel, ray, hit, dice, n);
        } else {
            photograph_ground(pixel, ray, dice, n, ground_[static_cast<std::size_t>(y) * width_ + x]);
        }
    }

  private:
    /// Light of the surrounding from a direction: a bright room, brighter above and on the light's side.
    float sky(const Vec3f& d) const {
        if (d.z() < 0.0F) return 0.62F;
        return 0.78F + 0.30F * d.z() + 0.16F * d.dot(key_);
    }

    /// Surrounding as glossy plastic mirrors it: with the softbox's glow.
    float mirrored(const Vec3f& d) const {
        const float glow = std::clamp((d.dot(key_) - 0.80F) / 0.15F, 0.0F, 1.0F);
        return sky(d) * (d.z() < 0.0F ? 0.8F : 0.75F + 0.5F * d.z()) +
               1.6F * glow * glow * (3.0F - 2.0F * glow);
    }

    Vec3f key_sample(const Vec2f& dice) const {
        const float r = key_radius * std::sqrt(dice.x()), turn = 2.0F * pi * dice.y();
        return turned({r * std::cos(turn), r * std::sin(turn), 1.0F}, key_).normalized();
    }

    /// Light from all around; what stands in the way throws back a part of what it gets.
    Vec3f surrounding(const Vec3f& from, const Vec3f& normal, const Vec2f& dice) const {
        const Vec3f d = cosine_direction(normal, dice);
        RayHit hit;
        if (!stage_.scene.intersect({.origin = from + start * normal, .direction = d}, hit))
            return Vec3f::Constant(sky_strength_ * sky(d));
        return 0.62F * plain_albedo(static_cast<Look>(hit.part));
    }

    void photograph_ground(FilmPixel& pixel, const Ray& ray, const Dice& dice, int n,
                           const Vec3f& colour) const {
        pixel.albedo += colour;
        if (ray.direction.z() > -1e-4F) {
            pixel.light += Vec3f::Ones();
            pixel.position += 1e3F * ray.direction;
            return;
        }
        const float distance = (stage_.ground - ray.origin.z()) / ray.direction.z();
        const Vec3f at = ray.origin + distance * ray.direction;
        pixel.normal += Vec3f::UnitZ();
        pixel.position += at;
        if (at.squaredNorm() > 100.0F) {
            pixel.light += Vec3f::Ones();
            return;
        }
        const Vec3f to_key = key_sample(dice.roll(n, 1));
        const Vec3f from = at + start * Vec3f::UnitZ();
        if (!stage_.scene.occluded({.origin = from, .direction = to_key}))
            pixel.light += Vec3f::Constant(key_strength_ * key_.z());
        pixel.light += surrounding(at, Vec3f::UnitZ(), dice.roll(n, 2));
    }

    void photograph_sheet(FilmPixel& pixel, const Ray& ray, const RayHit& hit, const Dice& dice,
                          int n) const {
        const float width = hit.distance / shot_.camera.focal;
        const Surfel s = look_at(stage_, ray, hit, width);
        const Vec3f view = -ray.direction;
        pixel.normal += s.normal;
        pixel.position += s.position;
        pixel.part += s.is_fabric() ? 1.0F : 2.0F;
        pixel.cover += 1.0F;

        const Vec3f to_key = key_sample(dice.roll(n, 1));
        const float facing = s.normal.dot(to_key);
        Vec3f light = surrounding(s.lifted, s.normal, dice.roll(n, 2));
        bool lit = false;
        if (facing > 0.0F) {
            lit = !stage_.scene.occluded({.origin = s.lifted + start * s.normal, .direction = to_key});
            if (lit) light += Vec3f::Constant(key_strength_ * facing);
        } else if (s.is_fabric()) {
            light += light_through(s, to_key);
        }
        Vec3f albedo = s.albedo;
        if (s.is_fabric()) {
            const float grazing = 1.0F - std::clamp(s.normal.dot(view), 0.0F, 1.0F);
            albedo += 0.16F * grazing * grazing * grazing * Vec3f(1.0F, 0.93F, 0.80F);
        } else {
            pixel.gloss += gloss(s, view, lit ? to_key : Vec3f(Vec3f::Zero()), dice.roll(n, 3));
        }
        pixel.albedo += albedo;
        pixel.light += light;
    }

    /// Key light that shines through the fabric from its other side.
    Vec3f light_through(const Surfel& s, const Vec3f& to_key) const {
        const float thick = 0.02F;
        const Vec3f from = s.position - start * s.normal;
        const float facing = -s.normal.dot(to_key);
        // The ray leaves through the sheet's own other face; only what comes after that is in the way.
        if (stage_.scene.occluded(
                {.origin = from, .direction = to_key, .begin = thick / std::max(facing, 0.2F)}))
            return Vec3f::Zero();
        return through_fabric * key_strength_ * facing * Vec3f(1.0F, 0.86F, 0.66F);
    }

    /// Mirrored light of plastic: the softbox (GGX) and the surrounding (Fresnel), `to_key` zero in shadow.
    Vec3f gloss(const Surfel& s, const Vec3f& view, const Vec3f& to_key, const Vec2f& dice) const {
        const float nv = std::clamp(s.normal.dot(view), 0.02F, 1.0F);
        float result = 0.0F;
        if (to_key.squaredNorm() > 0.0F) {
            constexpr float a2 = 0.085F;
            const Vec3f half = (view + to_key).normalized();
            const float nh = s.normal.dot(half), nl = std::max(0.0F, s.normal.dot(to_key));
            const float d = nh * nh * (a2 - 1.0F) + 1.0F;
            const float fresnel = 0.04F + 0.96F * std::pow(1.0F - std::max(0.0F, view.dot(half)), 5.0F);
            result +=
                key_strength_ * fresnel * a2 / (pi * d * d) * nl / (4.0F * std::max(0.1F, nv * nl)) * nl;
        }
        const Vec3f rough = cosine_direction(s.normal, dice);
        const Vec3f mirror = (2.0F * nv * s.normal - view + 0.22F * rough).normalized();
        const float fresnel = 0.04F + rough_limit * std::pow(1.0F - nv, 5.0F);
        RayHit hit;
        if (!stage_.scene.intersect({.origin = s.lifted + start * s.normal, .direction = mirror}, hit))
            return Vec3f::Constant(result + fresnel * mirrored(mirror));
        return Vec3f::Constant(result) + 0.4F * fresnel * plain_albedo(static_cast<Look>(hit.part));
    }

    Shot shot_;
    const Stage& stage_;
    const std::vector<Vec3f>& ground_;
    int width_;
    Vec3f key_;
    float key_strength_ = 1.0F;
    float sky_strength_ = 1.0F;
};

/// Whether two picture elements show different things, so that their border needs more samples.
bool differ(const FilmPixel& a, const FilmPixel& b) {
    const float na = 1.0F / a.samples, nb = 1.0F / b.samples;
    if (std::abs(a.part * na - b.part * nb) > 0.2F) return true;
    return (a.normal * na - b.normal * nb).squaredNorm() > 0.08F;
}

}  // namespace

void expose(Film& film, const Shot& shot, const std::vector<Vec3f>& ground) {
    const Photographer photographer(shot, ground, film.width);
    const auto rows = static_cast<std::size_t>(film.height);
    const auto add = [&](int x, int y, int from, int to) {
        for (int n = from; n < to; ++n) photographer.sample(film.at(x, y), x, y, n);
    };
    parallel_for(rows, [&](std::size_t y) {
        for (int x = shot.left; x < shot.right; ++x) add(x, static_cast<int>(y), 0, first_samples);
    });
    std::vector<char> at_edge(film.pixels.size(), 0);
    parallel_for(rows, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = shot.left; x < shot.right; ++x) {
            const FilmPixel& here = film.at(x, y);
            bool edge = here.part > 0.0F && here.normal.norm() < 0.96F * here.samples;
            for (const auto& [dx, dy] :
                 {std::pair(-1, 0), std::pair(1, 0), std::pair(0, -1), std::pair(0, 1)}) {
                const int u = x + dx, v = y + dy;
                if (u < shot.left || u >= shot.right || v < 0 || v >= film.height) continue;
                edge = edge || differ(here, film.at(u, v));
            }
            at_edge[row * film.width + x] = edge ? 1 : 0;
        }
    });
    parallel_for(rows, [&](std::size_t row) {
        for (int x = shot.left; x < shot.right; ++x)
            if (at_edge[row * film.width + x] != 0)
                add(x, static_cast<int>(row), first_samples, first_samples + edge_samples);
    });
}

}  // namespace ruche
