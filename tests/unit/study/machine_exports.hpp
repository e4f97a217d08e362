#pragma once

#include <functional>
#include <string>
#include <vector>

/// Tension tests as the programs of testing machines export them: each file is made from the same test, with
/// that program's habits.
namespace ruche::test {

inline constexpr double sample_length = 110.0;
inline constexpr double sample_width = 20.0;

struct Reading {
    double time, displacement, force, width;  // s, mm, N, mm
};
using Test = std::vector<Reading>;

/// Cycles of loading, a tenth stiffer, and of unloading as the law says.
Test test_of(int cycles, int rows = 60);

/// Every number of the test times a factor, or so.
Test changed(Test test, const std::function<void(Reading&)>& change);

/// A line for each reading.
std::string rows_of(const Test& test, const std::function<std::string(const Reading&)>& row);
std::string plain_row(const Reading& r);
std::string quoted_row(const Reading& r);
std::string german_row(const Reading& r);
std::string replaced(std::string text, char what, char by);

inline const std::string bluehill_names = "\"Time\",\"Extension\",\"Load\"\r\n\"(s)\",\"(mm)\",\"(N)\"\r\n";

struct Export {
    std::string name;
    std::string bytes;
    std::string more;  ///< of its [[tension]]
    std::string
        trouble;  ///< what is wrong: in the error, or "warning: " and what the card keeps; empty: nothing
};

/// What else the documentation of the programs offer: blocks of parameters and results with titles above,
/// between and below, other encodings and separators, names in the user's language.
std::vector<Export> other_layouts();

}  // namespace ruche::test
