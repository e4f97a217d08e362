#pragma once

#include <string>
#include <vector>

#include "ruche/study/calibration/test_record.hpp"

namespace ruche {

/// Rows [begin, peak] of a record load, rows [peak, end) unload.
struct Cycle {
    std::size_t begin = 0, peak = 0, end = 0;
    bool unloads = false;  ///< the displacement comes back by at least half of the way
};

/// The load-unload cycles of a record: turns of the displacement by more than a tenth of its whole range (so
/// noise makes none), or the branches that a person noted. A record that only unloads is one cycle whose
/// loading is a single row.
std::vector<Cycle> find_cycles(const TestRecord& record);

/// How much of a record's displacement is slack: up to where the force of the first loading first stays above
/// its noise and 0.5 % of its largest; 0 when it rises from the start.
double slack_of(const TestRecord& record, const Cycle& first);

/// Sudden falls of the force, by more than a tenth of its range, from one row to the next or while the
/// displacement grows by less than a fiftieth of its range: a grip slipped or a yarn broke. The rows where
/// they end.
std::vector<std::size_t> sudden_falls(const TestRecord& record, const Cycle& cycle);

}  // namespace ruche
