#pragma once

#include <string_view>
#include <vector>

namespace ruche {

/// The cells of one line of a small table, without blanks and quotes around them. They are cut at commas,
/// semicolons and tabs, or at blanks where there are none of these; what follows '#' is a comment. Empty for
/// an empty line and for one that is all comment.
std::vector<std::string_view> table_cells(std::string_view line);

/// The whole cell as a finite number with a decimal point; false when it is anything else.
bool read_finite(std::string_view cell, double& number);

/// A text without the mark that some programs begin UTF-8 files with.
std::string_view without_byte_order_mark(std::string_view text);

}  // namespace ruche
