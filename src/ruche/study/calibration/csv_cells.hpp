#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ruche {

/// A cell as a number with that decimal mark; NaN when it is none. Groups of three digits may be parted by
/// the other mark, a blank or an apostrophe: "1.234,5", "1 234,5", "1'234.5". A zero begins no group: "0,123"
/// is no number with a decimal point.
double cell_number(std::string_view cell, char decimal);

/// Whether a number is written in groups of three digits: with the wrong decimal mark many look so.
bool is_grouped(std::string_view cell, char decimal);

/// "10:11:12.5", "2024-05-03", "03.05.2024 10:11".
bool is_clock(std::string_view cell);

bool has_digit(std::string_view text);
bool has_letter(std::string_view text);

/// Cells of a line without quotes and outer blanks; quotes hold delimiters, a doubled quote is one. One
/// delimiter at the end makes no column. Delimiter ' ' means any blanks.
std::vector<std::string> split(std::string_view line, char delimiter);

/// Without blanks, tabs and carriage returns at the ends.
std::string_view trimmed(std::string_view text);

}  // namespace ruche
