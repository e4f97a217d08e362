#include "ruche/study/calibration/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

#include "ruche/core/document.hpp"
#include "ruche/core/text_scan.hpp"

namespace ruche {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
        text.remove_suffix(1);
    return text;
}

/// Cells of a line; quotes hold delimiters, a doubled quote is one.
std::vector<std::string> split(std::string_view line, char delimiter) {
    std::vector<std::string> cells;
    if (delimiter == ' ') {
        while (true) {
            const std::string_view word = take_word(line);
            if (word.empty()) return cells;
            cells.emplace_back(word);
        }
    }
    std::string cell;
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (c == '"') {
            if (quoted && i + 1 < line.size() && line[i + 1] == '"') {
                cell += c;
                ++i;
            } else {
                quoted = !quoted;
            }
        } else if (c == delimiter && !quoted) {
            cells.emplace_back(trimmed(cell));
            cell.clear();
        } else {
            cell += c;
        }
    }
    cells.emplace_back(trimmed(cell));
    // A delimiter at the end of every line makes no column.
    if (cells.size() > 1 && cells.back().empty()) cells.pop_back();
    return cells;
}

bool has_digit(std::string_view text) {
    return std::any_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

struct Line {
    int number;
    std::string_view text;
};

/// How a file may be written, and how well its lines fit to that.
struct Dialect {
    char delimiter;
    char decimal;
    std::size_t columns = 0;
    double score = 0.0;
};

/// Numbers in a row of numbers; 0 when it is none: fewer than two, or a cell with digits that is no number.
std::size_t numbers_in(const std::vector<std::string>& cells, char decimal) {
    std::size_t numbers = 0;
    for (const std::string& cell : cells) {
        if (!std::isnan(cell_number(cell, decimal)))
            ++numbers;
        else if (has_digit(cell))
            return 0;
    }
    return numbers >= 2 ? numbers : 0;
}

void rate(Dialect& dialect, const std::vector<Line>& lines) {
    std::map<std::size_t, double> rows_by_columns;
    const std::size_t stride = std::max<std::size_t>(1, lines.size() / 500);
    for (std::size_t i = 0; i < lines.size(); i += stride) {
        const std::vector<std::string> cells = split(lines[i].text, dialect.delimiter);
        const std::size_t numbers = numbers_in(cells, dialect.decimal);
        if (numbers > 0) rows_by_columns[cells.size()] += 1.0 + 1e-3 * static_cast<double>(numbers);
    }
    for (const auto& [columns, score] : rows_by_columns) {
        if (score <= dialect.score) continue;
        dialect.score = score;
        dialect.columns = columns;
    }
}

bool unit_like(std::string_view cell) {
    return cell.size() <= 12 && !has_digit(cell) &&
           (cell.empty() || cell.front() == '(' || cell.front() == '[' || cell.size() <= 5);
}

/// Names, and units below them, from the lines right above the first row of numbers.
void take_header(CsvTable& table, const std::vector<Line>& lines, std::size_t first) {
    std::vector<std::pair<int, std::vector<std::string>>> above;
    for (std::size_t i = first; i > 0 && above.size() < 3; --i) {
        std::vector<std::string> cells = split(lines[i - 1].text, table.delimiter);
        if (cells.size() + 1 < table.column_count() || cells.size() > table.column_count() + 1) break;
        if (cells.size() < 2) break;
        cells.resize(table.column_count());
        above.emplace_back(lines[i - 1].number, std::move(cells));
    }
    if (above.empty()) return;
    std::size_t names = 0;
    const auto& nearest = above.front().second;
    const bool units = std::all_of(nearest.begin(), nearest.end(), unit_like) &&
                       std::any_of(nearest.begin(), nearest.end(), [](auto& c) { return !c.empty(); });
    if (units && above.size() > 1) {
        table.units = nearest;
        names = 1;
    }
    table.header_line = above[names].first;
    table.names = above[names].second;
}

std::vector<Line> lines_of(std::string_view text) {
    std::vector<Line> lines;
    TextScan scan(text);
    while (!scan.at_end()) {
        const std::string_view line = trimmed(scan.take_line());
        if (!line.empty() && line.front() != '#') lines.push_back({scan.line(), line});
    }
    return lines;
}

void append_utf8(std::string& text, std::uint32_t code) {
    if (code < 0x80U) {
        text += static_cast<char>(code);
    } else if (code < 0x800U) {
        text += static_cast<char>(0xC0U | code >> 6U);
        text += static_cast<char>(0x80U | (code & 0x3FU));
    } else {
        text += static_cast<char>(0xE0U | code >> 12U);
        text += static_cast<char>(0x80U | (code >> 6U & 0x3FU));
        text += static_cast<char>(0x80U | (code & 0x3FU));
    }
}

/// Machines write nothing beyond the first plane of Unicode; a surrogate becomes a replacement character.
std::string from_utf16(std::string_view bytes, bool big_endian) {
    std::string text;
    for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
        const auto a = static_cast<unsigned char>(bytes[i]);
        const auto b = static_cast<unsigned char>(bytes[i + 1]);
        const std::uint32_t code = big_endian ? 256U * a + b : 256U * b + a;
        append_utf8(text, code >= 0xD800U && code < 0xE000U ? 0xFFFDU : code);
    }
    return text;
}

bool is_utf8(std::string_view bytes) {
    std::size_t follow = 0;
    for (const char c : bytes) {
        const auto byte = static_cast<unsigned char>(c);
        if (follow > 0) {
            if ((byte & 0xC0U) != 0x80U) return false;
            --follow;
        } else if (byte >= 0x80U) {
            if (byte < 0xC2U || byte > 0xF4U) return false;
            follow = byte < 0xE0U ? 1 : byte < 0xF0U ? 2 : 3;
        }
    }
    return follow == 0;
}

}  // namespace

double cell_number(std::string_view cell, char decimal) {
    cell = trimmed(cell);
    if (cell.starts_with('+')) cell.remove_prefix(1);
    if (cell.empty() || cell.size() > 40) return no_number;
    std::array<char, 48> plain{};
    std::size_t size = 0;
    const char thousands = decimal == '.' ? ',' : '.';
    const std::size_t mark = cell.find(decimal);
    for (std::size_t i = 0; i < cell.size(); ++i) {
        if (cell[i] == decimal) {
            plain[size++] = '.';
        } else if (cell[i] == thousands) {
            // Groups of three digits before the decimal mark, with a digit before and three behind each.
            const std::size_t end = mark == std::string_view::npos ? cell.size() : mark;
            if (i == 0 || i > end || (end - i) % 4 != 0) return no_number;
        } else {
            plain[size++] = cell[i];
        }
    }
    const char first = plain[0] == '-' ? plain[1] : plain[0];
    if (!((first >= '0' && first <= '9') || first == '.')) return no_number;  // "inf", "nan"
    double number = 0.0;
    const auto [stop, error] = std::from_chars(plain.data(), plain.data() + size, number);
    return error == std::errc() && stop == plain.data() + size ? number : no_number;
}

std::string text_of(std::string_view bytes, const std::string& file) {
    if (bytes.starts_with("\xFF\xFE")) return from_utf16(bytes, false);
    if (bytes.starts_with("\xFE\xFF")) return from_utf16(bytes, true);
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
    if (bytes.find('\0') != std::string_view::npos)
        throw InputError({.file = file}, "is a binary file, expected a table as text",
                         "Export the test as CSV or text; spreadsheets (xls, xlsx) cannot be read.");
    if (is_utf8(bytes)) return std::string(bytes);
    std::string text;
    for (const char c : bytes) append_utf8(text, static_cast<unsigned char>(c));
    return text;
}

CsvTable parse_csv(std::string_view bytes, const std::string& file) {
    std::string text = text_of(bytes, file);
    // Old Macs end lines with a carriage return alone.
    if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
    const std::vector<Line> lines = lines_of(text);
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
    CsvTable table{.file = file, .delimiter = best.delimiter, .decimal = best.decimal};
    std::size_t first = 0;
    bool found = false;
    const auto numbers = [&](std::size_t i) {
        if (i >= lines.size()) return false;
        const std::vector<std::string> cells = split(lines[i].text, best.delimiter);
        return cells.size() == best.columns && numbers_in(cells, best.decimal) > 0;
    };
    for (std::size_t i = 0; i < lines.size(); ++i) {
        // A single row of numbers among the remarks above the table is not its first row.
        if (!found && numbers(i) && (numbers(i + 1) || i + 1 == lines.size())) {
            found = true;
            first = i;
        }
        if (found) table.rows.push_back({lines[i].number, split(lines[i].text, best.delimiter)});
    }
    if (!found)
        throw InputError({.file = file}, "has no two rows of numbers that follow each other",
                         "A test is a table with a row for each reading.");
    take_header(table, lines, first);
    return table;
}

CsvTable read_csv_table(const std::string& path) {
    constexpr std::size_t longest = 32U << 20U;
    try {
        return parse_csv(read_file(path, "file of a test", longest), path);
    } catch (const InputError& error) {
        if (!error.advice().empty() || error.problem().find("longer than") == std::string::npos) throw;
        throw InputError(
            error.place(), error.problem(),
            "A test has some thousand rows: 5 to 50 readings a second are plenty. Export it with "
            "fewer.");
    }
}

}  // namespace ruche
