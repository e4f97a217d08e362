#include "ruche/core/fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "ruche/core/suggest.hpp"

namespace ruche {

std::string unit_suffix(std::string_view unit) {
    std::string suffix;
    for (const char c : unit) {
        if (c == '/')
            suffix += "_per_";
        else if (c == ' ')
            suffix += '_';
        else if (c >= 'A' && c <= 'Z')
            suffix += static_cast<char>(c - 'A' + 'a');
        else if (c != '^')
            suffix += c;
    }
    return suffix.empty() ? suffix : "_" + suffix;
}

std::string_view bare_name(const FieldInfo& info) {
    const std::string suffix = unit_suffix(info.unit);
    return info.key.ends_with(suffix) ? info.key.substr(0, info.key.size() - suffix.size()) : info.key;
}

static std::string numbers_text(std::span<const double> numbers) {
    return fmt::format("[{}]", fmt::join(numbers, ", "));
}

std::string to_string(const FieldValue& value) {
    struct Text {
        std::string operator()(double number) const { return fmt::format("{}", number); }
        std::string operator()(int number) const { return fmt::format("{}", number); }
        std::string operator()(bool flag) const { return flag ? "true" : "false"; }
        std::string operator()(const std::string& text) const { return text; }
        std::string operator()(const std::array<double, 2>& pair) const { return numbers_text(pair); }
        std::string operator()(const std::array<double, 3>& triple) const { return numbers_text(triple); }
    };
    return std::visit(Text{}, value);
}

std::string range_text(const FieldInfo& info) {
    if (std::isfinite(info.low) && std::isfinite(info.high))
        return fmt::format("[{}, {}]", info.low, info.high);
    if (std::isfinite(info.low)) return fmt::format("at least {}", info.low);
    if (std::isfinite(info.high)) return fmt::format("at most {}", info.high);
    return {};
}

static void check_number(const FieldInfo& info, double number, const Place& place) {
    const std::string meaning(info.meaning);
    if (!std::isfinite(number))
        throw InputError(place, fmt::format("{} is not a finite number", number), meaning);
    if (number >= info.low && number <= info.high) return;
    const bool interval = std::isfinite(info.low) && std::isfinite(info.high);
    throw InputError(
        place, fmt::format("{} is {} {}", number, interval ? "outside" : "not", range_text(info)), meaning);
}

void check(const FieldInfo& info, const FieldValue& value, const Place& place) {
    if (const auto* number = std::get_if<double>(&value)) check_number(info, *number, place);
    if (const auto* integer = std::get_if<int>(&value)) check_number(info, *integer, place);
    if (const auto* pair = std::get_if<std::array<double, 2>>(&value))
        for (const double number : *pair) check_number(info, number, place);
    if (const auto* triple = std::get_if<std::array<double, 3>>(&value))
        for (const double number : *triple) check_number(info, number, place);
    const auto* name = std::get_if<std::string>(&value);
    if (info.kind != FieldKind::choice || name == nullptr) return;
    if (std::find(info.names.begin(), info.names.end(), *name) == info.names.end())
        throw InputError(place,
                         fmt::format("\"{}\" is none of {}{}", *name, fmt::join(info.names, ", "),
                                     did_you_mean(*name, {info.names.begin(), info.names.end()})),
                         std::string(info.meaning));
}

}  // namespace ruche
