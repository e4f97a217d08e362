#pragma once

#include <string_view>

namespace ruche {

/// The page without a result in it, as web/ is built into the program: HTML with the mark `page_data_mark`
/// where the data belongs. Empty where the program was built without npm.
std::string_view page_template();

/// The studio's page, bundled in the same way.
std::string_view studio_page();

inline constexpr std::string_view page_data_mark = "<!--DATA-->";

}  // namespace ruche
