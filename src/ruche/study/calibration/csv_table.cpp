#include "ruche/study/calibration/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "ruche/core/document.hpp"
#include "ruche/core/text_scan.hpp"
#include "ruche/study/calibration/column_names.hpp"
#include "ruche/study/calibration/csv_cells.hpp"
#include "ruche/study/calibration/csv_text.hpp"

namespace ruche {
namespace {

struct TextLine {
    int number;
    std::string_view text;
    bool remark = false;   ///< began with '#'
    bool numbers = false;  ///< a row of the table
};

/// Lines that hold anything.
std::vector<TextLine> lines_of(std::string_view text) {
    std::vector<TextLine> lines;
    TextScan scan(text);
    while (!scan.at_end()) {
        std::string_view line = trimmed(scan.take_line());
        const bool remark = line.starts_with('#');
        if (remark) line = trimmed(line.substr(1));
        if (line.find_first_not_of(" \t,;|\"") == std::string_view::npos) continue;
        lines.push_back({scan.line(), line, remark});
    }
    return lines;
}

/// How a file may be written, and how well its lines fit to that.
struct Dialect {
    char delimiter;
    char decimal;
    std::size_t columns = 0;
    double score = 0.0;
};

/// What a row of at least two numbers is worth; 0 when it is none: a cell with digits is neither a number nor
/// a time nor a word.
double worth_of(const std::vector<std::string>& cells, char decimal) {
    int numbers = 0;
    double doubts = 0.0;
    for (const std::string& cell : cells) {
        if (!std::isnan(cell_number(cell, decimal))) {
            ++numbers;
            if (is_grouped(cell, decimal)) doubts += 0.5;
        } else if (has_digit(cell) && !is_clock(cell)) {
            if (!has_letter(cell) || cell.find_first_of(";\t|") != std::string::npos) return 0.0;
            doubts += 0.5;
        }
    }
    return numbers >= 2 ? 1.0 + 1e-3 * (numbers - doubts) : 0.0;
}

void rate(Dialect& dialect, const std::vector<TextLine>& lines) {
    std::map<std::size_t, double> rows_by_columns;
    const std::size_t stride = std::max<std::size_t>(1, lines.size() / 500);
    for (std::size_t i = 0; i < lines.size(); i += stride) {
        if (lines[i].remark) continue;
        const std::vector<std::string> cells = split(lines[i].text, dialect.delimiter);
        const double worth = worth_of(cells, dialect.decimal);
        if (worth > 0.0) rows_by_columns[cells.size()] += worth;
    }
    for (const auto& [columns, score] : rows_by_columns) {
        if (score <= dialect.score) continue;
        dialect.score = score;
        dialect.columns = columns;
    }
}

Dialect dialect_of(const std::vector<TextLine>& lines, const std::string& file) {
    Dialect best{' ', '.'};
    for (const char delimiter : {';', '\t', ',', '|', ' '}) {
        for (const char decimal : {'.', ','}) {
            Dialect dialect{delimiter, decimal};
            rate(dialect, lines);
            if (dialect.score > best.score) best = dialect;
        }
    }
    if (best.score == 0.0)
        throw InputError({.file = file},
                         lines.empty() ? "is empty" : "has no table of numbers with at least two columns",
                         "Expected are rows of numbers (force and displacement at least), parted by commas, "
                         "semicolons, tabs or blanks.");
    return best;
}

struct Header {
    std::vector<std::string> names, units;
    int line = 0;
    std::size_t top = 0;  ///< index of its first line
};

/// Cells of a line of names; where blanks part the columns, "Load (N)" is one name.
std::vector<std::string> name_cells(std::string_view line, char delimiter) {
    std::vector<std::string> cells;
    for (std::string& cell : split(line, delimiter)) {
        const bool unit = delimiter == ' ' && !cells.empty() && (cell[0] == '(' || cell[0] == '[');
        if (unit)
            cells.back() += " " + cell;
        else
            cells.push_back(std::move(cell));
    }
    return cells;
}

bool is_row_of_units(const std::vector<std::string>& cells) {
    constexpr std::size_t longest = 12;
    return std::any_of(cells.begin(), cells.end(), is_unit) &&
           std::all_of(cells.begin(), cells.end(), [](const std::string& cell) {
               return cell.size() <= longest && (!has_digit(cell) || cell.find('/') != std::string::npos);
           });
}

/// Names, and units below them, from the lines above the row of numbers `first`.
Header header_above(const std::vector<TextLine>& lines, std::size_t first, const Dialect& dialect,
                    bool remarks) {
    std::vector<std::pair<std::size_t, std::vector<std::string>>> above;
    for (std::size_t i = first; i > 0 && above.size() < 3 && !lines[i - 1].numbers; --i) {
        if (lines[i - 1].remark && !remarks) continue;
        std::vector<std::string> cells = name_cells(lines[i - 1].text, dialect.delimiter);
        if (cells.size() + 1 < dialect.columns || cells.size() > dialect.columns + 1 || cells.size() < 2)
            break;
        cells.resize(dialect.columns);
        above.emplace_back(i - 1, std::move(cells));
    }
    Header header{.top = first};
    if (above.empty()) return header;
    std::size_t names = 0;
    if (above.size() > 1 && is_row_of_units(above.front().second)) {
        header.units = above.front().second;
        names = 1;
    }
    header.top = above[names].first;
    header.line = lines[header.top].number;
    header.names = above[names].second;
    return header;
}

Header header_above(const std::vector<TextLine>& lines, std::size_t first, const Dialect& dialect) {
    Header header = header_above(lines, first, dialect, false);
    return header.names.empty() ? header_above(lines, first, dialect, true) : header;
}

/// Lines [first, end) and what stands above them.
struct Section {
    Header header;
    std::size_t first = 0, end = 0;
    std::size_t rows() const { return end - first; }
};

bool names_a_test(const std::vector<std::string>& names) {
    const auto any = [&](Quantity a, Quantity b) {
        return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
            return name_score(a, name) > 0 || name_score(b, name) > 0;
        });
    };
    return any(Quantity::force, Quantity::mass) && any(Quantity::displacement, Quantity::length);
}

/// Words, and not twice the same ("NaN,NaN,NaN").
bool are_names(std::vector<std::string> names) {
    if (std::any_of(names.begin(), names.end(), has_digit)) return false;
    std::sort(names.begin(), names.end());
    return std::adjacent_find(names.begin(), names.end()) == names.end();
}

/// Names of columns: words, none of them twice.
bool are_titles(const TextLine& line, const Dialect& dialect) {
    if (line.numbers) return false;
    std::vector<std::string> cells = split(line.text, dialect.delimiter);
    std::erase_if(cells, [](const std::string& cell) { return cell.empty(); });
    if (cells.size() < 2) return false;
    const auto is_word = [&](const std::string& cell) {
        return has_letter(cell) && std::isnan(cell_number(cell, dialect.decimal)) && !is_clock(cell);
    };
    if (!std::all_of(cells.begin(), cells.end(), is_word)) return false;
    std::sort(cells.begin(), cells.end());
    return std::adjacent_find(cells.begin(), cells.end()) == cells.end();
}

/// What stands below the readings: text, and results with names of their own or with a word in front
/// ("Mean").
void leave_results_out(Section& section, const std::vector<TextLine>& lines, const Dialect& dialect) {
    const auto cells_of = [&](std::size_t i) { return split(lines[i].text, dialect.delimiter); };
    const auto begins_with_number = [&](const std::vector<std::string>& cells) {
        return !std::isnan(cell_number(cells.front(), dialect.decimal));
    };
    const bool first_is_number = begins_with_number(cells_of(section.first));
    const auto is_no_reading = [&](std::size_t i) {
        const std::vector<std::string> cells = cells_of(i);
        if (!has_digit(lines[i].text)) return true;
        if (!lines[i].numbers && cells.size() + 1 < dialect.columns) return true;
        return first_is_number && has_letter(cells.front()) && !begins_with_number(cells);
    };
    std::size_t rows = 0;
    for (std::size_t i = section.end; i > section.first + 1 && rows < fewest_rows; --i) {
        if (are_titles(lines[i - 1], dialect)) {
            section.end = i - 1;
            rows = 0;
        }
        rows += lines[i - 1].numbers ? 1 : 0;
    }
    while (section.end > section.first + 1 && is_no_reading(section.end - 1)) --section.end;
}

std::vector<Section> sections_of(const std::vector<TextLine>& lines, const Dialect& dialect) {
    std::vector<Section> sections;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (!lines[i].numbers || (i > 0 && lines[i - 1].numbers && !sections.empty())) continue;
        // A single row of numbers among the remarks above the table is not its first row.
        if (sections.empty() && i + 1 < lines.size() && !lines[i + 1].numbers) continue;
        Section next{header_above(lines, i, dialect), i, lines.size()};
        if (!sections.empty()) {
            Section& last = sections.back();
            const std::vector<std::string>& names = next.header.names;
            const bool few_before = i - last.first < fewest_rows && are_names(names);
            const bool begins =
                !names.empty() && (names == last.header.names || names_a_test(names) || few_before);
            if (!begins) continue;
            last.end = next.header.top;
        }
        sections.push_back(std::move(next));
    }
    for (Section& section : sections) leave_results_out(section, lines, dialect);
    // Tables of results beside those of the tests.
    std::size_t most = 0;
    for (const Section& section : sections) most = std::max(most, section.rows());
    std::erase_if(sections, [&](const Section& section) {
        return 50 * section.rows() < most || (section.rows() < fewest_rows && most >= fewest_rows);
    });
    return sections;
}

std::vector<CsvTable::Row> rows_of(const Section& section, const std::vector<TextLine>& lines,
                                   const Dialect& dialect) {
    std::vector<CsvTable::Row> rows;
    for (std::size_t i = section.first; i < section.end; ++i)
        if (!lines[i].remark) rows.push_back({lines[i].number, split(lines[i].text, dialect.delimiter)});
    return rows;
}

/// Whether the time of `next` begins where that of `last` ended: the same test on another page.
bool goes_on(const Section& last, const Section& next, const std::vector<TextLine>& lines,
             const Dialect& dialect) {
    for (std::size_t column = 0; column < next.header.names.size(); ++column) {
        const std::string name = folded(next.header.names[column]);
        const auto names_time = [&](std::string_view word) { return name.find(word) != std::string::npos; };
        constexpr std::string_view words[] = {"time", "zeit", "temps", "tiempo", "tempo"};
        if (!std::any_of(std::begin(words), std::end(words), names_time)) continue;
        const auto time = [&](std::size_t line) {
            const std::vector<std::string> cells = split(lines[line].text, dialect.delimiter);
            return column < cells.size() ? cell_number(cells[column], dialect.decimal) : std::nan("");
        };
        return time(next.first) >= time(last.end - 1) && next.header.names == last.header.names;
    }
    return false;
}

}  // namespace

CsvTable parse_csv(std::string_view bytes, const std::string& file, int specimen) {
    const std::string text = text_of(bytes, file);
    std::vector<TextLine> lines = lines_of(text);
    const Dialect dialect = dialect_of(lines, file);
    for (TextLine& line : lines) {
        const std::vector<std::string> cells = split(line.text, dialect.delimiter);
        line.numbers =
            !line.remark && cells.size() == dialect.columns && worth_of(cells, dialect.decimal) > 0.0;
    }
    const std::vector<Section> sections = sections_of(lines, dialect);
    if (sections.empty())
        throw InputError({.file = file}, "has no two rows of numbers that follow each other",
                         "A test is a table with a row for each reading.");
    // Each specimen's sections, by the index of its first.
    std::vector<std::size_t> begins = {0};
    for (std::size_t i = 1; i < sections.size(); ++i)
        if (!goes_on(sections[i - 1], sections[i], lines, dialect)) begins.push_back(i);
    const int count = static_cast<int>(begins.size());
    std::string where;
    for (const std::size_t i : begins)
        where += fmt::format("{}{}", where.empty() ? "" : ", ", lines[sections[i].first].number);
    if (count > 1 && specimen == 0)
        throw InputError({.file = file, .line = lines[sections[begins[1]].first].number},
                         fmt::format("has {} specimens: tables begin at the lines {}", count, where),
                         "One [[...]] of the campaign is one specimen: say which with specimen = 1, 2, ...");
    if (count > 1 && specimen > count)
        throw InputError({.file = file}, fmt::format("there is no specimen {}: tables begin at the lines {}",
                                                     specimen, where));
    const std::size_t chosen = count > 1 ? static_cast<std::size_t>(specimen - 1) : 0;
    const std::size_t end = chosen + 1 < begins.size() ? begins[chosen + 1] : sections.size();
    const Header& header = sections[begins[chosen]].header;
    CsvTable table{.file = file,
                   .names = header.names,
                   .units = header.units,
                   .header_line = header.line,
                   .column_count = dialect.columns,
                   .delimiter = dialect.delimiter,
                   .decimal = dialect.decimal,
                   .specimens = count};
    for (std::size_t i = begins[chosen]; i < end; ++i)
        for (CsvTable::Row& row : rows_of(sections[i], lines, dialect)) table.rows.push_back(std::move(row));
    return table;
}

CsvTable read_csv_table(const std::string& path, int specimen) {
    constexpr std::size_t longest = 32U << 20U;
    try {
        return parse_csv(read_file(path, "file of a test", longest), path, specimen);
    } catch (const InputError& error) {
        if (!error.advice().empty() || error.problem().find("longer than") == std::string::npos) throw;
        throw InputError(
            error.place(), error.problem(),
            "A test has some thousand rows: 5 to 50 readings a second are plenty. Export it with "
            "fewer.");
    }
}

}  // namespace ruche
