#pragma once

#include <array>
#include <string>
#include <vector>

#include "ruche/core/fields.hpp"
#include "ruche/study/calibration/csv_table.hpp"

namespace ruche {

/// [columns]: which columns of a table are what, by name or by number from 1; empty: found by their names.
struct ColumnOptions {
    std::string force, displacement, width, branch, mass, length;
    std::string force_unit, displacement_unit, width_unit;  ///< where the header has none
};

template <>
std::span<const Field<ColumnOptions>> fields<ColumnOptions>();

enum class Branch { unknown, loading, unloading };

/// A test in the units of the program, row by row.
struct TestRecord {
    std::string file;
    std::vector<int> line;             ///< in the file
    std::vector<double> force;         ///< N
    std::vector<double> displacement;  ///< mm, as recorded
    std::vector<double> width;         ///< mm; empty when not measured
    std::vector<Branch> branch;        ///< as a person noted it; empty when not
    bool driven_by_force = false;      ///< hung masses: the displacement follows
    std::vector<std::string> columns;  ///< "force = column 3 \"Load\" in N", for the report
    std::vector<std::string> warnings;

    std::size_t size() const { return force.size(); }
    Place place(std::size_t row) const { return {.file = file, .line = line[row]}; }
};

/// What a table is read for.
struct RecordContext {
    ColumnOptions columns;
    double length_mm = 0.0;  ///< gauge length: for displacements in % and for columns that hold the length
    double width_mm = 0.0;   ///< for widths in %
    int specimen = 0;        ///< of several that stand side by side, from 1; 0: there is one only
};

/// Force and displacement (or hung mass and length) from a table, with their units. Rows with gaps or words
/// are left out with a warning, more than one in twenty refused. Throws InputError with file, line and
/// column.
TestRecord read_record(const CsvTable& table, const RecordContext& context);

}  // namespace ruche
