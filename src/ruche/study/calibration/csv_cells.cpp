#include "ruche/study/calibration/csv_cells.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>

#include "ruche/core/text_scan.hpp"

namespace ruche {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

void replace_all(std::string& text, std::string_view what, char by) {
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at))
        text.replace(at, what.size(), 1, by);
}

/// Typographic minus signs, blanks and apostrophes as those of ASCII.
std::string plain_marks(std::string_view cell) {
    std::string text(cell);
    for (const std::string_view minus : {"\u2212", "\u2013"}) replace_all(text, minus, '-');
    for (const std::string_view blank : {"\u00A0", "\u202F", "\u2009"}) replace_all(text, blank, ' ');
    replace_all(text, "\u2019", '\'');
    return text;
}

/// Digits without their groups' marks; nothing when the groups are not of three digits with one kind of mark.
std::optional<std::string> without_groups(std::string_view digits, char decimal, bool& grouped) {
    const char other = decimal == '.' ? ',' : '.';
    const auto is_mark = [&](char c) { return c == other || c == ' ' || c == '\''; };
    const auto first = std::find_if(digits.begin(), digits.end(), is_mark);
    grouped = first != digits.end();
    if (!grouped) return std::string(digits);
    const auto head = static_cast<std::size_t>(first - digits.begin());
    if (head < 1 || head > 3 || digits.front() == '0' || (digits.size() - head) % 4 != 0) return std::nullopt;
    std::string plain(digits.substr(0, head));
    for (std::size_t i = head; i < digits.size(); i += 4) {
        if (digits[i] != *first) return std::nullopt;
        plain += digits.substr(i + 1, 3);
    }
    return plain;
}

struct Parsed {
    double value = std::numeric_limits<double>::quiet_NaN();
    bool grouped = false;
};

Parsed parse(std::string_view cell, char decimal) {
    Parsed parsed;
    std::string marks;
    cell = trimmed(cell);
    if (cell.empty() || cell.size() > 40) return parsed;
    if (std::any_of(cell.begin(), cell.end(),
                    [](char c) { return static_cast<unsigned char>(c) >= 0x80U; })) {
        marks = plain_marks(cell);
        cell = trimmed(marks);
    }
    std::string plain;
    if (cell.starts_with('-')) plain = "-";
    if (cell.starts_with('-') || cell.starts_with('+')) cell.remove_prefix(1);
    const std::string_view mantissa = cell.substr(0, cell.find_first_of("eE"));
    const std::size_t mark = mantissa.find(decimal);
    const std::optional<std::string> whole =
        without_groups(mantissa.substr(0, mark), decimal, parsed.grouped);
    if (!whole) return parsed;
    const std::string_view behind = mark == std::string_view::npos ? "" : mantissa.substr(mark + 1);
    const auto digits = [](std::string_view text) { return std::all_of(text.begin(), text.end(), is_digit); };
    if (whole->size() + behind.size() == 0 || !digits(*whole) || !digits(behind)) return parsed;
    plain += *whole;
    if (!behind.empty()) plain += '.';
    plain += behind;
    std::string_view exponent = cell.substr(mantissa.size());
    if (exponent.size() == 1) return parsed;
    plain += exponent;
    double number = 0.0;
    const auto [stop, error] = std::from_chars(plain.data(), plain.data() + plain.size(), number);
    if (error == std::errc() && stop == plain.data() + plain.size()) parsed.value = number;
    return parsed;
}

}  // namespace

double cell_number(std::string_view cell, char decimal) { return parse(cell, decimal).value; }

bool is_grouped(std::string_view cell, char decimal) { return parse(cell, decimal).grouped; }

bool is_clock(std::string_view cell) {
    if (!has_digit(cell) || cell.find_first_not_of("0123456789:.,-/TZ +") != std::string_view::npos)
        return false;
    const auto count = [&](char c) { return std::count(cell.begin(), cell.end(), c); };
    return count(':') > 0 || count('-') == 2 || count('/') == 2 || count('.') == 2;
}

bool has_digit(std::string_view text) { return std::any_of(text.begin(), text.end(), is_digit); }
bool has_letter(std::string_view text) { return std::any_of(text.begin(), text.end(), is_letter); }

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
        text.remove_suffix(1);
    return text;
}

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
    if (cells.size() > 1 && cells.back().empty()) cells.pop_back();
    return cells;
}

}  // namespace ruche
