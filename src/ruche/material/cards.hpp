#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ruche/material/material.hpp"

namespace ruche {

/// A value of a card, where it is from, and how far off it may be.
struct CardValue {
    double value = 0.0;
    std::string source;  ///< "paper Table 1", "measured 2026-03-02", "assumed: ..."
    std::optional<std::array<double, 2>> interval;
    std::vector<std::string> files;  ///< that it was found from: "tension-00.csv sha256:..."
};

/// What was found at one pre-stretch; by bare field name ("alpha_1").
struct CardSet {
    double prestretch = 1.0;
    std::map<std::string, CardValue> values;
};

/// A material card: a complete set of material parameters for each pre-stretch it was calibrated at.
struct MaterialCard {
    std::string name;
    std::string description;
    std::vector<CardSet> sets;          ///< pre-stretches increase
    std::vector<std::string> warnings;  ///< of its calibration; every simulation repeats them
    /// Of the plastic that was measured, mm: a record. A scene says how thick it is printed.
    std::optional<CardValue> printed_thickness;
};

/// Names of the cards that come with the program.
std::vector<std::string> preset_names();

/// The text of such a card, as a card file of one's own may be started from. Throws InputError with the
/// nearest name.
std::string preset_text(const std::string& name);

/// Whether a card is named by the path of a file: it has a '/' or ends in ".toml".
bool is_card_path(std::string_view name_or_path);

/// A card by name, or from a file. Throws InputError.
MaterialCard load_card(const std::string& name_or_path);

/// A material for a certain pre-stretch, with the source of each of its values.
struct ResolvedCard {
    std::string name;
    Material material;
    std::map<std::string, std::string> sources;  ///< by bare field name
    std::vector<std::string> warnings;
};

/// The card's values at a pre-stretch: linear between calibrated pre-stretches, the nearest set's (with a
/// warning) outside. The geometric mean of the two pre-stretches counts.
ResolvedCard resolve_card(const MaterialCard& card, const std::array<double, 2>& prestretch);
ResolvedCard resolve_card(const std::string& name_or_path, const std::array<double, 2>& prestretch);

/// Throws InputError when a pre-stretch is not below sqrt(1 + 2 gamma) of its axis, where the fabric locks.
void check_prestretch(const Material& material, const std::array<double, 2>& prestretch, const Place& place);

/// One sentence per value whose source begins with "assumed", for reports: "fabric_thickness = 0.46 mm
/// (assumed: ...)".
std::vector<std::string> assumed_values(const Material& material,
                                        const std::map<std::string, std::string>& sources);

}  // namespace ruche
