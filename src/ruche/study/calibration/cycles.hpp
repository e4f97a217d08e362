#pragma once

#include <string>
#include <vector>

#include "ruche/study/calibration/test_record.hpp"

namespace ruche {

/// Rows [begin, end) of a record.
struct RowRange {
    std::size_t begin = 0, end = 0;
    std::size_t size() const { return end - begin; }
};

/// Rows [begin, peak] of a record load, rows [unloading(), end) unload.
struct Cycle {
    std::size_t begin = 0, peak = 0, end = 0;
    /// Behind the peak, which still is a row of the loading, unless there is no loading.
    std::size_t unloading() const { return peak > begin ? peak + 1 : peak; }
    bool unloads = false;  ///< the displacement comes back by at least half of the way

    RowRange rows(Branch branch) const {
        return branch == Branch::unloading ? RowRange{unloading(), end} : RowRange{begin, peak + 1};
    }
};

/// The load-unload cycles of a record: turns of the displacement by more than a tenth of its whole range (so
/// noise makes none), or the branches that a person noted. A record that only unloads is one cycle whose
/// loading is a single row.
std::vector<Cycle> find_cycles(const TestRecord& record);

/// How much of the first loading's displacement is slack: the onset of the broken curve, flat up to it and a
/// parabola from there, that fits the beginning of the loading best, if it fits significantly better than a
/// parabola from the start; else 0. A soft beginning in noise is no slack.
double slack_of(const TestRecord& record, const Cycle& first);

/// Sudden falls of the force, by more than a tenth of its range, from one row to the next or while the
/// displacement grows by less than a fiftieth of its range: a grip slipped or a yarn broke; but not where the
/// sample is held at the peak and relaxes. The rows where they end.
std::vector<std::size_t> sudden_falls(const TestRecord& record, const Cycle& cycle);

}  // namespace ruche
