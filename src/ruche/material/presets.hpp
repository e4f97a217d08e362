#pragma once

#include <span>
#include <string_view>

namespace ruche {

/// A material card that comes with the program: a card file's text.
struct Preset {
    std::string_view name;
    std::string_view text;
};

std::span<const Preset> presets();

}  // namespace ruche
