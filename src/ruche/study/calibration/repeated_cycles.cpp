#include "ruche/study/calibration/repeated_cycles.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <span>

namespace ruche {
namespace {

struct Reading {
    double at = 0.0;
    double value = 0.0;
    bool of_second = false;
};

/// A least-squares fit's sum of squares and how many parameters it could determine.
struct PieceFit {
    double sum = 0.0;
    Eigen::Index rank = 0;
};

PieceFit fit_piece(std::span<const Reading> piece, bool with_offset) {
    const auto count = static_cast<Eigen::Index>(piece.size());
    const double low = piece.front().at;
    const double high = piece.back().at;
    Eigen::MatrixXd columns(count, with_offset ? 5 : 4);
    Eigen::VectorXd values(count);
    for (Eigen::Index i = 0; i < count; ++i) {
        const Reading& reading = piece[static_cast<std::size_t>(i)];
        const double x = high > low ? (2.0 * reading.at - low - high) / (high - low) : 0.0;
        columns.row(i).head<4>() << 1.0, x, x * x, x * x * x;
        if (with_offset) columns(i, 4) = reading.of_second ? 1.0 : 0.0;
        values[i] = reading.value;
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
    const Eigen::VectorXd residuals = columns * qr.solve(values) - values;
    return {residuals.squaredNorm(), qr.rank()};
}

/// Whether the readings of two branches scatter about one curve; false where there are too few to tell.
bool are_one_curve(std::vector<Reading> readings) {
    std::stable_sort(readings.begin(), readings.end(),
                     [](const Reading& a, const Reading& b) { return a.at < b.at; });
    constexpr std::size_t readings_of_a_piece = 24;
    const std::size_t pieces = std::clamp<std::size_t>(readings.size() / readings_of_a_piece, 1, 10);
    double sum = 0.0;
    double sum_of_offsets = 0.0;
    double offsets = 0.0;
    double freedom = 0.0;
    double largest = 0.0;
    for (std::size_t i = 0; i < pieces; ++i) {
        const std::size_t begin = i * readings.size() / pieces;
        const std::size_t end = (i + 1) * readings.size() / pieces;
        const std::span<const Reading> piece(readings.data() + begin, end - begin);
        const PieceFit one = fit_piece(piece, false);
        const PieceFit two = fit_piece(piece, true);
        sum += two.sum;
        sum_of_offsets += one.sum - two.sum;
        offsets += static_cast<double>(two.rank - one.rank);
        freedom += static_cast<double>(piece.size()) - static_cast<double>(two.rank);
        for (const Reading& reading : piece) largest = std::max(largest, std::abs(reading.value));
    }
    if (offsets < 1.0 || freedom < 4.0) return false;
    // Files without noise: what is below their digits is no difference.
    constexpr double digits = 1e-9;
    if (sum_of_offsets <= digits * digits * largest * largest) return true;
    const boost::math::fisher_f distribution(offsets, freedom);
    return sum_of_offsets / offsets <= boost::math::quantile(distribution, 0.99) * sum / freedom;
}

/// The readings of two branches where both have some.
std::vector<Reading> readings_of(const std::vector<double>& at, const std::vector<double>& values,
                                 const RowRange& first, const RowRange& second) {
    const auto ends = [&](const RowRange& rows) {
        return std::minmax_element(at.begin() + static_cast<std::ptrdiff_t>(rows.begin),
                                   at.begin() + static_cast<std::ptrdiff_t>(rows.end));
    };
    const auto [first_low, first_high] = ends(first);
    const auto [second_low, second_high] = ends(second);
    const double low = std::max(*first_low, *second_low);
    const double high = std::min(*first_high, *second_high);
    std::vector<Reading> readings;
    for (const bool of_second : {false, true}) {
        const RowRange& rows = of_second ? second : first;
        for (std::size_t i = rows.begin; i < rows.end; ++i)
            if (at[i] >= low && at[i] <= high) readings.push_back({at[i], values[i], of_second});
    }
    return readings;
}

bool say_the_same(const TestRecord& record, const RowRange& first, const RowRange& second) {
    if (first.size() < fewest_rows || second.size() < fewest_rows) return false;
    const std::vector<double>& set = record.driven_by_force ? record.force : record.displacement;
    const std::vector<double>& read = record.driven_by_force ? record.displacement : record.force;
    return are_one_curve(readings_of(set, read, first, second)) &&
           (record.width.empty() || are_one_curve(readings_of(set, record.width, first, second)));
}

}  // namespace

std::vector<std::size_t> repeated_cycles(const TestRecord& record, const std::vector<Cycle>& cycles,
                                         std::size_t last, Branch branch) {
    const RowRange rows = cycles[last].rows(branch);
    std::size_t first = last;
    const auto repeats = [&](const Cycle& cycle) {
        return (cycle.unloads || branch == Branch::loading) && say_the_same(record, cycle.rows(branch), rows);
    };
    while (first > 0 && repeats(cycles[first - 1])) --first;
    std::vector<std::size_t> repeated;
    for (std::size_t i = first; i <= last; ++i) repeated.push_back(i);
    return repeated;
}

}  // namespace ruche
