#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ruche {

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
    char delimiter = ',';            ///< ' ' for any blanks
    char decimal = '.';

    std::size_t column_count() const { return rows.empty() ? 0 : rows.front().cells.size(); }
};

/// A cell as a number with that decimal mark; NaN when it is none. "1.234,5" and "1,234.5" are numbers too.
double cell_number(std::string_view cell, char decimal);

/// Bytes as UTF-8 without a byte order mark, from UTF-8, UTF-16 with a mark, or else Windows-1252 (which
/// holds Latin-1). `file` is named when it is no text.
std::string text_of(std::string_view bytes, const std::string& file);

/// Finds delimiter, decimal mark, names and units. Throws InputError when there is no table of at least two
/// columns in it.
CsvTable parse_csv(std::string_view bytes, const std::string& file);

/// Reads a file, of at most 32 MB.
CsvTable read_csv_table(const std::string& path);

}  // namespace ruche
