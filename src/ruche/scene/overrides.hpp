#pragma once

#include <string>
#include <vector>

#include "ruche/core/document.hpp"

namespace ruche {

/// A value given beside the scene file, on the command line or by a study.
struct Override {
    std::string path;    ///< "fabric.prestretch", "plastic.rule.1.side" (lists count from 1)
    std::string value;   ///< as TOML would have it; text may go without quotes
    std::string option;  ///< how the user gave it, for messages: "--set fabric.prestretch=1.6"
};

/// "path=value" as given to an option. Throws InputError when there is no path or no '='.
Override parse_override(const std::string& text, const std::string& option = "--set");

/// Puts the values into the tree, so that they are checked like those of the file. Throws InputError for a
/// path that leads through something that is not a table or a list.
void apply_overrides(Node& root, const std::vector<Override>& overrides);

}  // namespace ruche
