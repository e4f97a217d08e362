#include "ruche/study/calibration/tension_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "ruche/study/calibration/pull.hpp"
#include "ruche/study/calibration/repeated_cycles.hpp"
#include "ruche/study/calibration/statistics.hpp"

namespace ruche {
namespace {

constexpr std::size_t most_rows = 1500;  // of a test in the fit; of more, neighbours are averaged
constexpr double large_slack = 0.02;

Place place(const TensionTest& test, int line = 0) { return {.file = test.file, .line = line}; }

void flip_if_negative(TensionCurve& curve) {
    TestRecord& r = curve.record;
    const auto sum = [](const std::vector<double>& v) {
        double s = 0.0;
        for (const double x : v) s += x;
        return s;
    };
    const auto flip = [](std::vector<double>& v) {
        for (double& x : v) x = -x;
    };
    const auto [low, high] = std::minmax_element(r.displacement.begin(), r.displacement.end());
    if (sum(r.force) < 0.0 && -*std::min_element(r.force.begin(), r.force.end()) >
                                  2.0 * *std::max_element(r.force.begin(), r.force.end())) {
        flip(r.force);
        curve.warnings.push_back(r.file + ": the force is negative throughout; its sign was turned");
    }
    if (-*low > 2.0 * *high) {
        flip(r.displacement);
        curve.warnings.push_back(r.file + ": the displacement is negative; its sign was turned");
    }
}

/// Rows whose force is off the median of its neighbours by more than half of the test's force: what a cable
/// or a radio put there, not the sample.
std::vector<std::size_t> spikes(const TestRecord& record) {
    std::vector<std::size_t> found;
    const std::vector<double>& force = record.force;
    constexpr std::size_t reach = 2;
    if (record.driven_by_force || force.size() < 20) return found;
    // All but the largest twentieth, so that spikes do not make the scale.
    std::vector<double> sizes;
    sizes.reserve(force.size());
    for (const double f : force) sizes.push_back(std::abs(f));
    const auto place = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() * 19 / 20);
    std::nth_element(sizes.begin(), place, sizes.end());
    const double scale = *place;
    for (std::size_t i = 0; i < force.size(); ++i) {
        const std::size_t first = std::min(i > reach ? i - reach : 0, force.size() - 2 * reach - 1);
        std::vector<double> near(force.begin() + static_cast<std::ptrdiff_t>(first),
                                 force.begin() + static_cast<std::ptrdiff_t>(first + 2 * reach + 1));
        std::nth_element(near.begin(), near.begin() + reach, near.end());
        if (std::abs(force[i] - near[reach]) > 0.5 * scale) found.push_back(i);
    }
    return found;
}

void erase(TestRecord& record, std::size_t row) {
    const auto from = [&](auto& column) {
        if (!column.empty()) column.erase(column.begin() + static_cast<std::ptrdiff_t>(row));
    };
    from(record.line);
    from(record.force);
    from(record.displacement);
    from(record.width);
    from(record.branch);
}

void leave_spikes_out(TensionCurve& curve) {
    TestRecord& r = curve.record;
    const std::vector<std::size_t> found = spikes(r);
    // More than one in twenty are no spikes.
    if (found.empty() || 20 * found.size() > r.size()) return;
    curve.warnings.push_back(
        fmt::format("{}:{}: a force of {:.4g} N stands alone among its neighbours; {} such rows were "
                    "left out",
                    r.file, r.line[found.front()], r.force[found.front()], found.size()));
    for (auto i = found.rbegin(); i != found.rend(); ++i) erase(r, *i);
}

/// A displacement that begins far from 0 while nothing pulls is a position: the distance between the grips,
/// or wherever the crosshead stood.
void set_position_to_zero(TensionCurve& curve) {
    TestRecord& r = curve.record;
    const double start = r.displacement.front();
    const double largest = *std::max_element(r.force.begin(), r.force.end());
    if (start < 0.3 * curve.test.length_mm || std::abs(r.force.front()) > 0.1 * largest) return;
    const bool is_length = std::abs(start - curve.test.length_mm) < 0.03 * curve.test.length_mm;
    const double zero = is_length ? curve.test.length_mm : start;
    for (double& d : r.displacement) d -= zero;
    curve.warnings.push_back(
        is_length
            ? fmt::format("{}: the displacement begins at {:.4g} mm, about length_mm: it was taken for the "
                          "distance between the grips",
                          r.file, start)
            : fmt::format("{}: the displacement begins at {:.4g} mm without a pull: it was taken for a "
                          "position, and length_mm for the length there",
                          r.file, start));
}

/// What the machine did before the record began, or cannot resolve.
void warn_of_force(TensionCurve& curve) {
    const TestRecord& r = curve.record;
    const Cycle& first = curve.cycles.front();
    const double largest = *std::max_element(r.force.begin(), r.force.end());
    constexpr double much = 0.06;
    if (first.peak > first.begin && !r.driven_by_force && r.force[first.begin] > much * largest)
        curve.warnings.push_back(fmt::format(
            "{}:{}: it pulls with {:.3g} N ({:.0f} % of the largest force) when the record begins: the "
            "load cell was not set to zero, or the sample was pre-loaded and longer than length_mm by "
            "an unknown amount",
            r.file, r.line[first.begin], r.force[first.begin], 100.0 * r.force[first.begin] / largest));
    const Cycle& cycle = curve.cycles[curve.cycle];
    const double left = r.force[cycle.end - 1];
    const bool is_back = r.displacement[cycle.end - 1] - curve.zero < 0.03 * r.displacement[cycle.peak];
    if (is_back && cycle.unloads && !r.driven_by_force && left > much * largest)
        curve.warnings.push_back(fmt::format(
            "{}:{}: it still pulls with {:.3g} N ({:.0f} % of the largest force) when the clamp is back: the "
            "load cell drifts or was not set to zero, and the fit cannot be trusted",
            r.file, r.line[cycle.end - 1], left, 100.0 * left / largest));
    constexpr std::size_t few = 20;
    const std::set<double> different(r.force.begin(), r.force.end());
    if (r.size() > 5 * few && different.size() < few)
        curve.warnings.push_back(
            fmt::format("{}: the force has {} different values only: export it with more digits, "
                        "or take a smaller load cell",
                        r.file, different.size()));
}

std::size_t choose_cycle(const TensionCurve& curve) {
    const TensionTest& test = curve.test;
    const bool unloading = test.branch == Branch::unloading;
    const auto fits = [&](const Cycle& c) { return unloading ? c.unloads : c.peak > c.begin; };
    if (test.cycle > 0) {
        if (static_cast<std::size_t>(test.cycle) > curve.cycles.size())
            throw InputError(place(test), fmt::format("there is no cycle {}: the file has {}", test.cycle,
                                                      curve.cycles.size()));
        const auto chosen = static_cast<std::size_t>(test.cycle - 1);
        if (fits(curve.cycles[chosen])) return chosen;
    } else {
        for (std::size_t i = curve.cycles.size(); i-- > 0;)
            if (fits(curve.cycles[i])) return i;
    }
    const std::size_t last = curve.record.size() - 1;
    throw InputError(place(test, curve.record.line[last]),
                     fmt::format("there is no {} in this test",
                                 unloading ? "unloading: the displacement never comes back" : "loading"),
                     unloading
                         ? "Fabric on a frame is released, so the unloading branch counts. Record a whole "
                           "cycle, or say branch = \"loading\" and take the result with care."
                         : "");
}

void warn_of_falls(TensionCurve& curve) {
    for (const Cycle& cycle : curve.cycles) {
        const std::vector<std::size_t> falls = sudden_falls(curve.record, cycle);
        if (falls.empty()) continue;
        curve.warnings.push_back(
            fmt::format("{}:{}: the force falls suddenly while the sample is stretched: a grip slipped or a "
                        "yarn broke; the rest length is wrong from here on",
                        curve.record.file, curve.record.line[falls.front()]));
        return;
    }
}

/// Where stretch begins, in displacement.
double zero_of(TensionCurve& curve, const Cycle& cycle) {
    const TestRecord& r = curve.record;
    const double slack = slack_of(r, curve.cycles.front());
    const double start = r.displacement[curve.cycles.front().begin];
    if (std::abs(start) > large_slack * curve.test.length_mm &&
        curve.cycles.front().begin < curve.cycles.front().peak)
        curve.warnings.push_back(
            fmt::format("{}: the displacement begins at {:.3g} mm; length_mm is taken as the "
                        "length at displacement 0",
                        r.file, start));
    switch (curve.test.rest_length) {
        case RestLength::gauge:
            return 0.0;
        case RestLength::toe:
            return start + slack;
        case RestLength::unloaded: {
            // The last row of the branch that pulls, along the slope of its last tenth.
            const double small = 0.02 * r.force[cycle.peak];
            std::size_t last = cycle.peak;
            while (last + 1 < cycle.end && r.force[last + 1] > small) ++last;
            return r.displacement[last];
        }
        case RestLength::automatic:
            break;
    }
    if (slack < large_slack * curve.test.length_mm) return 0.0;
    curve.warnings.push_back(
        fmt::format("{}: {:.3g} mm of slack before the sample pulls ({:.1f} % of its length) were taken off; "
                    "mount it without, or set rest_length",
                    r.file, slack, 100.0 * slack / curve.test.length_mm));
    return start + slack;
}

void check_plausible(const TensionCurve& curve) {
    const TensionTest& test = curve.test;
    const double stretch = curve.largest_stretch();
    if (stretch > 4.0 || stretch < 1.0 + 0.1 * (test.prestretch - 1.0))
        throw InputError(
            place(test),
            fmt::format("stretches the sample to {:.4g} times its length; {:.4g} was expected", stretch,
                        test.prestretch),
            "Is the displacement in another unit, is length_mm right, are force and displacement "
            "swapped? See force_unit and displacement_unit of [columns].");
    const double pull =
        *std::max_element(curve.record.force.begin(), curve.record.force.end()) / test.width_mm;
    constexpr double softest = 1e-3;
    constexpr double hardest = 30.0;
    if (pull < softest || pull > hardest)
        throw InputError(
            place(test),
            fmt::format("pulls with {:.3g} N per mm of width; knits pull with 0.01 to 5 N/mm", pull),
            "Is the force in another unit (force_unit in [columns]), is width_mm right?");
}

void check_swapped(const TensionCurve& curve) {
    // What a machine drives goes straight in time, or turns at once; what it measures bends.
    const Cycle& c = curve.cycles.front();
    if (c.peak < c.begin + 20 || curve.record.driven_by_force) return;
    std::vector<double> index, way, force;
    for (std::size_t i = c.begin; i <= c.peak; ++i) {
        index.push_back(static_cast<double>(i));
        way.push_back(curve.record.displacement[i]);
        force.push_back(curve.record.force[i]);
    }
    const double way_bend = fit_line(index, way).rms / (*std::max_element(way.begin(), way.end()) + 1e-300);
    const double force_bend =
        fit_line(index, force).rms / (*std::max_element(force.begin(), force.end()) + 1e-300);
    if (way_bend < 0.02 || force_bend > 0.2 * way_bend) return;
    throw InputError(place(curve.test, curve.record.line[c.begin]),
                     "the force grows evenly and the displacement does not: are the two columns swapped?",
                     "Name them in [columns]; a test that is driven by force can be given as a table of mass "
                     "and length.");
}

/// What a row of a record says.
struct TensionRow {
    double stretch = 0.0;
    double stress = 0.0;      // nominal, MPa
    double transverse = 0.0;  // Green strain; 0 without widths
};

std::vector<TensionRow> tension_rows(const TensionCurve& curve, const Cycle& cycle, double thickness) {
    const TensionTest& test = curve.test;
    const TestRecord& r = curve.record;
    std::vector<TensionRow> rows;
    const RowRange range = cycle.rows(test.branch);
    for (std::size_t i = range.begin; i < range.end; ++i) {
        const double stretch = 1.0 + (r.displacement[i] - curve.zero) / curve.rest_length;
        // A length that was read may scatter about the rest length; a clamp that comes back too far makes
        // folds.
        if (stretch < (r.driven_by_force ? 0.9 : 1.0) ||
            (test.pretension_n > 0.0 && r.force[i] < test.pretension_n))
            continue;
        rows.push_back({stretch, r.force[i] / (test.width_mm * thickness),
                        r.width.empty() ? 0.0 : green_strain(r.width[i] / test.width_mm)});
    }
    return rows;
}

void take_rows(TensionCurve& curve, double thickness) {
    std::vector<TensionRow> rows;
    for (const std::size_t cycle : curve.used) {
        const std::vector<TensionRow> more = tension_rows(curve, curve.cycles[cycle], thickness);
        rows.insert(rows.end(), more.begin(), more.end());
    }
    if (rows.size() < fewest_rows) {
        const Branch branch = curve.test.branch;
        const std::size_t begin = curve.cycles[curve.cycle].rows(branch).begin;
        throw InputError(
            place(curve.test, curve.record.line[std::min(begin, curve.record.size() - 1)]),
            fmt::format("the {} branch has {} rows; at least {} are needed",
                        branch == Branch::unloading ? "unloading" : "loading", rows.size(), fewest_rows));
    }
    // In the order of what was set, not of what was read, and all cycles as one curve: what the law misses is
    // the same in each, and is seen as neighbours that resemble each other.
    const auto by = curve.record.driven_by_force ? &TensionRow::stress : &TensionRow::stretch;
    std::stable_sort(rows.begin(), rows.end(),
                     [&](const TensionRow& a, const TensionRow& b) { return a.*by > b.*by; });
    const std::size_t group = (rows.size() + most_rows - 1) / most_rows;
    for (std::size_t i = 0; i < rows.size(); i += group) {
        const std::size_t end = std::min(i + group, rows.size());
        TensionRow mean;
        for (std::size_t k = i; k < end; ++k) {
            const double share = 1.0 / static_cast<double>(end - i);
            mean.stretch += share * rows[k].stretch;
            mean.stress += share * rows[k].stress;
            mean.transverse += share * rows[k].transverse;
        }
        curve.stretch.push_back(mean.stretch);
        curve.nominal_stress.push_back(mean.stress);
        if (!curve.record.width.empty()) curve.transverse.push_back(mean.transverse);
    }
}

void check_widths(TensionCurve& curve) {
    if (curve.transverse.empty()) return;
    // Never below a third of the relaxed width, and near it where the sample is hardly stretched.
    const auto [low, high] = std::minmax_element(curve.transverse.begin(), curve.transverse.end());
    if (*low > green_strain(0.33) && *high < 0.2 && *high > -0.3) return;
    curve.warnings.push_back(
        fmt::format("{}: widths from {:.3g} to {:.3g} times width_mm make no sense and were "
                    "left out",
                    curve.record.file, std::sqrt(std::max(0.0, 1.0 + 2.0 * *low)), stretch_of(*high)));
    curve.transverse.clear();
}

}  // namespace

double TensionCurve::largest_stretch() const { return *std::max_element(stretch.begin(), stretch.end()); }
double TensionCurve::largest_stress() const {
    return *std::max_element(nominal_stress.begin(), nominal_stress.end());
}

std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

std::string TensionCurve::name() const {
    return fmt::format("{} ({:g} deg)", file_name(test.file), test.angle_deg);
}

std::string TensionCurve::used_cycles() const {
    if (used.size() == 1) return fmt::format("cycle {}", used.front() + 1);
    return fmt::format("cycles {} to {}", used.front() + 1, used.back() + 1);
}

TensionCurve read_tension_curve(const TensionTest& test, double thickness) {
    TensionCurve curve{.test = test, .rest_length = test.length_mm};
    const CsvTable table = read_csv_table(test.file, test.specimen);
    curve.record = read_record(table, {.columns = test.columns,
                                       .length_mm = test.length_mm,
                                       .width_mm = test.width_mm,
                                       .specimen = test.specimen});
    curve.warnings = curve.record.warnings;
    if (curve.record.size() < fewest_rows)
        throw InputError(place(test), fmt::format("has {} rows of numbers; at least {} are needed",
                                                  curve.record.size(), fewest_rows));
    leave_spikes_out(curve);
    flip_if_negative(curve);
    set_position_to_zero(curve);
    curve.cycles = find_cycles(curve.record);
    if (curve.cycles.empty())
        throw InputError(place(test), "the displacement never changes",
                         "Name the column in [columns]: displacement = \"...\".");
    curve.cycle = choose_cycle(curve);
    curve.used = {curve.cycle};
    if (test.cycle == 0) curve.used = repeated_cycles(curve.record, curve.cycles, curve.cycle, test.branch);
    curve.zero = zero_of(curve, curve.cycles[curve.cycle]);
    curve.rest_length = test.length_mm + curve.zero;
    take_rows(curve, thickness);
    check_plausible(curve);
    check_swapped(curve);
    check_widths(curve);
    warn_of_falls(curve);
    warn_of_force(curve);
    if (curve.largest_stretch() < 1.0 + 0.8 * (test.prestretch - 1.0))
        curve.warnings.push_back(fmt::format(
            "{}: measured up to a stretch of {:.3f} only, used at {:.3g}: beyond the data the law is "
            "a guess",
            curve.record.file, curve.largest_stretch(), test.prestretch));
    if (test.branch == Branch::loading)
        curve.warnings.push_back(curve.record.file +
                                 ": the loading branch was taken; fabric that is released is softer");
    return curve;
}

double mean_poissons_ratio(const TensionCurve& curve) {
    if (curve.transverse.empty()) return std::numeric_limits<double>::quiet_NaN();
    const double largest = green_strain(curve.largest_stretch());
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < curve.stretch.size(); ++i) {
        const double axial = green_strain(curve.stretch[i]);
        if (axial < 0.1 * largest) continue;
        sum -= curve.transverse[i] / axial;
        ++count;
    }
    return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace ruche
