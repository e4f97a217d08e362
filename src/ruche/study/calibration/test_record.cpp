#include "ruche/study/calibration/test_record.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <optional>

#include "ruche/core/suggest.hpp"
#include "ruche/core/text_scan.hpp"
#include "ruche/study/calibration/column_names.hpp"
#include "ruche/study/calibration/csv_cells.hpp"

namespace ruche {

template <>
std::span<const Field<ColumnOptions>> fields<ColumnOptions>() {
    using C = ColumnOptions;
    static const Field<C> table[] = {
        {"force", &C::force, "", -infinity, infinity, "Column of the force, by name or by number from 1."},
        {"displacement", &C::displacement, "", -infinity, infinity,
         "Column of the clamps' displacement (or the strain), by name or by number from 1."},
        {"width", &C::width, "", -infinity, infinity,
         "Column of the sample's width at half its length; Poisson's ratio comes from it."},
        {"branch", &C::branch, "", -infinity, infinity,
         "Column that says \"loading\" or \"unloading\"; else turns of the displacement tell."},
        {"mass", &C::mass, "", -infinity, infinity, "Column of a hung mass, in place of a force."},
        {"length", &C::length, "", -infinity, infinity,
         "Column of the length between the marks, in place of a displacement."},
        {"force_unit", &C::force_unit, "", -infinity, infinity,
         "Unit of the force (N, kN, mN, cN, gf, kgf, lbf) where the table does not say it."},
        {"displacement_unit", &C::displacement_unit, "", -infinity, infinity,
         "Unit of displacement or length (mm, cm, m, in, %) where the table does not say it."},
        {"width_unit", &C::width_unit, "", -infinity, infinity,
         "Unit of the width (mm, cm, m, in, %) where the table does not say it."},
    };
    return table;
}

namespace {

struct Column {
    std::size_t index = 0;
    UnitScale scale;
};

std::string column_text(const CsvTable& table, std::size_t index) {
    if (index < table.names.size() && !table.names[index].empty())
        return fmt::format("column {} \"{}\"", index + 1, table.names[index]);
    return fmt::format("column {}", index + 1);
}

/// Finds columns and their units in one table.
class Mapping {
  public:
    Mapping(const CsvTable& table, const RecordContext& context, TestRecord& record)
        : table_(table), options_(context.columns), specimen_(context.specimen), record_(record) {}

    std::optional<Column> find(Quantity quantity) {
        const std::string& wanted = wanted_name(quantity);
        std::optional<std::size_t> index =
            wanted.empty() ? by_name(quantity, true) : chosen(quantity, wanted);
        // A force in a unit that is none had better be asked about than overlooked.
        if (!index && (quantity == Quantity::force || quantity == Quantity::displacement))
            index = by_name(quantity, false);
        if (!index) return std::nullopt;
        Column column{*index, {}};
        if (quantity != Quantity::branch) column.scale = scale(quantity, *index);
        return column;
    }

    Place header() const { return {.file = table_.file, .line = table_.header_line}; }

  private:
    const std::string& wanted_name(Quantity quantity) const {
        const std::array<const std::string*, 6> wanted = {&options_.force, &options_.displacement,
                                                          &options_.width, &options_.branch,
                                                          &options_.mass,  &options_.length};
        return *wanted[static_cast<std::size_t>(quantity)];
    }

    std::optional<std::size_t> by_name(Quantity quantity, bool unit_must_fit) const {
        int best = 0;
        std::vector<std::size_t> found;  // of the same name, where specimens stand side by side
        for (std::size_t i = 0; i < table_.names.size(); ++i) {
            int score = name_score(quantity, table_.names[i]);
            const std::string unit = written_unit(i);
            if (unit_must_fit && !unit.empty() && quantity != Quantity::branch && !unit_scale(quantity, unit))
                score = 0;
            if (score > best) found.clear();
            if (score == 0 || score < best) continue;
            best = score;
            if (found.empty() || table_.names[found.front()] == table_.names[i]) found.push_back(i);
        }
        if (found.empty()) return std::nullopt;
        return found[of_specimen(found)];
    }

    /// Which of the columns with the same name.
    std::size_t of_specimen(const std::vector<std::size_t>& columns) const {
        if (columns.size() == 1) return 0;
        const bool chosen = specimen_ > 0 && table_.specimens == 1;
        if (chosen && static_cast<std::size_t>(specimen_) <= columns.size())
            return static_cast<std::size_t>(specimen_ - 1);
        std::vector<std::size_t> numbers;
        numbers.reserve(columns.size());
        for (const std::size_t i : columns) numbers.push_back(i + 1);
        throw InputError(
            header(),
            fmt::format("the columns {} are all called \"{}\"", fmt::join(numbers, ", "),
                        table_.names[columns.front()]),
            "Of specimens side by side say which with specimen = 1, 2, ...; else give the column's "
            "number in [columns].");
    }

    std::size_t chosen(Quantity quantity, const std::string& wanted) const {
        std::size_t number = 0;
        if (read_number(wanted, number)) {
            if (number >= 1 && number <= table_.column_count) return number - 1;
            throw InputError({.file = table_.file},
                             fmt::format("there is no column {} for the {}: the table has {}", number,
                                         quantity_name(quantity), table_.column_count));
        }
        for (std::size_t i = 0; i < table_.names.size(); ++i)
            if (folded(table_.names[i]) == folded(wanted)) return i;
        const std::vector<std::string_view> names(table_.names.begin(), table_.names.end());
        throw InputError(header(),
                         fmt::format("there is no column \"{}\" for the {}{}", wanted,
                                     quantity_name(quantity), did_you_mean(wanted, names)),
                         table_.names.empty()
                             ? "The table has no names; give the column's number, from 1."
                             : fmt::format("Its columns are \"{}\".", fmt::join(table_.names, "\", \"")));
    }

    std::string written_unit(std::size_t index) const {
        if (index < table_.units.size() && !table_.units[index].empty()) return table_.units[index];
        return index < table_.names.size() ? unit_in_name(table_.names[index]) : std::string();
    }

    std::string given_unit(Quantity quantity) const {
        switch (quantity) {
            case Quantity::force:
                return options_.force_unit;
            case Quantity::displacement:
            case Quantity::length:
                return options_.displacement_unit;
            case Quantity::width:
                return options_.width_unit;
            default:
                return {};
        }
    }

    UnitScale scale(Quantity quantity, std::size_t index) {
        const std::string given = given_unit(quantity);
        const std::string written = given.empty() ? written_unit(index) : given;
        if (const auto known = unit_scale(quantity, written); known && !written.empty()) {
            record_.columns.push_back(
                fmt::format("{} = {} in {}", quantity_name(quantity), column_text(table_, index), written));
            return *known;
        }
        if (!written.empty())
            throw InputError(header(),
                             fmt::format("\"{}\" of {} is no unit of a {}", written,
                                         column_text(table_, index), quantity_name(quantity)),
                             "Are columns swapped? Else give the unit as force_unit, displacement_unit or "
                             "width_unit in [columns].");
        if (quantity == Quantity::displacement && index < table_.names.size() &&
            names_strain(table_.names[index]))
            throw InputError(
                header(), fmt::format("{} has no unit", column_text(table_, index)),
                "Is a strain of 1 in it 100 % or 1 %? Say displacement_unit = \"mm/mm\" or \"%\" in "
                "[columns].");
        const std::string_view assumed = quantity == Quantity::force  ? "N"
                                         : quantity == Quantity::mass ? "g"
                                                                      : "mm";
        record_.columns.push_back(fmt::format("{} = {} in {} (assumed)", quantity_name(quantity),
                                              column_text(table_, index), assumed));
        record_.warnings.push_back(fmt::format("{}: the table does not say the unit of its {}: {} assumed",
                                               table_.file, quantity_name(quantity), assumed));
        return *unit_scale(quantity, assumed);
    }

    const CsvTable& table_;
    const ColumnOptions& options_;
    int specimen_;
    TestRecord& record_;
};

/// Force from a force or a hung mass, displacement from a displacement or a length.
struct Columns {
    Column force, displacement;
    bool is_length = false;
    bool is_mass = false;
    std::optional<Column> width, branch;
};

Columns find_columns(Mapping& mapping, const CsvTable& table) {
    Columns columns;
    std::optional<Column> force = mapping.find(Quantity::force);
    if (!force) {
        force = mapping.find(Quantity::mass);
        columns.is_mass = force.has_value();
    }
    std::optional<Column> way = mapping.find(Quantity::displacement);
    if (!way) {
        way = mapping.find(Quantity::length);
        columns.is_length = way.has_value();
    }
    if (!force || !way) {
        const std::string found = table.names.empty()
                                      ? fmt::format("{} columns without names", table.column_count)
                                      : fmt::format("the columns \"{}\"", fmt::join(table.names, "\", \""));
        throw InputError(
            mapping.header(),
            fmt::format("no column of the {} was found among {}", force ? "displacement" : "force", found),
            fmt::format("Name it in [columns]: {} = \"its name\", or its number from 1.",
                        force ? "displacement" : "force"));
    }
    if (force->index == way->index)
        throw InputError(mapping.header(), "force and displacement are the same column");
    columns.force = *force;
    columns.displacement = *way;
    columns.width = mapping.find(Quantity::width);
    columns.branch = mapping.find(Quantity::branch);
    return columns;
}

Branch branch_of(std::string_view cell) {
    const std::string text = folded(cell);
    for (const std::string_view word : {"unload", "entlast", "décharge", "descarga", "down", "ab"})
        if (text.starts_with(word)) return Branch::unloading;
    for (const std::string_view word : {"load", "belast", "charge", "carga", "up", "auf"})
        if (text.starts_with(word)) return Branch::loading;
    return Branch::unknown;
}

std::string cell_of(const CsvTable::Row& row, std::size_t index) {
    return index < row.cells.size() ? row.cells[index] : std::string();
}

/// Where rows were left out, and why, for one warning.
struct LeftOut {
    std::size_t count = 0;
    int first_line = 0;
    std::string first_cell;
    void add(int line, const std::string& cell) {
        if (count++ > 0) return;
        first_line = line;
        first_cell = cell;
    }
};

}  // namespace

TestRecord read_record(const CsvTable& table, const RecordContext& context) {
    TestRecord record{.file = table.file};
    Mapping mapping(table, context, record);
    const Columns columns = find_columns(mapping, table);
    record.driven_by_force = columns.is_mass;
    const auto value = [&](const CsvTable::Row& row, const Column& column, double whole) {
        return cell_number(cell_of(row, column.index), table.decimal) * column.scale.factor *
               (column.scale.relative ? whole : 1.0);
    };
    LeftOut left_out;
    for (const CsvTable::Row& row : table.rows) {
        // Beside a specimen that was recorded for longer.
        if (cell_of(row, columns.force.index).empty() && cell_of(row, columns.displacement.index).empty())
            continue;
        const double force = value(row, columns.force, 1.0);
        double displacement = value(row, columns.displacement, context.length_mm);
        if (columns.is_length && !columns.displacement.scale.relative) displacement -= context.length_mm;
        const double width = columns.width ? value(row, *columns.width, context.width_mm) : 0.0;
        if (std::isnan(force) || std::isnan(displacement) || std::isnan(width)) {
            const std::size_t bad = std::isnan(force)          ? columns.force.index
                                    : std::isnan(displacement) ? columns.displacement.index
                                                               : columns.width->index;
            left_out.add(row.line, cell_of(row, bad));
            continue;
        }
        record.line.push_back(row.line);
        record.force.push_back(force);
        record.displacement.push_back(displacement);
        if (columns.width) record.width.push_back(width);
        if (columns.branch) record.branch.push_back(branch_of(cell_of(row, columns.branch->index)));
    }
    if (left_out.count > 0) {
        const std::string what = fmt::format("\"{}\" is no number; {} of {} rows cannot be read",
                                             left_out.first_cell, left_out.count, table.rows.size());
        if (20 * left_out.count > table.rows.size())
            throw InputError({.file = table.file, .line = left_out.first_line}, what,
                             "Export the test without gaps, or name other columns in [columns].");
        record.warnings.push_back(
            fmt::format("{}:{}: {} and were left out", table.file, left_out.first_line, what));
    }
    return record;
}

}  // namespace ruche
