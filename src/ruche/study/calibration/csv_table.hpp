#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ruche {

inline constexpr std::size_t fewest_rows = 6;  ///< of a test

/// The table in a text file as a testing machine or a person writes it: whatever stands before it, one or two
/// rows of names and units, then rows of numbers.
struct CsvTable {
    struct Row {
        int line = 0;                    ///< in the file, from 1
        std::vector<std::string> cells;  ///< as written, without quotes and outer blanks
    };
    std::string file;
    std::vector<std::string> names;  ///< empty when the table has none
    std::vector<std::string> units;  ///< of a row of its own below the names; empty without
    int header_line = 0;             ///< of the names; 0 without
    std::vector<Row> rows;           ///< numbers, and rows among them with other things
    std::size_t column_count = 0;
    char delimiter = ',';  ///< ' ' for any blanks
    char decimal = '.';
    int specimens = 1;  ///< that the file has one below the other
};

/// Finds delimiter, decimal mark, names and units. A table that begins anew below (its names again, or other
/// names of force and displacement) is that of another specimen, unless its time goes on; a table of results,
/// much shorter than the others, is none, nor is what stands below the readings. `specimen`, from 1, says
/// which; 0 where there is only one. Throws InputError when there is no table of at least two columns, or it
/// is not clear which.
CsvTable parse_csv(std::string_view bytes, const std::string& file, int specimen = 0);

/// Reads a file, of at most 32 MB.
CsvTable read_csv_table(const std::string& path, int specimen = 0);

}  // namespace ruche
