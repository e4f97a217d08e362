#include "ruche/pattern/table_cells.hpp"

#include <cmath>

#include "ruche/core/text_scan.hpp"

namespace ruche {

std::vector<std::string_view> table_cells(std::string_view line) {
    line = line.substr(0, line.find('#'));
    const bool separated = line.find_first_of(",;\t") != std::string_view::npos;
    const std::string_view separators = separated ? ",;\t" : " ";
    std::vector<std::string_view> cells;
    const auto add = [&](std::string_view cell) {
        const auto begin = cell.find_first_not_of(" \r\"");
        const auto end = cell.find_last_not_of(" \r\"");
        if (begin != std::string_view::npos)
            cells.push_back(cell.substr(begin, end - begin + 1));
        else if (separated)
            cells.emplace_back();
    };
    while (true) {
        const auto at = line.find_first_of(separators);
        add(line.substr(0, at));
        if (at == std::string_view::npos) break;
        line.remove_prefix(at + 1);
    }
    if (cells.size() == 1 && cells.front().empty()) cells.clear();
    return cells;
}

bool read_finite(std::string_view cell, double& number) {
    return read_number(cell, number) && std::isfinite(number);
}

std::string_view without_byte_order_mark(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    return text;
}

}  // namespace ruche
