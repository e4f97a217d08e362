#pragma once

#include <string>

#include "ruche/scene/result.hpp"

namespace ruche {

/// What a picture says in words.
struct Caption {
    std::string title;
    std::string details;  ///< pre-stretch, plastic, fabric
    std::string alarm;    ///< "NOT CONVERGED", "INTERRUPTED", "NOT STABLE", or empty
};

Caption make_caption(const Result& result, const std::string& title = {});

}  // namespace ruche
