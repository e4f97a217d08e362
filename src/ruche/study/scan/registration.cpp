#include "ruche/study/scan/registration.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "ruche/core/parallel.hpp"

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

class Matcher {
  public:
    /// `rims`: whether points beyond a rim pull. They bring a scan onto the sheet from afar, but then noise
    /// pulls it inwards at the rims that it has, and at a cut it has none (Turk, Levoy 1994 leave them out,
    /// too).
    Matcher(const SurfaceSearch& surface, const RegistrationOptions& options, bool rims)
        : surface_(surface), options_(options), rims_(rims) {}

    /// Iterates from a start until it stands still.
    Candidate settle(const std::vector<Vec3>& points, Candidate at, int iterations) const {
        constexpr double still = 1e-7;  // of the shape's size
        for (int i = 0; i < iterations; ++i) {
            const Candidate next = step(points, at);
            const double change = std::abs(at.rms - next.rms);
            at = next;
            if (change <= still * at.rms) break;
        }
        return {at.placing, rms(points, at.placing)};
    }

    double rms(const std::vector<Vec3>& points, const Placing& placing) const {
        std::vector<double> squared(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec3 p = placing(points[i]);
            squared[i] = (surface_.nearest(p).point - p).squaredNorm();
        }
        const std::size_t kept = kept_of(points.size());
        std::nth_element(squared.begin(), squared.begin() + static_cast<std::ptrdiff_t>(kept) - 1,
                         squared.end());
        return std::sqrt(
            std::accumulate(squared.begin(), squared.begin() + static_cast<std::ptrdiff_t>(kept), 0.0) /
            static_cast<double>(kept));
    }

  private:
    struct Pair {
        Vec3 point;
        Vec3 target;
        Vec3 direction;  // in which the distance counts
        double squared;
    };

    std::size_t kept_of(std::size_t count) const {
        return std::max<std::size_t>(6, static_cast<std::size_t>(options_.kept * static_cast<double>(count)));
    }

    std::vector<Pair> kept_pairs(const std::vector<Vec3>& points, const Placing& placing) const {
        std::vector<Pair> pairs(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec3 p = placing(points[i]);
            const SurfaceHit hit = surface_.nearest(p);
            const Vec3 apart = p - hit.point;
            const Vec3 normal = normal_of(surface_.triangles()[static_cast<std::size_t>(hit.triangle)]);
            // Beyond a rim the way back is not along the normal.
            const bool inside = std::abs(apart.dot(normal)) > 0.9 * apart.norm() || apart.norm() < 1e-9;
            const Vec3 direction = inside ? normal : rims_ ? Vec3(apart.normalized()) : Vec3(Vec3::Zero());
            pairs[i] = {p, hit.point, direction, apart.squaredNorm()};
        }
        const std::size_t kept = kept_of(points.size());
        std::nth_element(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(kept) - 1, pairs.end(),
                         [](const Pair& a, const Pair& b) { return a.squared < b.squared; });
        pairs.resize(kept);
        return pairs;
    }

    Candidate step(const std::vector<Vec3>& points, const Candidate& at) const {
        const std::vector<Pair> pairs = kept_pairs(points, at.placing);
        Vec3 middle = Vec3::Zero();
        for (const Pair& pair : pairs) middle += pair.point / static_cast<double>(pairs.size());
        double size = 0.0;
        double sum = 0.0;
        Eigen::Matrix<double, 7, 7> normal = Eigen::Matrix<double, 7, 7>::Zero();
        Eigen::Matrix<double, 7, 1> right = Eigen::Matrix<double, 7, 1>::Zero();
        for (const Pair& pair : pairs) {
            const Vec3 arm = pair.point - middle;
            Eigen::Matrix<double, 7, 1> row;
            row << arm.cross(pair.direction), pair.direction,
                options_.free_scale ? arm.dot(pair.direction) : 0.0;
            normal += row * row.transpose();
            right += row * pair.direction.dot(pair.target - pair.point);
            size += arm.squaredNorm();
            sum += pair.squared;
        }
        // A shape that slides along itself leaves directions free: they stay where they are.
        const double damping = 1e-6 * static_cast<double>(pairs.size());
        normal.diagonal().head<3>().array() += damping * size / static_cast<double>(pairs.size());
        normal.diagonal().segment<3>(3).array() += damping;
        normal(6, 6) += options_.free_scale ? damping * size / static_cast<double>(pairs.size()) : 1.0;
        const Eigen::Matrix<double, 7, 1> change = normal.ldlt().solve(right);
        return {moved(at.placing, change, middle), std::sqrt(sum / static_cast<double>(pairs.size()))};
    }

    const SurfaceSearch& surface_;
    RegistrationOptions options_;
    bool rims_;
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
    constexpr std::size_t most = 40000;
    constexpr int iterations = 60;
    const Candidate end =
        Matcher(surface, options, false).settle(thinned(scan, most), {start.placing, start.rms}, iterations);
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
    const Matcher matcher(surface, rigid, true);
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
