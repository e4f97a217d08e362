#pragma once

#include <array>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

#include "ruche/core/error.hpp"

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

    std::string_view key;      ///< as written in files: the bare name and the unit's suffix, "thickness_mm"
    Member member;             ///< a two-vector may also be written as one number (both components)
    std::string_view unit;     ///< "mm", "MPa", "kg/m^2", ... or ""; `unit_suffix` is what the key ends with
    double low = -infinity;    ///< smallest admissible value (numbers only, each component)
    double high = infinity;    ///< largest admissible value
    std::string_view meaning;  ///< a sentence or two; for help, manual and error messages
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

/// The value of any field; a choice is its name.
using FieldValue = std::variant<double, int, bool, std::string, std::array<double, 2>, std::array<double, 3>>;

enum class FieldKind { number, integer, boolean, text, two_numbers, three_numbers, choice };

/// What a field says about itself, whatever struct it belongs to.
struct FieldInfo {
    std::string_view key;
    std::string_view unit;
    double low = -infinity;
    double high = infinity;
    std::string_view meaning;
    FieldKind kind = FieldKind::number;
    std::span<const std::string_view> names;  ///< of a choice
};

/// "_mpa" for "MPa", "_kg_per_m2" for "kg/m^2", "_mm_per_s2" for "mm/s^2"; empty for no unit.
std::string unit_suffix(std::string_view unit);

/// The key without its unit's suffix: "fabric_thickness" for "fabric_thickness_mm".
std::string_view bare_name(const FieldInfo& info);

/// "1.7", "[1.7, 1.6]", "true", "front": for people and files; numbers so that reading gives the same bits.
std::string to_string(const FieldValue& value);

/// "[1, 3]", "at least 0", ...; empty when any number will do.
std::string range_text(const FieldInfo& info);

/// Throws InputError when a number is not finite or outside the field's range, or a choice is none of its
/// names.
void check(const FieldInfo& info, const FieldValue& value, const Place& place);

template <class Struct>
FieldInfo info(const Field<Struct>& field) {
    FieldInfo result{field.key,  field.unit,    field.low,
                     field.high, field.meaning, static_cast<FieldKind>(field.member.index())};
    if (const auto* names = std::get_if<Choice<Struct>>(&field.member)) result.names = names->names;
    return result;
}

/// Whether a struct can have a member of a type at all. In none smaller than the type: saying so spares `get`
/// and `set` the impossible cases, in which the compiler sees reads and writes beyond the struct.
template <class Struct, class Value>
constexpr bool can_have(Value Struct::*) {
    return sizeof(Value) <= sizeof(Struct);
}

template <class Struct>
FieldValue get(const Struct& s, const Field<Struct>& field) {
    return std::visit(
        [&](const auto& member) -> FieldValue {
            if constexpr (std::is_same_v<std::decay_t<decltype(member)>, Choice<Struct>>)
                return std::string(member.names[static_cast<std::size_t>(member.get(s))]);
            else if constexpr (can_have(std::decay_t<decltype(member)>{}))
                return s.*member;
            else
                return {};
        },
        field.member);
}

/// `value` must be of the field's kind and pass `check`.
template <class Struct>
void set(Struct& s, const Field<Struct>& field, const FieldValue& value) {
    std::visit(
        [&](const auto& member) {
            if constexpr (std::is_same_v<std::decay_t<decltype(member)>, Choice<Struct>>) {
                const auto& name = std::get<std::string>(value);
                for (int i = 0; i < static_cast<int>(member.names.size()); ++i)
                    if (member.names[static_cast<std::size_t>(i)] == name) member.set(s, i);
            } else if constexpr (can_have(std::decay_t<decltype(member)>{})) {
                s.*member = std::get<std::decay_t<decltype(s.*member)>>(value);
            }
        },
        field.member);
}

/// Checks every field of a struct that was filled in code or from Python; `section` is the key's prefix in
/// messages ("material").
template <class Struct>
void check_fields(const Struct& s, const std::string& section) {
    for (const Field<Struct>& field : fields<Struct>())
        check(info(field), get(s, field), {.key = section + "." + std::string(field.key)});
}

}  // namespace ruche
