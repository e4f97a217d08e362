#include "ruche/study/silhouette/outline_circle.hpp"

#include <algorithm>
#include <cmath>

#include "ruche/core/error.hpp"
#include "ruche/geometry/circle_fit.hpp"

namespace ruche {
namespace {

struct PixelCircle {
    Vec2 centre = Vec2::Zero();
    double radius = 0.0;

    double off(const Vec2& p) const { return std::abs((p - centre).norm() - radius); }
};

/// Rays spread evenly over the directions in which an object lies as seen from a point.
struct Rays {
    double begin = 0.0;  // rad
    double step = 0.0;
    int count = 0;
};

constexpr double spacing = 1.5;  // pixels between rays on the circle
constexpr int fewest_rays = 60;
constexpr int most_rays = 4000;

PixelCircle circle_through(const std::vector<Vec2>& points, const std::string& file) {
    std::vector<Vec3> flat;
    flat.reserve(points.size());
    for (const Vec2& p : points) flat.emplace_back(p.x(), p.y(), 0.0);
    const CircleFit fit = fit_circle(flat);
    double extent = 0.0;
    for (const Vec2& p : points) extent = std::max(extent, (p - points.front()).norm());
    constexpr double straightest =
        20.0;  // radii per extent: there an arc rises by half a percent of its length
    if (!fit.valid || !(fit.curvature * extent * straightest > 1.0))
        throw InputError({.file = file}, "the outline of what is seen bends nowhere enough to have a circle",
                         "The photo has to look along the axis that the sheet rolls around.");
    return {.centre = fit.centre().head<2>(), .radius = fit.radius()};
}

bool inside(const std::vector<Vec2>& hull, const Vec2& p) {
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const Vec2 side = hull[(i + 1) % hull.size()] - hull[i];
        const Vec2 to = p - hull[i];
        if (side.x() * to.y() - side.y() * to.x() < 0.0) return false;
    }
    return true;
}

Rays rays_at(const Foreground& object, const PixelCircle& circle) {
    Rays rays{.begin = -M_PI, .step = 2.0 * M_PI};  // step: of all rays together at first
    if (!inside(object.hull, circle.centre)) {
        Vec2 middle = Vec2::Zero();
        for (const Vec2& p : object.hull) middle += p - circle.centre;
        double least = 0.0;
        double most = 0.0;
        for (const Vec2& p : object.hull) {
            const Vec2 to = p - circle.centre;
            const double angle = std::atan2(middle.x() * to.y() - middle.y() * to.x(), middle.dot(to));
            least = std::min(least, angle);
            most = std::max(most, angle);
        }
        rays = {.begin = std::atan2(middle.y(), middle.x()) + least, .step = most - least};
    }
    rays.count = std::clamp(static_cast<int>(rays.step * circle.radius / spacing), fewest_rays, most_rays);
    rays.step /= rays.count;
    return rays;
}

/// Where each ray, coming from afar, meets the object first.
std::vector<Vec2> first_hits(const Foreground& object, const PixelCircle& circle, const Rays& rays,
                             double threshold) {
    double far = 0.0;
    double extent = 0.0;
    for (const Vec2& p : object.hull) {
        far = std::max(far, (p - circle.centre).norm());
        extent = std::max(extent, (p - object.hull.front()).norm());
    }
    const double begin = far + 2.0;
    const double end = std::max(0.0, far - extent);
    constexpr double stride = 0.5;
    std::vector<Vec2> hits;
    for (int i = 0; i < rays.count; ++i) {
        const double angle = rays.begin + (i + 0.5) * rays.step;
        const Vec2 out(std::cos(angle), std::sin(angle));
        double before = 0.0;
        for (double r = begin; r > end; r -= stride) {
            const double here = object.at(circle.centre + r * out);
            if (here >= threshold) {
                hits.emplace_back(circle.centre + (r + stride * (here - threshold) / (here - before)) * out);
                break;
            }
            before = here;
        }
    }
    return hits;
}

std::vector<Vec2> near(const std::vector<Vec2>& points, const PixelCircle& circle) {
    std::vector<double> off;
    off.reserve(points.size());
    for (const Vec2& p : points) off.push_back(circle.off(p));
    std::nth_element(off.begin(), off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2), off.end());
    constexpr double deviation = 1.4826;  // of a normal distribution, over its median
    const double most = std::max(1.0, 3.0 * deviation * off[off.size() / 2]);
    std::vector<Vec2> kept;
    for (const Vec2& p : points)
        if (circle.off(p) <= most) kept.push_back(p);
    return kept;
}

struct Followed {
    PixelCircle circle;
    std::vector<Vec2> points;
    double share = 0.0;
    double arc = 0.0;  // rad
};

Followed follow(const Foreground& object, double threshold, PixelCircle circle, const std::string& file) {
    constexpr int rounds = 40;
    constexpr std::size_t fewest = 20;
    Followed found;
    for (int round = 0; round < rounds; ++round) {
        const Rays rays = rays_at(object, circle);
        const std::vector<Vec2> hits = first_hits(object, circle, rays, threshold);
        if (hits.size() < fewest)
            throw InputError({.file = file}, "the outline of what is seen has no arc that could be measured",
                             "A larger or sharper photo may help.");
        const std::vector<Vec2> kept = near(hits, circle);
        const PixelCircle next = circle_through(kept.size() < fewest ? hits : kept, file);
        const double change = (next.centre - circle.centre).norm() + std::abs(next.radius - circle.radius);
        circle = next;
        found = {.circle = circle,
                 .points = kept,
                 .share = static_cast<double>(kept.size()) / static_cast<double>(hits.size()),
                 .arc = rays.step * static_cast<double>(kept.size())};
        if (change < 1e-4) break;
    }
    return found;
}

/// Jackknife over a tenth of the arc each: neighbours err alike, so single points would promise too much.
double jackknife(const Followed& found, const std::string& file) {
    constexpr std::size_t blocks = 10;
    std::vector<double> radius;
    for (std::size_t block = 0; block < blocks; ++block) {
        const std::size_t begin = block * found.points.size() / blocks;
        const std::size_t end = (block + 1) * found.points.size() / blocks;
        std::vector<Vec2> rest(found.points.begin(),
                               found.points.begin() + static_cast<std::ptrdiff_t>(begin));
        rest.insert(rest.end(), found.points.begin() + static_cast<std::ptrdiff_t>(end), found.points.end());
        radius.push_back(circle_through(rest, file).radius);
    }
    double mean = 0.0;
    for (const double r : radius) mean += r / blocks;
    double squares = 0.0;
    for (const double r : radius) squares += (r - mean) * (r - mean);
    return std::sqrt(squares * (blocks - 1) / blocks) / found.circle.radius;
}

}  // namespace

OutlineCircle fit_outline_circle(const Foreground& object, const std::string& file) {
    const Followed found = follow(object, object.threshold, circle_through(object.hull, file), file);
    OutlineCircle outline{.centre = found.circle.centre,
                          .radius = found.circle.radius,
                          .arc_deg = found.arc * 180.0 / M_PI,
                          .followed = found.share,
                          .points = found.points,
                          .fit_error = jackknife(found, file)};
    for (const Vec2& p : found.points)
        outline.rms += found.circle.off(p) * found.circle.off(p) / static_cast<double>(found.points.size());
    outline.rms = std::sqrt(outline.rms);
    // An edge is blurred over some pixels; its middle may be a third of its height off the threshold.
    const auto radius_at = [&](double share) {
        return follow(object, share * object.threshold, found.circle, file).circle.radius;
    };
    outline.edge_error = 0.5 * std::abs(radius_at(4.0 / 3.0) - radius_at(2.0 / 3.0)) / outline.radius;
    return outline;
}

}  // namespace ruche
