#include "ruche/study/scan/registration.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "ruche/core/parallel.hpp"
#include "ruche/study/scan/creases.hpp"

namespace ruche {
namespace {

struct Candidate {
    Placing placing;
    double rms = infinity_rms;
    static constexpr double infinity_rms = std::numeric_limits<double>::infinity();
};

/// Where points lie and how they spread.
struct PointSpread {
    Vec3 middle = Vec3::Zero();
    Mat3 axes = Mat3::Identity();  // columns, right-handed, shortest first
};

PointSpread spread_of(std::span<const Vec3> points) {
    PointSpread spread;
    for (const Vec3& p : points) spread.middle += p / static_cast<double>(points.size());
    Mat3 moments = Mat3::Zero();
    for (const Vec3& p : points) moments += (p - spread.middle) * (p - spread.middle).transpose();
    spread.axes = Eigen::SelfAdjointEigenSolver<Mat3>(moments).eigenvectors();
    if (spread.axes.determinant() < 0.0) spread.axes.col(0) *= -1.0;
    return spread;
}

/// The 24 ways in which right-handed axes can be put onto right-handed axes.
std::vector<Mat3> axis_turns() {
    std::vector<Mat3> turns;
    std::array<int, 3> order = {0, 1, 2};
    do {
        for (int signs = 0; signs < 8; ++signs) {
            Mat3 turn = Mat3::Zero();
            for (int k = 0; k < 3; ++k) turn(order[k], k) = (signs >> k & 1) != 0 ? -1.0 : 1.0;
            if (turn.determinant() > 0.0) turns.push_back(turn);
        }
    } while (std::next_permutation(order.begin(), order.end()));
    return turns;
}

/// Every so-manieth of a list.
std::vector<Vec3> thinned(std::span<const Vec3> points, std::size_t wanted) {
    std::vector<Vec3> few;
    const double step = std::max(1.0, static_cast<double>(points.size()) / static_cast<double>(wanted));
    for (double i = 0.0; i < static_cast<double>(points.size()); i += step)
        few.push_back(points[static_cast<std::size_t>(i)]);
    return few;
}

/// Points of the surface far from each other, the first one nearest to its middle (Gonzalez 1985).
std::vector<Vec3> far_apart(const std::vector<Vec3>& points, const Vec3& middle, std::size_t wanted) {
    std::vector<Vec3> chosen = {middle};
    std::vector<double> distance(points.size(), std::numeric_limits<double>::max());
    while (chosen.size() < wanted) {
        std::size_t farthest = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            distance[i] = std::min(distance[i], (points[i] - chosen.back()).squaredNorm());
            if (distance[i] > distance[farthest]) farthest = i;
        }
        chosen.push_back(points[farthest]);
    }
    return chosen;
}

Vec3 normal_of(const Corners& t) { return (t[1] - t[0]).cross(t[2] - t[0]).normalized(); }

/// Moves a placing by a small turn about `middle`, a shift and a change of scale.
Placing moved(const Placing& placing, const Eigen::Matrix<double, 7, 1>& step, const Vec3& middle) {
    const Vec3 turn = step.head<3>();
    const double angle = turn.norm();
    Mat3 rotation = Mat3::Identity();
    if (angle > 0.0) rotation = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
    const double scale = std::exp(step[6]);
    return {.scale = scale * placing.scale,
            .rotation = rotation * placing.rotation,
            .translation = scale * (rotation * (placing.translation - middle)) + middle + step.segment<3>(3)};
}

/// A point of the scan and where it belongs.
struct Pair {
    Vec3 point = Vec3::Zero();
    Vec3 target = Vec3::Zero();
    Vec3 direction = Vec3::Zero();  // in which the distance counts
    double squared = 0.0;
    double weight = 1.0;
    bool beyond_rim = false;  // there the way back is not along the normal
};

/// Finds for points of a scan where they are on a surface, and moves the scan there.
class Matcher {
  public:
    Matcher(const SurfaceSearch& surface, const RegistrationOptions& options)
        : surface_(surface), options_(options) {}

    /// Iterates from a start until it stands still, with the kept share of the points. Those beyond a rim
    /// pull as well: they bring a scan onto the sheet from afar.
    Candidate settle(const std::vector<Vec3>& points, Candidate at, int iterations) const {
        constexpr double still = 1e-7;  // of the shape's size
        for (int i = 0; i < iterations; ++i) {
            std::vector<Pair> pairs = pairs_of(points, at.placing);
            trim(pairs);
            const double rms = rms_of(pairs);
            const bool ends = std::abs(at.rms - rms) <= still * rms;
            at = {moved_to(pairs, at.placing).placing, rms};
            if (ends) break;
        }
        return {at.placing, rms(points, at.placing)};
    }

    /// The last word, of many points: all count, by Tukey's biweight, which gives away 5 % of what normal
    /// noise lets know where leaving out a tenth by its distance gives away 44 % (of the variance). Points
    /// beyond a rim do not: noise pulls them inwards at the rims that the scan has, and at a cut it has none
    /// (Turk, Levoy 1994 leave them out, too). Nor do those near an edge, where noise makes a point of one
    /// side one of the other: by half a deviation, a trade between that bias and what is left to go by. Where
    /// noise is as large as the print's parts, so that hardly any would be left, they count.
    Candidate polish(const std::vector<Vec3>& points, Candidate at, int iterations) const {
        constexpr double sharp = 0.5;  // radians
        const std::vector<Corners> creases = creases_of(surface_.triangles(), sharp);
        std::optional<SurfaceSearch> edges;
        if (!creases.empty()) edges.emplace(creases);
        for (int i = 0; i < iterations; ++i) {
            std::vector<Pair> pairs = pairs_of(points, at.placing);
            const double deviation = weigh(pairs);
            if (edges) leave_out_near(*edges, 0.5 * deviation, pairs);
            const Moved next = moved_to(pairs, at.placing);
            at.placing = next.placing;
            constexpr double least = 1e-5;  // mm
            if (next.largest < std::max(least, 2e-3 * deviation)) break;
        }
        return {at.placing, rms(points, at.placing)};
    }

    /// Of the kept share.
    double rms(const std::vector<Vec3>& points, const Placing& placing) const {
        std::vector<Pair> pairs = pairs_of(points, placing);
        trim(pairs);
        return rms_of(pairs);
    }

  private:
    struct Moved {
        Placing placing;
        double largest = 0.0;  // by which a point has moved, about, mm
    };

    std::size_t kept_of(std::size_t count) const {
        return std::max<std::size_t>(6, static_cast<std::size_t>(options_.kept * static_cast<double>(count)));
    }

    static double rms_of(const std::vector<Pair>& pairs) {
        double sum = 0.0;
        for (const Pair& pair : pairs) sum += pair.squared;
        return std::sqrt(sum / static_cast<double>(pairs.size()));
    }

    std::vector<Pair> pairs_of(const std::vector<Vec3>& points, const Placing& placing) const {
        std::vector<Pair> pairs(points.size());
        parallel_for(points.size(), [&](std::size_t i) {
            const Vec3 p = placing(points[i]);
            const SurfaceHit hit = surface_.nearest(p);
            const Vec3 apart = p - hit.point;
            const Vec3 normal = normal_of(surface_.triangles()[static_cast<std::size_t>(hit.triangle)]);
            const bool beyond = std::abs(apart.dot(normal)) <= 0.9 * apart.norm() && apart.norm() >= 1e-9;
            pairs[i] = {.point = p,
                        .target = hit.point,
                        .direction = beyond ? Vec3(apart.normalized()) : normal,
                        .squared = apart.squaredNorm(),
                        .beyond_rim = beyond};
        });
        return pairs;
    }

    static void sort_nearest_first(std::vector<Pair>& pairs, std::size_t count) {
        std::nth_element(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(count) - 1, pairs.end(),
                         [](const Pair& a, const Pair& b) { return a.squared < b.squared; });
    }

    void trim(std::vector<Pair>& pairs) const {
        const std::size_t kept = kept_of(pairs.size());
        sort_nearest_first(pairs, kept);
        pairs.resize(kept);
    }

    /// Returns the deviation of the noise, by the median of the distances.
    double weigh(std::vector<Pair>& pairs) const {
        const std::size_t half = kept_of(pairs.size()) / 2;
        sort_nearest_first(pairs, half);
        constexpr double least = 1e-6;  // mm: a scan without noise
        const double deviation = std::max(least, 1.4826 * std::sqrt(pairs[half - 1].squared));
        const double far = 4.685 * deviation;
        for (Pair& pair : pairs) {
            const double share = 1.0 - pair.squared / (far * far);
            pair.weight = pair.beyond_rim || share <= 0.0 ? 0.0 : share * share;
        }
        return deviation;
    }

    static void leave_out_near(const SurfaceSearch& edges, double distance, std::vector<Pair>& pairs) {
        constexpr double enough = 0.2;  // of those that count
        std::vector<double> weights(pairs.size());
        parallel_for(pairs.size(), [&](std::size_t i) {
            const Pair& pair = pairs[i];
            const bool near = (edges.nearest(pair.target).point - pair.target).norm() < distance;
            weights[i] = near ? 0.0 : pair.weight;
        });
        const auto counting =
            std::ranges::count_if(pairs, [](const Pair& pair) { return pair.weight > 0.0; });
        const auto clear = std::ranges::count_if(weights, [](double weight) { return weight > 0.0; });
        if (static_cast<double>(clear) < enough * static_cast<double>(counting)) return;
        for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i].weight = weights[i];
    }

    Moved moved_to(const std::vector<Pair>& pairs, const Placing& placing) const {
        double count = 1e-300;
        Vec3 middle = Vec3::Zero();
        for (const Pair& pair : pairs) {
            middle += pair.weight * pair.point;
            count += pair.weight;
        }
        middle /= count;
        double size = 0.0;
        Eigen::Matrix<double, 7, 7> normal = Eigen::Matrix<double, 7, 7>::Zero();
        Eigen::Matrix<double, 7, 1> right = Eigen::Matrix<double, 7, 1>::Zero();
        for (const Pair& pair : pairs) {
            const Vec3 arm = pair.point - middle;
            Eigen::Matrix<double, 7, 1> row;
            row << arm.cross(pair.direction), pair.direction,
                options_.free_scale ? arm.dot(pair.direction) : 0.0;
            normal += pair.weight * row * row.transpose();
            right += pair.weight * row * pair.direction.dot(pair.target - pair.point);
            size += pair.weight * arm.squaredNorm() / count;
        }
        // A shape that slides along itself leaves directions free: they stay where they are.
        const double damping = 1e-6 * count;
        normal.diagonal().head<3>().array() += damping * size;
        normal.diagonal().segment<3>(3).array() += damping;
        normal(6, 6) += options_.free_scale ? damping * size : 1.0;
        const Eigen::Matrix<double, 7, 1> change = normal.ldlt().solve(right);
        const double largest =
            change.segment<3>(3).norm() + std::sqrt(size) * (change.head<3>().norm() + std::abs(change[6]));
        return {moved(placing, change, middle), largest};
    }

    const SurfaceSearch& surface_;
    RegistrationOptions options_;
};

std::vector<Candidate> starts(std::span<const Vec3> scan, const std::vector<Vec3>& surface) {
    constexpr std::size_t places = 10;
    const PointSpread from = spread_of(scan);
    const PointSpread to = spread_of(surface);
    std::vector<Candidate> list;
    for (const Vec3& place : far_apart(surface, to.middle, places)) {
        // Half way out: a part's middle lies between the whole's and its rim.
        const Vec3 target = 0.5 * (place + to.middle);
        for (const Mat3& turn : axis_turns()) {
            Placing placing;
            placing.rotation = to.axes * turn * from.axes.transpose();
            placing.translation = target - placing.rotation * from.middle;
            list.push_back({placing, Candidate::infinity_rms});
        }
    }
    return list;
}

/// Settles all and keeps the best, one of each kind.
void select(std::vector<Candidate>& list, const Matcher& matcher, const std::vector<Vec3>& points,
            int iterations, std::size_t best) {
    parallel_for(list.size(), [&](std::size_t i) { list[i] = matcher.settle(points, list[i], iterations); });
    std::stable_sort(list.begin(), list.end(),
                     [](const Candidate& a, const Candidate& b) { return a.rms < b.rms; });
    list.resize(std::min(best, list.size()));
}

bool same_place(const Placing& a, const Placing& b, std::span<const Vec3> points, double tolerance) {
    double sum = 0.0;
    for (const Vec3& p : points) sum += (a(p) - b(p)).squaredNorm();
    return sum < tolerance * tolerance * static_cast<double>(points.size());
}

}  // namespace

Registration refine_registration(std::span<const Vec3> scan, const SurfaceSearch& surface,
                                 const RegistrationOptions& options, const Registration& start) {
    constexpr int iterations = 60;
    constexpr std::size_t some = 4000;
    const Matcher matcher(surface, options);
    const std::vector<Vec3> few = thinned(scan, some);
    const Candidate settled = matcher.settle(few, {start.placing, start.rms}, iterations);
    const std::vector<Vec3> points = thinned(scan, options.most_points);
    Candidate end = matcher.polish(points, settled, iterations);
    // Where a sheet can slide along itself only its rims hold it: then they have the last word.
    constexpr double worse = 1.1;
    constexpr double least = 1e-6;  // mm
    if (matcher.rms(few, end.placing) > worse * settled.rms + least)
        end = {settled.placing, matcher.rms(points, settled.placing)};
    return {.placing = end.placing, .rms = end.rms, .runner_up = start.runner_up};
}

Registration register_scan(std::span<const Vec3> scan, const SurfaceSearch& surface,
                           const RegistrationOptions& options, const Control& control) {
    std::vector<Vec3> middles;
    for (const Corners& t : surface.triangles()) middles.emplace_back((t[0] + t[1] + t[2]) / 3.0);
    constexpr std::size_t target_points = 2000;
    std::vector<Candidate> list = starts(scan, thinned(middles, target_points));
    RegistrationOptions rigid = options;
    rigid.free_scale = false;  // from afar a scan that may shrink shrinks to a point
    const Matcher matcher(surface, rigid);
    struct Round {
        std::size_t points;
        int iterations;
        std::size_t best;
    };
    constexpr std::array rounds = {Round{120, 12, 40}, Round{400, 30, 8}, Round{2000, 60, 4}};
    for (std::size_t i = 0; i < rounds.size(); ++i) {
        control.say({"register", static_cast<double>(i) / (rounds.size() + 1.0),
                     fmt::format("{} placings of the scan", list.size())});
        select(list, matcher, thinned(scan, rounds[i].points), rounds[i].iterations, rounds[i].best);
    }
    Registration result = refine_registration(scan, surface, options,
                                              {.placing = list.front().placing, .rms = list.front().rms});
    const std::vector<Vec3> few = thinned(scan, rounds[1].points);
    const double reference = matcher.rms(few, result.placing);
    const PointSpread spread = spread_of(few);
    double size = 0.0;
    for (const Vec3& p : few) size += (p - spread.middle).squaredNorm() / static_cast<double>(few.size());
    for (const Candidate& other : list) {
        if (same_place(other.placing, result.placing, few, 0.1 * std::sqrt(size))) continue;
        result.runner_up = matcher.rms(few, other.placing) / std::max(reference, 1e-12);
        break;
    }
    return result;
}

}  // namespace ruche
