#include "ruche/study/scan/scan_comparison.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>

#include "ruche/core/error.hpp"
#include "ruche/core/parallel.hpp"
#include "ruche/study/scan/skin.hpp"

namespace ruche {
namespace {

struct Unit {
    const char* name;
    double mm;
};
constexpr std::array units = {Unit{"mm", 1.0}, Unit{"cm", 10.0}, Unit{"m", 1000.0}, Unit{"inch", 25.4}};

/// Evenly over the scan's triangles, or its points where it has none.
std::vector<Vec3> sampled(const RawMesh& scan) {
    constexpr int wanted = 100000;
    std::vector<Vec3> points;
    if (scan.triangles.empty()) {
        const std::size_t step = std::max<std::size_t>(1, scan.vertices.size() / wanted);
        for (std::size_t i = 0; i < scan.vertices.size(); i += step) points.push_back(scan.vertices[i]);
        return points;
    }
    std::vector<double> upto;
    double area = 0.0;
    const auto corner = [&](std::size_t t, int k) -> const Vec3& {
        return scan.vertices[static_cast<std::size_t>(scan.triangles[t][static_cast<std::size_t>(k)])];
    };
    for (std::size_t t = 0; t < scan.triangles.size(); ++t) {
        area += 0.5 * (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).norm();
        upto.push_back(area);
    }
    std::mt19937 random(1);
    const auto roll = [&] { return static_cast<double>(random()) * 0x1p-32; };
    for (int i = 0; i < wanted && area > 0.0; ++i) {
        const auto found = std::upper_bound(upto.begin(), upto.end(), roll() * area);
        const auto t = static_cast<std::size_t>(std::min(found, upto.end() - 1) - upto.begin());
        double u = roll();
        double v = roll();
        if (u + v > 1.0) {
            u = 1.0 - u;
            v = 1.0 - v;
        }
        points.emplace_back((1.0 - u - v) * corner(t, 0) + u * corner(t, 1) + v * corner(t, 2));
    }
    return points;
}

/// Of points around their middle: root mean square.
double size_of(std::span<const Vec3> points) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : points) middle += p / static_cast<double>(points.size());
    double sum = 0.0;
    for (const Vec3& p : points) sum += (p - middle).squaredNorm();
    return std::sqrt(sum / static_cast<double>(points.size()));
}

const Unit& unit_named(const std::string& name) {
    for (const Unit& unit : units)
        if (name == unit.name) return unit;
    throw InputError({.key = "--unit"}, fmt::format("\"{}\" is none of mm, cm, m, inch", name));
}

/// In which the scan is nearest in size to the sheet. A part of it is smaller, never much larger.
const Unit& guessed_unit(double scan, double sheet) {
    constexpr double least = 0.15;
    constexpr double most = 1.6;
    const Unit* best = nullptr;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Unit& unit : units) {
        const double ratio = scan * unit.mm / sheet;
        if (ratio < least || ratio > most || std::abs(std::log(ratio)) >= nearest) continue;
        nearest = std::abs(std::log(ratio));
        best = &unit;
    }
    if (best == nullptr)
        throw InputError(
            {.key = "scan"},
            fmt::format("the scan's size, {:.4g} in its own unit, does not go with the sheet's {:.4g} mm "
                        "in mm, cm, m or inch",
                        scan, sheet),
            "Sizes are root mean square distances from the middle. Is it a scan of this shape? Say its "
            "unit with --unit.");
    return *best;
}

/// The surface to put the scan on: one skin or both, one after the other.
SurfaceSearch surface_of(Skin skin, const std::vector<Corners>& front, const std::vector<Corners>& back) {
    std::vector<Corners> triangles;
    if (skin != Skin::back) triangles = front;
    if (skin != Skin::front) triangles.insert(triangles.end(), back.begin(), back.end());
    return SurfaceSearch(std::move(triangles));
}

/// Puts the scan on both skins first. Then, unless it was said, decides which one the scanner has seen. What
/// is of one side fits that clearly better than the other, and nearly as well as both: noise brings some
/// points nearer to the wrong one. What is of both sides fits neither. The skins have the print's sides here.
std::pair<Skin, Registration> skin_found(const std::vector<Vec3>& points, const ScanOptions& options,
                                         const RegistrationOptions& how, const std::vector<Corners>& front,
                                         const std::vector<Corners>& back, const Control& control) {
    if (options.skin != Skin::automatic)
        return {options.skin, register_scan(points, surface_of(options.skin, front, back), how, control)};
    const Registration both = register_scan(points, surface_of(Skin::both, front, back), how, control);
    const auto on = [&](Skin skin) {
        return std::pair(skin, refine_registration(points, surface_of(skin, front, back), how, both));
    };
    std::pair<Skin, Registration> better = on(Skin::front);
    std::pair<Skin, Registration> worse = on(Skin::back);
    if (worse.second.rms < better.second.rms) std::swap(better, worse);
    constexpr double clearly = 0.9;
    constexpr double nearly = 1.8;  // half a fabric's thickness of noise does that
    constexpr double least = 1e-3;  // mm
    const bool one_side =
        better.second.rms < clearly * worse.second.rms && better.second.rms <= nearly * both.rms + least;
    return one_side ? better : std::pair(Skin::both, both);
}

std::pair<Skin, Registration> placed(const std::vector<Vec3>& points, const ScanOptions& options,
                                     const Result& result, std::vector<Corners> front,
                                     std::vector<Corners> back, const Control& control) {
    for (std::vector<Corners>* skin : {&front, &back}) {
        const std::vector<Corners> sides = sides_of_print(result, *skin);
        skin->insert(skin->end(), sides.begin(), sides.end());
    }
    RegistrationOptions how{.free_scale = options.free_scale, .kept = options.kept};
    const auto [skin, found] = skin_found(points, options, how, front, back, control);
    how.most_points = points.size();
    return {skin, refine_registration(points, surface_of(skin, front, back), how, found)};
}

/// A point of the scan: where it is nearest to the sheet, and how far from it; positive outside.
struct Measured {
    int triangle = -1;  // of the layout
    std::array<double, 3> weights = {};
    double distance = 0.0;
};

std::vector<Measured> measure(const std::vector<Vec3>& points, Skin skin, const std::vector<Corners>& front,
                              const std::vector<Corners>& back) {
    const SurfaceSearch surface = surface_of(skin, front, back);
    const int triangles = static_cast<int>(front.size());
    std::vector<Measured> measured(points.size());
    parallel_for(points.size(), [&](std::size_t i) {
        const SurfaceHit hit = surface.nearest(points[i]);
        const Corners& corners = surface.triangles()[static_cast<std::size_t>(hit.triangle)];
        const bool on_back = skin == Skin::back || hit.triangle >= triangles;
        const Vec3 towards_front = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        const Vec3 apart = points[i] - hit.point;
        const bool outside = (apart.dot(towards_front) > 0.0) != on_back;
        measured[i] = {hit.triangle % triangles, hit.weights, outside ? apart.norm() : -apart.norm()};
    });
    return measured;
}

void add_numbers(ScanComparison& comparison, const std::vector<Measured>& measured) {
    const auto count = static_cast<double>(measured.size());
    std::vector<double> sizes;
    double squares = 0.0;
    double sum = 0.0;
    for (const Measured& point : measured) {
        sizes.push_back(std::abs(point.distance));
        squares += point.distance * point.distance;
        sum += point.distance;
    }
    comparison.points = static_cast<int>(measured.size());
    comparison.rms = std::sqrt(squares / count);
    comparison.mean = sum / count;
    std::sort(sizes.begin(), sizes.end());
    for (const double percent : {50.0, 75.0, 90.0, 95.0, 99.0, 100.0}) {
        const auto rank = static_cast<std::size_t>(std::ceil(0.01 * percent * count));
        comparison.percentiles.emplace_back(percent, sizes[std::max<std::size_t>(rank, 1) - 1]);
    }
}

/// The mean at each vertex over the points around it, by their weights.
void add_map(ScanComparison& comparison, const Result& result, const std::vector<Measured>& measured) {
    std::vector<double> sum(result.shape.size(), 0.0);
    std::vector<double> weight(result.shape.size(), 0.0);
    for (const Measured& point : measured) {
        const Triangle& corners = result.layout.mesh.triangles[static_cast<std::size_t>(point.triangle)];
        for (std::size_t k = 0; k < 3; ++k) {
            sum[static_cast<std::size_t>(corners[k])] += point.weights[k] * point.distance;
            weight[static_cast<std::size_t>(corners[k])] += point.weights[k];
        }
    }
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t v = 0; v < sum.size(); ++v) {
        comparison.vertex_distance.push_back(weight[v] > 0.0 ? sum[v] / weight[v] : nothing);
        comparison.covered += weight[v] > 0.0 ? 1.0 / static_cast<double>(sum.size()) : 0.0;
    }
}

}  // namespace

std::string_view name_of(Skin skin) {
    constexpr std::array<std::string_view, 4> names = {"automatic", "front", "back", "both"};
    return names[static_cast<std::size_t>(skin)];
}

ScanComparison compare_with_scan(const Result& result, const SurfaceFields& fields, const RawMesh& scan,
                                 const ScanOptions& options, const Control& control) {
    ScanComparison comparison;
    std::vector<Vec3> points = sampled(scan);
    const double size = size_of(points);  // not a number without points, as triangles without area have none
    if (!(size > 0.0 && std::isfinite(size)))
        throw InputError({.key = "the scan"}, "has no extent: its points or triangles are all in one place",
                         "Is it complete?");
    const Unit& unit =
        options.unit.empty() ? guessed_unit(size, size_of(result.shape)) : unit_named(options.unit);
    comparison.unit = unit.name;
    comparison.unit_mm = unit.mm;
    comparison.unit_guessed = options.unit.empty();
    for (Vec3& p : points) p *= unit.mm;

    const std::vector<Corners> front = front_skin(result, fields);
    const std::vector<Corners> back = back_skin(result, fields);
    std::tie(comparison.skin, comparison.registration) =
        placed(points, options, result, front, back, control);
    for (Vec3& p : points) p = comparison.registration.placing(p);
    const std::vector<Measured> measured = measure(points, comparison.skin, front, back);
    add_numbers(comparison, measured);
    add_map(comparison, result, measured);

    constexpr double ambiguous = 1.3;
    const double runner_up = comparison.registration.runner_up;
    if (runner_up > 0.0 && runner_up < ambiguous)
        comparison.warnings.push_back(
            fmt::format("another way to put the scan on the sheet fits nearly as well ({:.2f} times the "
                        "distance): the shape "
                        "may be symmetric, and strips can be mistaken for each other",
                        runner_up));
    return comparison;
}

std::string to_json(const ScanComparison& comparison, const std::string& scan) {
    nlohmann::ordered_json json;
    json["scan"] = scan;
    json["unit"] = comparison.unit;
    json["unit_guessed"] = comparison.unit_guessed;
    json["skin"] = name_of(comparison.skin);
    json["points"] = comparison.points;
    json["rms_mm"] = comparison.rms;
    json["mean_mm"] = comparison.mean;
    for (const auto& [percent, value] : comparison.percentiles)
        json["percentiles_mm"][fmt::format("{:g}", percent)] = value;
    json["covered"] = comparison.covered;
    const Placing& placing = comparison.registration.placing;
    json["placing"]["scale"] = placing.scale;
    for (int row = 0; row < 3; ++row) {
        json["placing"]["translation_mm"].push_back(placing.translation[row]);
        for (int column = 0; column < 3; ++column)
            json["placing"]["rotation"].push_back(placing.rotation(row, column));
    }
    json["warnings"] = comparison.warnings;
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace ruche
