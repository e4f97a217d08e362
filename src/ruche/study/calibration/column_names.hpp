#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace ruche {

/// What a column of a test may hold.
enum class Quantity { force, displacement, width, branch, mass, length };

std::string_view quantity_name(Quantity quantity);

/// How well a column's name fits to a quantity: 0 not at all. Names as Instron (Bluehill) and Zwick
/// (testXpert) write them in English, German, French, Spanish and Italian, and as people abbreviate them.
int name_score(Quantity quantity, std::string_view name);

/// The unit in a name, "Load (N)", "Kraft [N]", "Weg in mm", "F / N"; empty without.
std::string unit_in_name(std::string_view name);

/// What a unit is in that of the program (N, mm, s), or per what a percentage or a strain is of.
struct UnitScale {
    double factor = 1.0;
    bool relative = false;  ///< times the gauge length (or width): "%", "mm/mm"
};
/// Nothing when it is no unit of that quantity.
std::optional<UnitScale> unit_scale(Quantity quantity, std::string_view unit);

/// Whether a cell, in brackets or not, is a unit of any quantity or of time.
bool is_unit(std::string_view cell);

/// Whether the name is that of a strain, whose unit cannot be guessed.
bool names_strain(std::string_view name);

/// Lower case for ASCII and the Latin letters of UTF-8, outer blanks and quotes off.
std::string folded(std::string_view text);

}  // namespace ruche
