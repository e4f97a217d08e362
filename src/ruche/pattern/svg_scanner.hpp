#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ruche::svg {

/// Steps through the small languages inside SVG attributes: numbers, lengths, path data, transforms.
class Scanner {
  public:
    explicit Scanner(std::string_view text) : text_(text) {}

    bool at_end() const { return position_ >= text_.size(); }
    char peek() const { return at_end() ? '\0' : text_[position_]; }
    std::size_t position() const { return position_; }
    std::string_view rest() const { return text_.substr(position_); }

    bool accept(char c);
    void skip_space();
    /// White space with at most one comma in it.
    void skip_separator();
    /// SVG's number: optional sign, digits, fraction, exponent; never "inf" or "nan". Stays where it is when
    /// there is none or when it overflows. In "1em" the number is 1, in "1.5.5" it is 1.5.
    std::optional<double> number();
    /// An arc's flag: one character, 0 or 1, that may touch what follows.
    std::optional<bool> flag();
    /// Letters, digits and hyphens; perhaps none.
    std::string_view word();

  private:
    std::string_view text_;
    std::size_t position_ = 0;
};

bool is_space(char c);
std::string_view trimmed(std::string_view text);
std::string lower_case(std::string_view text);

/// A number as the whole text, surrounding white space aside.
std::optional<double> parse_number(std::string_view text);
/// A number or a percentage, 1 = 100 %.
std::optional<double> parse_fraction(std::string_view text);
/// Numbers separated by white space or commas; empty when anything else is in the text.
std::vector<double> parse_numbers(std::string_view text);

inline constexpr double mm_per_px = 25.4 / 96.0;  ///< CSS: 96 px are an inch

enum class Unit { none, px, pt, pc, mm, cm, in, q, em, ex, percent };

struct Length {
    double value = 0.0;
    Unit unit = Unit::none;

    /// mm, cm, in, pt, pc or Q: a length on paper.
    bool physical() const;
    /// In px; `whole` is what 100 % means. A font size of 16 px is assumed for em and ex.
    double px(double whole) const;
};

std::optional<Length> parse_length(std::string_view text);

}  // namespace ruche::svg
