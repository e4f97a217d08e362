#pragma once

#include <string>
#include <string_view>

#include "ruche/core/fields.hpp"

namespace ruche {

/// Title, purpose and the first lines of a section's table, in Markdown.
std::string manual_heading(std::string_view title, std::string_view purpose);

/// A row of that table: key, default, unit, what is allowed, meaning. `initial` as written in a file.
std::string manual_row(const FieldInfo& about, std::string_view initial);

/// A text as a cell of a table.
std::string markdown_cell(std::string_view text);

/// A value as it is written in a TOML file.
std::string written(const FieldInfo& about, const FieldValue& value);

/// What a field takes: "\"front\" | \"back\"", "[1, 3]"; empty when any value will do.
std::string admissible(const FieldInfo& about);

/// A row for each field of a struct, with its values as defaults.
template <class Struct>
std::string manual_rows(const Struct& s) {
    std::string text;
    for (const Field<Struct>& field : fields<Struct>())
        text += manual_row(info(field), written(info(field), get(s, field)));
    return text;
}

}  // namespace ruche
