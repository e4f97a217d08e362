#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>

namespace ruche {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// An enumeration member seen as one of a list of names (the index is the enumerator's value).
template <class Struct>
struct Choice {
    std::span<const std::string_view> names;
    int (*get)(const Struct&) = nullptr;
    void (*set)(Struct&, int) = nullptr;
};

/// One user-visible parameter of a struct. The table of a struct's fields (`fields<Struct>()`) is the only
/// place that drives the scene reader, range checks, help, manual, Python properties and sweep axes.
template <class Struct>
struct Field {
    using Member =
        std::variant<double Struct::*, int Struct::*, bool Struct::*, std::string Struct::*,
                     std::array<double, 2> Struct::*, std::array<double, 3> Struct::*, Choice<Struct>>;

    std::string_view key;  ///< as written in files, the unit is part of it: "thickness_mm"
    Member member;         ///< a two-vector may also be written as one number (both components)
    std::string_view
        unit;  ///< "mm", "MPa", ... or "" (also for Python, where the key's unit suffix is dropped)
    double low = -infinity;    ///< smallest admissible value (numbers only, each component)
    double high = infinity;    ///< largest admissible value
    std::string_view meaning;  ///< one sentence; for help, manual and error messages
};

/// The table of a struct; specialised beside each parameter struct.
template <class Struct>
std::span<const Field<Struct>> fields();

/// Makes a `Choice` from a pointer to an enumeration member: `choice<&Options::edge_normals>(names)`.
template <auto Member>
struct ChoiceOf;
template <class Struct, class Enum, Enum Struct::*Member>
struct ChoiceOf<Member> {
    static Choice<Struct> with(std::span<const std::string_view> names) {
        return {names, [](const Struct& s) { return static_cast<int>(s.*Member); },
                [](Struct& s, int value) { s.*Member = static_cast<Enum>(value); }};
    }
};
template <auto Member>
auto choice(std::span<const std::string_view> names) {
    return ChoiceOf<Member>::with(names);
}

}  // namespace ruche
