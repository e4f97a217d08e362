#include "ruche/pattern/svg_scanner.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace ruche::svg {

static bool is_digit(char c) { return c >= '0' && c <= '9'; }
static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Of a number that is out of a double's range: whether it is too small rather than too large.
static bool underflows(std::string_view number) {
    const std::size_t exponent = number.find_first_of("eE");
    const std::size_t point = std::min(number.find('.'), std::min(exponent, number.size()));
    const bool shrinks = exponent != std::string_view::npos && number[exponent + 1] == '-';
    return point < 300 && (shrinks || (exponent == std::string_view::npos && point < number.size()));
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f'; }

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    return text;
}

std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& c : lower) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return lower;
}

bool Scanner::accept(char c) {
    if (at_end() || text_[position_] != c) return false;
    ++position_;
    return true;
}

void Scanner::skip_space() {
    while (!at_end() && is_space(text_[position_])) ++position_;
}

void Scanner::skip_separator() {
    skip_space();
    if (accept(',')) skip_space();
}

std::optional<double> Scanner::number() {
    std::size_t i = position_;
    const auto digit_at = [&](std::size_t at) { return at < text_.size() && is_digit(text_[at]); };
    if (i < text_.size() && (text_[i] == '+' || text_[i] == '-')) ++i;
    const bool starts = digit_at(i) || (i < text_.size() && text_[i] == '.' && digit_at(i + 1));
    if (!starts) return std::nullopt;
    while (digit_at(i)) ++i;
    if (i < text_.size() && text_[i] == '.') {
        ++i;
        while (digit_at(i)) ++i;
    }
    if (i < text_.size() && (text_[i] == 'e' || text_[i] == 'E')) {
        std::size_t exponent = i + 1;
        if (exponent < text_.size() && (text_[exponent] == '+' || text_[exponent] == '-')) ++exponent;
        if (digit_at(exponent)) {
            while (digit_at(exponent)) ++exponent;
            i = exponent;
        }
    }
    // from_chars knows no plus sign.
    const std::string_view digits =
        text_.substr(position_, i - position_).substr(text_[position_] == '+' ? 1 : 0);
    double value = 0.0;
    const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (result.ec != std::errc() && !underflows(digits)) return std::nullopt;
    position_ = i;
    return value;
}

std::optional<bool> Scanner::flag() {
    if (accept('0')) return false;
    if (accept('1')) return true;
    return std::nullopt;
}

std::string_view Scanner::word() {
    const std::size_t first = position_;
    while (!at_end() && (is_letter(peek()) || is_digit(peek()) || peek() == '-')) ++position_;
    return text_.substr(first, position_ - first);
}

std::optional<double> parse_number(std::string_view text) {
    Scanner scanner(trimmed(text));
    const std::optional<double> value = scanner.number();
    return scanner.at_end() ? value : std::nullopt;
}

std::optional<double> parse_fraction(std::string_view text) {
    Scanner scanner(trimmed(text));
    std::optional<double> value = scanner.number();
    if (value && scanner.accept('%')) *value /= 100.0;
    return scanner.at_end() ? value : std::nullopt;
}

std::vector<double> parse_numbers(std::string_view text) {
    Scanner scanner(trimmed(text));
    std::vector<double> values;
    while (!scanner.at_end()) {
        const std::optional<double> value = scanner.number();
        if (!value) return {};
        values.push_back(*value);
        scanner.skip_separator();
    }
    return values;
}

bool Length::physical() const {
    return unit == Unit::mm || unit == Unit::cm || unit == Unit::in || unit == Unit::pt || unit == Unit::pc ||
           unit == Unit::q;
}

double Length::px(double whole) const {
    switch (unit) {
        case Unit::none:
        case Unit::px:
            return value;
        case Unit::pt:
            return value * 96.0 / 72.0;
        case Unit::pc:
            return value * 16.0;
        case Unit::mm:
            return value / mm_per_px;
        case Unit::cm:
            return value * 10.0 / mm_per_px;
        case Unit::in:
            return value * 96.0;
        case Unit::q:
            return value * 0.25 / mm_per_px;
        case Unit::em:
            return value * 16.0;
        case Unit::ex:
            return value * 8.0;
        case Unit::percent:
            return value / 100.0 * whole;
    }
    return value;
}

std::optional<Length> parse_length(std::string_view text) {
    static constexpr std::array<std::pair<std::string_view, Unit>, 12> units = {{{"", Unit::none},
                                                                                 {"px", Unit::px},
                                                                                 {"pt", Unit::pt},
                                                                                 {"pc", Unit::pc},
                                                                                 {"mm", Unit::mm},
                                                                                 {"cm", Unit::cm},
                                                                                 {"in", Unit::in},
                                                                                 {"q", Unit::q},
                                                                                 {"em", Unit::em},
                                                                                 {"rem", Unit::em},
                                                                                 {"ex", Unit::ex},
                                                                                 {"%", Unit::percent}}};
    Scanner scanner(trimmed(text));
    const std::optional<double> value = scanner.number();
    if (!value) return std::nullopt;
    const std::string suffix = lower_case(scanner.rest());
    const auto* unit =
        std::find_if(units.begin(), units.end(), [&](const auto& known) { return known.first == suffix; });
    if (unit == units.end()) return std::nullopt;
    return Length{*value, unit->second};
}

}  // namespace ruche::svg
