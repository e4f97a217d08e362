#include "ruche/study/calibration/column_names.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace ruche {
namespace {

using Names = std::span<const std::string_view>;

constexpr std::string_view force_names[] = {
    "load",   "force",  "standard force", "standardkraft", "kraft", "carga",     "fuerza", "forza",
    "charge", "effort", "carico",         "prüfkraft",     "last",  "load cell", "f"};
constexpr std::string_view displacement_names[] = {"extension",
                                                   "displacement",
                                                   "standard travel",
                                                   "standardweg",
                                                   "traversenweg",
                                                   "verfahrweg",
                                                   "kolbenweg",
                                                   "weg",
                                                   "verschiebung",
                                                   "crosshead",
                                                   "travel",
                                                   "stroke",
                                                   "elongation",
                                                   "verlängerung",
                                                   "allongement",
                                                   "déplacement",
                                                   "desplazamiento",
                                                   "alargamiento",
                                                   "spostamento",
                                                   "allungamento",
                                                   "position",
                                                   "distance",
                                                   "abstand",
                                                   "längenänderung",
                                                   "course",
                                                   "dehnung",
                                                   "strain",
                                                   "deformation",
                                                   "déformation",
                                                   "deformación",
                                                   "deformazione",
                                                   "d",
                                                   "dl",
                                                   "Δl"};
constexpr std::string_view strain_names[] = {"strain",      "dehnung",     "deformation",
                                             "déformation", "deformación", "deformazione"};
// Not the quantity itself but a rate, its largest value, what is derived from it.
constexpr std::string_view other_words[] = {"rate", "speed", "max", "vitesse", "stress", "spannung", "energ"};
constexpr std::string_view change_words[] = {"änderung", "change", "reduction", "verringerung"};
constexpr std::string_view width_names[] = {"width", "breite", "largeur", "ancho", "larghezza", "w"};
constexpr std::string_view branch_columns[] = {"branch", "direction", "richtung", "phase", "sens"};
constexpr std::string_view mass_names[] = {"mass",    "hung mass", "masse", "weight",
                                           "gewicht", "masa",      "massa", "m"};
constexpr std::string_view length_names[] = {"length", "länge", "longueur", "longitud", "lunghezza", "l"};

Names names_of(Quantity quantity) {
    switch (quantity) {
        case Quantity::force:
            return force_names;
        case Quantity::displacement:
            return displacement_names;
        case Quantity::width:
            return width_names;
        case Quantity::branch:
            return branch_columns;
        case Quantity::mass:
            return mass_names;
        case Quantity::length:
            return length_names;
    }
    return {};
}

struct Unit {
    std::string_view name;
    UnitScale scale;
};

constexpr double standard_gravity = 9.80665;
constexpr Unit force_units[] = {{"n", {1.0}},
                                {"kn", {1e3}},
                                {"mn", {1e-3}},
                                {"cn", {1e-2}},
                                {"dan", {10.0}},
                                {"newton", {1.0}},
                                {"newtons", {1.0}},
                                {"gf", {1e-3 * standard_gravity}},
                                {"g", {1e-3 * standard_gravity}},
                                {"kgf", {standard_gravity}},
                                {"kp", {standard_gravity}},
                                {"ozf", {0.27801385095378}},
                                {"lb", {4.4482216152605}},
                                {"lbs", {4.4482216152605}},
                                {"lbf", {4.4482216152605}}};
constexpr Unit length_units[] = {
    {"mm", {1.0}},          {"cm", {10.0}},         {"m", {1e3}},           {"µm", {1e-3}},
    {"um", {1e-3}},         {"in", {25.4}},         {"inch", {25.4}},       {"inches", {25.4}},
    {"millimeter", {1.0}},  {"millimeters", {1.0}}, {"%", {1e-2, true}},    {"percent", {1e-2, true}},
    {"mm/mm", {1.0, true}}, {"m/m", {1.0, true}},   {"in/in", {1.0, true}}, {"-", {1.0, true}}};
constexpr Unit mass_units[] = {{"g", {1e-3 * standard_gravity}}, {"kg", {standard_gravity}}};

std::span<const Unit> units_of(Quantity quantity) {
    switch (quantity) {
        case Quantity::force:
            return force_units;
        case Quantity::displacement:
        case Quantity::width:
        case Quantity::length:
            return length_units;
        case Quantity::mass:
            return mass_units;
        case Quantity::branch:
            return {};
    }
    return {};
}

/// "n" of "(N)".
std::string without_brackets(std::string_view unit) {
    std::string text = folded(unit);
    while (!text.empty() && (text.front() == '(' || text.front() == '[' || text.front() == '<'))
        text.erase(0, 1);
    while (!text.empty() && (text.back() == ')' || text.back() == ']' || text.back() == '>')) text.pop_back();
    return folded(text);
}

constexpr std::string_view time_units[] = {"s",  "sec", "sec.", "secs",    "seconds",
                                           "ms", "min", "h",    "hh:mm:ss"};
constexpr std::string_view unit_marks[] = {" in ", " / ", ", ", " ", "_", "/"};

/// Where the unit behind a mark begins, "Kraft in N", "Kraft, N", "F/N", "width_mm"; npos without.
std::size_t marked_unit(const std::string& text, std::size_t& mark_at) {
    for (const std::string_view mark : unit_marks) {
        mark_at = mark == "/" ? text.find(mark) : text.rfind(mark);
        if (mark_at == std::string::npos) continue;
        // "width_mm" has a unit, "machine_force" has none.
        const std::size_t begin = mark_at + mark.size();
        if (is_unit(std::string_view(text).substr(begin))) return begin;
    }
    return std::string::npos;
}

/// The name without its unit.
std::string bare(std::string_view name) {
    std::string text = folded(name);
    for (const char bracket : {'(', '['}) text = text.substr(0, text.find(bracket));
    text = folded(text);
    std::size_t mark = 0;
    if (marked_unit(text, mark) != std::string::npos) text = text.substr(0, mark);
    for (char& c : text) c = c == '_' || c == '-' ? ' ' : c;
    return folded(text);
}

}  // namespace

bool is_unit(std::string_view cell) {
    if (folded(cell).empty()) return false;
    for (const Quantity q : {Quantity::force, Quantity::displacement, Quantity::mass})
        if (unit_scale(q, cell)) return true;
    const std::string text = without_brackets(cell);
    return std::find(std::begin(time_units), std::end(time_units), text) != std::end(time_units);
}

bool names_strain(std::string_view name) {
    const std::string text = bare(name);
    return std::any_of(std::begin(strain_names), std::end(strain_names),
                       [&](std::string_view word) { return text.find(word) != std::string::npos; });
}

std::string_view quantity_name(Quantity quantity) {
    constexpr std::array<std::string_view, 6> names = {"force",  "displacement", "width",
                                                       "branch", "mass",         "length"};
    return names[static_cast<std::size_t>(quantity)];
}

std::string folded(std::string_view text) {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '"' || c == '\''; };
    while (!text.empty() && blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && blank(text.back())) text.remove_suffix(1);
    std::string lower(text);
    for (std::size_t i = 0; i < lower.size(); ++i) {
        const auto byte = static_cast<unsigned char>(lower[i]);
        if (byte >= 'A' && byte <= 'Z') lower[i] = static_cast<char>(byte + 32);
        // U+00C0 to U+00DE, "À" to "Þ", are C3 80 to C3 9E in UTF-8; small letters lie 32 above.
        const bool after_c3 = i > 0 && static_cast<unsigned char>(lower[i - 1]) == 0xC3U;
        if (after_c3 && byte >= 0x80U && byte <= 0x9EU) lower[i] = static_cast<char>(byte + 32);
    }
    return lower;
}

int name_score(Quantity quantity, std::string_view name) {
    const std::string text = bare(name);
    if (text.empty()) return 0;
    for (const std::string_view word : other_words)
        if (text.find(word) != std::string::npos) return 0;
    for (const std::string_view word : change_words)
        if (quantity == Quantity::width && text.find(word) != std::string::npos) return 0;
    int best = 0;
    int rank = 100;
    for (const std::string_view known : names_of(quantity)) {
        --rank;
        const std::string wanted = folded(known);
        if (text == wanted)
            best = std::max(best, 200 + rank);
        else if (wanted.size() > 2 && (text.starts_with(wanted + " ") || text.ends_with(" " + wanted)))
            best = std::max(best, 100 + rank);
        else if (wanted.size() > 4 && text.find(wanted) != std::string::npos)
            best = std::max(best, rank);
    }
    return best;
}

std::string unit_in_name(std::string_view name) {
    const std::string text = folded(name);
    for (const auto& [open, close] : {std::pair{'(', ')'}, {'[', ']'}}) {
        const std::size_t end = text.rfind(close);
        const std::size_t begin = text.rfind(open, end);
        if (end != std::string::npos && begin != std::string::npos && begin < end)
            return folded(std::string_view(text).substr(begin + 1, end - begin - 1));
    }
    std::size_t mark = 0;
    const std::size_t begin = marked_unit(text, mark);
    return begin == std::string::npos ? std::string() : folded(std::string_view(text).substr(begin));
}

std::optional<UnitScale> unit_scale(Quantity quantity, std::string_view unit) {
    const std::string text = without_brackets(unit);
    if (quantity == Quantity::force && unit.find("MN") != std::string_view::npos) return std::nullopt;
    for (const Unit& known : units_of(quantity))
        if (text == known.name) return known.scale;
    return std::nullopt;
}

}  // namespace ruche
