#include "ruche/output/stage.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "ruche/output/palette.hpp"

namespace ruche {
namespace {

constexpr float wale_mm = 1.15F;    ///< width of a column of stitches, in the layout
constexpr float course_mm = 0.95F;  ///< height of a row of stitches

Vec3f linear(const Colour& colour) {
    const auto rgb = colour.linear();
    return {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])};
}

/// Height of a plain knit, 0 to 1, at a point of the layout in units of its stitches: columns of Vs.
float knit(float u, float v) {
    const float across = u - std::floor(u) - 0.5F;
    const float arm = std::abs(across);
    const float wave = 0.5F + 0.5F * std::cos(2.0F * std::numbers::pi_v<float> * (v - 1.1F * arm));
    const float yarn = std::sin(std::numbers::pi_v<float> * std::min(1.0F, 2.0F * arm));
    return (0.35F + 0.65F * wave) * (0.25F + 0.75F * yarn);
}

constexpr float knit_mean = 0.42F;

struct KnitSample {
    float height;
    Vec2f slope;
};

KnitSample knit_at(const Vec2f& layout) {
    const float u = layout.x() / wale_mm, v = layout.y() / course_mm;
    constexpr float step = 0.06F;
    const float here = knit(u, v);
    return {here, Vec2f(knit(u + step, v) - here, knit(u, v + step) - here) / step};
}

/// Moves a point of a flat triangle onto the smooth surface that its normals suggest, so that coarse
/// triangles do not shade themselves (Hanika 2021).
Vec3f lift(const Vec3f& at, const Vec3f& weights, const Vec3f corner[3], const Vec3f normal[3]) {
    Vec3f result = at;
    for (int i = 0; i < 3; ++i)
        result -= weights[i] * std::min(0.0F, (at - corner[i]).dot(normal[i])) * normal[i];
    return result;
}

/// The directions in space in which the layout's x and y grow on a triangle, each of unit length.
struct Tangents {
    Vec3f x, y;
};

Tangents layout_tangents(const Vec3f corner[3], const Vec2f layout[3]) {
    const Vec3f a = corner[1] - corner[0], b = corner[2] - corner[0];
    const Vec2f p = layout[1] - layout[0], q = layout[2] - layout[0];
    const float area = p.x() * q.y() - p.y() * q.x();
    if (!(std::abs(area) > 1e-12F)) return {Vec3f::Zero(), Vec3f::Zero()};
    const Vec3f x = (q.y() * a - p.y() * b) / area, y = (p.x() * b - q.x() * a) / area;
    return {x.normalized(), y.normalized()};
}

}  // namespace

Vec3f plain_albedo(Look look) {
    static const Vec3f fabric = linear(palette::fabric), front = linear(palette::plastic_front),
                       back = linear(palette::plastic_back);
    switch (look) {
        case Look::plastic_front:
            return front;
        case Look::plastic_back:
            return back;
        default:
            return fabric;
    }
}

Stage make_stage(const Result& result, const std::vector<Vec3>& positions, const Placement& placement) {
    const TriangleMesh& mesh = result.layout.mesh;
    std::vector<Vec3> placed;
    placed.reserve(positions.size());
    for (const Vec3& p : positions) placed.push_back(placement.apply(p));
    const double half_fabric = 0.5 * result.scene.material.fabric_thickness * placement.scale;
    std::vector<double> fabric(mesh.triangles.size(), half_fabric), front(mesh.triangles.size(), 0.0),
        back(front);
    std::vector<char> behind(mesh.triangles.size(), 0);
    double thickest = 0.0;
    for (std::size_t t = 0; t < result.layout.print.size(); ++t) {
        const Print& print = result.layout.print[t];
        // Plastic begins inside the fabric so that no gap shows where the sheet bends sharply at a rim.
        if (print.front > 0.0) front[t] = half_fabric + print.front * placement.scale;
        if (print.back > 0.0) back[t] = half_fabric + print.back * placement.scale;
        behind[t] = print.back > 0.0 && print.front == 0.0 ? 1 : 0;
        thickest = std::max({thickest, front[t], back[t]});
    }
    const double rounding = 0.35 * std::max(0.0, thickest - half_fabric);
    std::vector<Relief> parts;
    parts.push_back(
        raise(mesh, placed, fabric, {.side = Side::front, .rounding = half_fabric, .segments = 2}));
    parts.push_back(
        raise(mesh, placed, fabric, {.side = Side::back, .rounding = half_fabric, .segments = 2}));
    parts.push_back(raise(mesh, placed, front, {.side = Side::front, .rounding = rounding, .segments = 3}));
    parts.push_back(raise(mesh, placed, back, {.side = Side::back, .rounding = rounding, .segments = 3}));

    Stage stage{.scene = RayScene(std::move(parts)),
                .per_mm = static_cast<float>(placement.scale),
                .printed_behind = std::move(behind),
                .passes_through = passes_through_itself(result)};
    float lowest = 1.0F;
    for (const Relief& part : stage.scene.parts())
        for (const Triangle& t : part.triangles)
            for (const int v : t) {
                const Vec3f p = part.positions[v].cast<float>();
                lowest = std::min(lowest, p.z());
                if (&part != &stage.scene.parts()[1]) stage.outline.push_back(p);
            }
    stage.ground = lowest - 0.004F;
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        const Triangle& tri = mesh.triangles[t];
        const double area =
            0.5 * (positions[tri[1]] - positions[tri[0]]).cross(positions[tri[2]] - positions[tri[0]]).norm();
        const double printed = std::abs(layout_area(mesh, t));
        const double ratio = printed > 0.0 ? std::sqrt(area / printed) : 1.0;
        stage.stretch.push_back(std::isfinite(ratio) && ratio > 0.0 ? static_cast<float>(ratio) : 1.0F);
    }
    return stage;
}

Surfel look_at(const Stage& stage, const Ray& ray, const RayHit& hit, float pixel) {
    const Relief& part = stage.scene.parts()[hit.part];
    const Triangle& tri = part.triangles[hit.triangle];
    Vec3f corner[3], normal[3];
    Vec2f layout[3];
    for (int i = 0; i < 3; ++i) {
        corner[i] = part.positions[tri[i]].cast<float>();
        normal[i] = part.normals[tri[i]].cast<float>();
        layout[i] = part.layout[tri[i]].cast<float>();
    }
    const Vec3f weights(1.0F - hit.u - hit.v, hit.u, hit.v);
    Vec3f flat = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
    Vec3f smooth = weights[0] * normal[0] + weights[1] * normal[1] + weights[2] * normal[2];
    const bool inside = flat.dot(ray.direction) > 0.0F;
    if (inside) flat = -flat;
    if (inside)
        for (Vec3f& n : normal) n = -n;
    if (inside) smooth = -smooth;
    smooth = smooth.squaredNorm() > 1e-12F ? Vec3f(smooth.normalized()) : flat;

    Surfel surfel;
    surfel.look = static_cast<Look>(hit.part);
    surfel.position = weights[0] * corner[0] + weights[1] * corner[1] + weights[2] * corner[2];
    surfel.lifted = lift(surfel.position, weights, corner, normal);
    surfel.normal = smooth;
    surfel.albedo = plain_albedo(surfel.look);
    const int source = part.source[hit.triangle];
    if (!stage.tint.empty()) {
        surfel.albedo = stage.tint[source];
        return surfel;
    }
    if (stage.passes_through[source] != 0) {
        surfel.albedo = linear(palette::alarm);
        return surfel;
    }
    if (!surfel.is_fabric()) return surfel;

    if (surfel.look == Look::fabric_front && stage.printed_behind[source] != 0)
        surfel.albedo = 0.62F * surfel.albedo + 0.1F * plain_albedo(Look::plastic_back);
    // Stitches per picture element decide how much of the knit can be shown without moire.
    const float stitch = wale_mm * stage.stretch[source] * stage.per_mm / pixel;
    const float visible = std::clamp((stitch - 3.0F) / 4.0F, 0.0F, 1.0F);
    if (visible <= 0.0F) return surfel;
    const Vec2f at = weights[0] * layout[0] + weights[1] * layout[1] + weights[2] * layout[2];
    const KnitSample k = knit_at(at);
    const Tangents tangents = layout_tangents(corner, layout);
    surfel.albedo *= 1.0F + 0.30F * visible * (k.height - knit_mean);
    surfel.normal =
        (smooth - 0.10F * visible * (k.slope.x() * tangents.x + k.slope.y() * tangents.y)).normalized();
    return surfel;
}

}  // namespace ruche
