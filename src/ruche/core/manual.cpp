#include "ruche/core/manual.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "ruche/core/document.hpp"

namespace ruche {

std::string markdown_cell(std::string_view text) {
    std::string cell;
    for (const char c : text) cell += c == '|' ? std::string("\\|") : std::string(1, c);
    return cell;
}

std::string manual_heading(std::string_view title, std::string_view purpose) {
    return fmt::format(
        "\n## `{}`\n{}\n\n| key | default | unit | allowed | meaning |\n|---|---|---|---|---|\n", title,
        purpose);
}

std::string manual_row(const FieldInfo& about, std::string_view initial) {
    const std::string shown = initial.empty() ? "" : fmt::format("`{}`", initial);
    return fmt::format("| `{}` | {} | {} | {} | {} |\n", about.key, shown, about.unit,
                       markdown_cell(admissible(about)), markdown_cell(about.meaning));
}

std::string written(const FieldInfo& about, const FieldValue& value) {
    const bool text = about.kind == FieldKind::text || about.kind == FieldKind::choice;
    return text ? toml_quoted(std::get<std::string>(value)) : to_string(value);
}

std::string admissible(const FieldInfo& about) {
    if (about.kind == FieldKind::choice) return fmt::format("\"{}\"", fmt::join(about.names, "\" | \""));
    return range_text(about);
}

}  // namespace ruche
