#include <fmt/format.h>

#include <algorithm>

#include "ruche/study/virtual_test/virtual_machine.hpp"

namespace ruche {
namespace {

/// A program's habits.
struct Style {
    std::string_view preamble;  // "{}": the sample's name
    std::array<std::string_view, 4> names;
    std::array<std::string_view, 4> units;  // empty: no row of units
    char separator;
    char decimal_point;
    bool quoted_names;
    bool quoted_values;
    std::string_view line_end;
};

const Style& style_of(MachineFormat format) {
    static const Style plain{.preamble = "",
                             .names = {"time_s", "displacement_mm", "force_N", "width_mm"},
                             .separator = ',',
                             .decimal_point = '.',
                             .line_end = "\n"};
    static const Style bluehill{
        .preamble = "\"Specimen label\",\"{}\"\r\n\"Test method\",\"Tension cyclic\"\r\n\r\n",
        .names = {"Time", "Extension", "Load", "Width"},
        .units = {"(s)", "(mm)", "(N)", "(mm)"},
        .separator = ',',
        .decimal_point = '.',
        .quoted_names = true,
        .quoted_values = true,
        .line_end = "\r\n"};
    // Latin-1: the u with dots is one byte.
    static const Style zwick{.preamble = "\"Probe\";\"{}\"\r\n\r\n",
                             .names = {"Pr\xfc"
                                       "fzeit",
                                       "Standardweg", "Standardkraft", "Probenbreite"},
                             .units = {"s", "mm", "N", "mm"},
                             .separator = ';',
                             .decimal_point = ',',
                             .quoted_names = true,
                             .line_end = "\r\n"};
    switch (format) {
        case MachineFormat::bluehill:
            return bluehill;
        case MachineFormat::zwick:
            return zwick;
        default:
            return plain;
    }
}

void add_row(std::string& text, const Style& style, std::vector<std::string> cells, bool quoted) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (i > 0) text += style.separator;
        if (quoted) text += '"';
        text += cells[i];
        if (quoted) text += '"';
    }
    text += style.line_end;
}

std::string number(double value, int decimals, char decimal_point) {
    std::string text = fmt::format("{:.{}f}", value, decimals);
    std::replace(text.begin(), text.end(), '.', decimal_point);
    return text;
}

}  // namespace

std::string machine_csv(const MachineRecord& record, const std::string& sample, MachineFormat format) {
    const Style& style = style_of(format);
    const std::size_t columns = record.width.empty() ? 3 : 4;
    const auto first_of = [&](const std::array<std::string_view, 4>& all) {
        return std::vector<std::string>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(columns));
    };
    std::string text;
    if (!style.preamble.empty()) text += fmt::format(fmt::runtime(style.preamble), sample);
    add_row(text, style, first_of(style.names), style.quoted_names);
    if (!style.units[0].empty()) add_row(text, style, first_of(style.units), style.quoted_names);
    for (std::size_t i = 0; i < record.time.size(); ++i) {
        std::vector<std::string> cells = {number(record.time[i], 3, style.decimal_point),
                                          number(record.displacement[i], 5, style.decimal_point),
                                          number(record.force[i], 6, style.decimal_point)};
        if (columns == 4) cells.push_back(number(record.width[i], 4, style.decimal_point));
        add_row(text, style, std::move(cells), style.quoted_values);
    }
    return text;
}

}  // namespace ruche
