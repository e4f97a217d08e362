#pragma once

#include <charconv>
#include <string_view>

namespace ruche {

/// Takes lines and words from a text, without copies and whatever the locale.
class TextScan {
  public:
    explicit TextScan(std::string_view text) : rest_(text) {}

    bool at_end() const { return rest_.empty(); }
    int line() const { return line_; }  ///< number of the line taken last, from 1
    std::string_view rest() const { return rest_; }

    /// The next line without its end ("\n" or "\r\n").
    std::string_view take_line() {
        const auto end = rest_.find('\n');
        std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
        if (line.ends_with('\r')) line.remove_suffix(1);
        ++line_;
        return line;
    }

  private:
    std::string_view rest_;
    int line_ = 0;
};

/// The next word of `line`, which is shortened by it; empty at the end.
inline std::string_view take_word(std::string_view& line) {
    const auto begin = line.find_first_not_of(" \t");
    if (begin == std::string_view::npos) {
        line = {};
        return {};
    }
    const auto end = line.find_first_of(" \t", begin);
    const std::string_view word = line.substr(begin, end == std::string_view::npos ? end : end - begin);
    line.remove_prefix(end == std::string_view::npos ? line.size() : end);
    return word;
}

/// The whole of `text` as a number with a decimal point; false when it is anything else.
template <class Number>
bool read_number(std::string_view text, Number& number) {
    if (text.starts_with('+')) text.remove_prefix(1);
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    return error == std::errc() && stop == end && !text.empty();
}

}  // namespace ruche
