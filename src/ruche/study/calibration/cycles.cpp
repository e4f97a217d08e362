#include "ruche/study/calibration/cycles.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <span>

namespace ruche {
namespace {

/// Rows where the displacement turns, the first and the last row included.
std::vector<std::size_t> turns(const std::vector<double>& d) {
    const auto [low, high] = std::minmax_element(d.begin(), d.end());
    const double threshold = 0.1 * (*high - *low);
    std::vector<std::size_t> found{0};
    std::size_t extreme = 0;  // the farthest row in the present direction
    int direction = 0;
    for (std::size_t i = 1; i < d.size(); ++i) {
        const double from_extreme = d[i] - d[extreme];
        if (direction == 0) {
            if (std::abs(d[i] - d[0]) > threshold) {
                direction = d[i] > d[0] ? 1 : -1;
                extreme = i;
            }
        } else if (from_extreme * direction > 0.0 || (from_extreme == 0.0 && direction > 0)) {
            // A hold belongs to loading: at the top to the one before, at the bottom to the one that follows.
            extreme = i;
        } else if (-from_extreme * direction > threshold) {
            found.push_back(extreme);
            direction = -direction;
            extreme = i;
        }
    }
    if (extreme != found.back()) found.push_back(extreme);
    // What moves on a little beyond the last turn (a pause at the end) belongs to the last branch.
    if (found.size() > 1 && direction < 0) found.back() = d.size() - 1;
    return found;
}

std::vector<Cycle> noted_cycles(const TestRecord& record) {
    std::vector<Cycle> cycles;
    const std::size_t count = record.size();
    for (std::size_t i = 0; i < count;) {
        Cycle cycle{.begin = i};
        while (i < count && record.branch[i] != Branch::unloading) ++i;
        cycle.peak = i > cycle.begin ? i - 1 : i;
        while (i < count && record.branch[i] == Branch::unloading) ++i;
        cycle.end = i;
        cycle.unloads = cycle.end > cycle.peak + 1;
        cycles.push_back(cycle);
    }
    return cycles;
}

}  // namespace

std::vector<Cycle> find_cycles(const TestRecord& record) {
    const bool noted = std::any_of(record.branch.begin(), record.branch.end(),
                                   [](Branch b) { return b == Branch::unloading; });
    if (noted) return noted_cycles(record);
    const std::vector<double>& d = record.displacement;
    std::vector<Cycle> cycles;
    if (d.size() < 2) return cycles;
    std::vector<std::size_t> at = turns(d);
    if (at.size() < 2) return cycles;
    std::size_t i = 0;
    if (d[at[1]] < d[at[0]]) {
        cycles.push_back({.begin = at[0], .peak = at[0], .end = at[1] + 1});
        i = 1;
    }
    for (; i + 1 < at.size(); i += 2) {
        Cycle cycle{.begin = at[i], .peak = at[i + 1], .end = at[i + 1] + 1};
        if (i + 2 < at.size()) cycle.end = at[i + 2] + 1;
        cycles.push_back(cycle);
    }
    for (Cycle& cycle : cycles) {
        const double up = d[cycle.peak] - std::min(d[cycle.begin], d[cycle.end - 1]);
        cycle.unloads = cycle.end > cycle.peak + 1 && d[cycle.peak] - d[cycle.end - 1] >= 0.5 * up;
    }
    return cycles;
}

namespace {

/// The beginning of a loading: displacement from its first row, and force.
struct Toe {
    std::vector<double> way, force;
};

/// Up to where the force, smoothed over five rows, reaches a tenth of its largest; at most some hundred
/// rows.
Toe toe_of(const TestRecord& record, const Cycle& first) {
    const std::span<const double> force(record.force.data() + first.begin, first.peak - first.begin + 1);
    const double largest = *std::max_element(force.begin(), force.end());
    std::size_t end = 2;
    const auto smooth = [&](std::size_t i) {
        double sum = 0.0;
        for (std::size_t k = i - 2; k <= i + 2; ++k) sum += force[k] / 5.0;
        return sum;
    };
    while (end + 3 < force.size() && smooth(end) < 0.1 * largest) ++end;
    constexpr std::size_t most = 300;
    const std::size_t stride = std::max<std::size_t>(1, end / most);
    Toe toe;
    for (std::size_t i = 0; i <= end; i += stride) {
        toe.way.push_back(record.displacement[first.begin + i] - record.displacement[first.begin]);
        toe.force.push_back(force[i]);
    }
    return toe;
}

/// Sum of squares of the best f0 + k x + c x^2, x = max(0, way - onset), with k, c >= 0 in effect: a fit that
/// falls anywhere counts as none.
double sum_of_squares(const Toe& toe, double onset) {
    const auto count = static_cast<Eigen::Index>(toe.way.size());
    Eigen::MatrixXd a(count, 3);
    for (Eigen::Index i = 0; i < count; ++i) {
        const double x = std::max(0.0, toe.way[static_cast<std::size_t>(i)] - onset);
        a.row(i) = Eigen::RowVector3d(1.0, x, x * x);
    }
    const Eigen::Map<const Eigen::VectorXd> f(toe.force.data(), count);
    const Eigen::Vector3d c = a.colPivHouseholderQr().solve(f);
    return (a * c - f).squaredNorm();
}

}  // namespace

double slack_of(const TestRecord& record, const Cycle& first) {
    if (first.peak < first.begin + 10) return 0.0;
    const Toe toe = toe_of(record, first);
    const std::size_t count = toe.way.size();
    if (count < 8) return 0.0;
    const double without = sum_of_squares(toe, 0.0);
    double best = without;
    double slack = 0.0;
    for (std::size_t i = 1; i + 5 < count; ++i) {
        const double sum = sum_of_squares(toe, toe.way[i]);
        if (sum >= best) continue;
        best = sum;
        slack = toe.way[i];
    }
    // It has to explain the rows much better than a curve that bends from the start: by 25 times the variance
    // of a row, five standard deviations. That is the noise (second differences know nothing of the slope),
    // and the shape of the law, which is no parabola.
    double variance = 0.0;
    for (std::size_t i = 2; i < count; ++i)
        variance += std::pow(toe.force[i] - 2.0 * toe.force[i - 1] + toe.force[i - 2], 2.0) /
                    (6.0 * static_cast<double>(count - 2));
    constexpr double shape = 0.002;
    const double largest = *std::max_element(toe.force.begin(), toe.force.end());
    return without - best > 25.0 * (variance + std::pow(shape * largest, 2.0)) ? slack : 0.0;
}

std::vector<std::size_t> sudden_falls(const TestRecord& record, const Cycle& cycle) {
    std::vector<std::size_t> falls;
    const auto range = [](const std::vector<double>& v) {
        const auto [low, high] = std::minmax_element(v.begin(), v.end());
        return *high - *low;
    };
    const double step = range(record.displacement) / 50.0;
    const double fall = 0.1 * range(record.force);
    // A sample that is held at the peak relaxes.
    const double held = record.displacement[cycle.peak] - 0.25 * step;
    std::size_t from = cycle.begin;
    for (std::size_t i = cycle.begin + 1; i <= cycle.peak && i < record.size(); ++i) {
        if (record.displacement[i] > held) break;
        while (record.displacement[i] - record.displacement[from] > step && from + 1 < i) ++from;
        if (record.force[from] - record.force[i] < fall) continue;
        falls.push_back(i);
        from = i;
    }
    return falls;
}

}  // namespace ruche
