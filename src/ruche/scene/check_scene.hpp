#pragma once

#include "ruche/scene/scene.hpp"

namespace ruche {

/// Throws InputError for values out of range and for sections that contradict each other; of a scene built
/// in code as well as of one from a file.
void check_scene(const Scene& scene);

/// Where the value was set; for one that was not, the scene's file and the key.
Place place_in(const Scene& scene, const std::string& key);

}  // namespace ruche
