#include "ruche/study/calibration/cycles.hpp"

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
        } else if (from_extreme * direction >= 0.0) {
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
        // The last row that loads belongs to both branches.
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

double slack_of(const TestRecord& record, const Cycle& first) {
    if (first.peak <= first.begin + 10) return 0.0;
    const std::span<const double> force(record.force.data() + first.begin, first.peak - first.begin + 1);
    const double largest = *std::max_element(force.begin(), force.end());
    // Second differences know nothing of the slope.
    double noise = 0.0;
    const std::size_t beginning = force.size() / 5 + 3;
    for (std::size_t i = 2; i < beginning; ++i)
        noise += std::pow(force[i] - 2.0 * force[i - 1] + force[i - 2], 2.0) /
                 (6.0 * static_cast<double>(beginning - 2));
    noise = std::sqrt(noise);
    const double threshold = std::max(0.005 * largest, 4.0 * noise);
    std::size_t last_below = first.begin;
    bool began_slack = force[0] < threshold;
    for (std::size_t i = 0; i < force.size() && began_slack; ++i)
        if (force[i] < threshold) last_below = first.begin + i;
    // Back from where it is surely pulled along the slope there to where the force vanished.
    const std::size_t ahead = std::min(last_below + std::max<std::size_t>(3, force.size() / 20), first.peak);
    const double rise = record.force[ahead] - record.force[last_below];
    const double run = record.displacement[ahead] - record.displacement[last_below];
    double onset = record.displacement[last_below];
    if (rise > 0.0 && run > 0.0) onset -= std::max(record.force[last_below], 0.0) * run / rise;
    return std::max(onset - record.displacement[first.begin], 0.0);
}

std::vector<std::size_t> sudden_falls(const TestRecord& record, const Cycle& cycle) {
    std::vector<std::size_t> falls;
    const auto range = [](const std::vector<double>& v) {
        const auto [low, high] = std::minmax_element(v.begin(), v.end());
        return *high - *low;
    };
    const double step = range(record.displacement) / 50.0;
    const double fall = 0.1 * range(record.force);
    std::size_t from = cycle.begin;
    for (std::size_t i = cycle.begin + 1; i <= cycle.peak && i < record.size(); ++i) {
        while (record.displacement[i] - record.displacement[from] > step && from + 1 < i) ++from;
        if (record.force[from] - record.force[i] < fall) continue;
        falls.push_back(i);
        from = i;
    }
    return falls;
}

}  // namespace ruche
