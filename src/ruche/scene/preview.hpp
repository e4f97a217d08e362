#pragma once

#include "ruche/scene/scene.hpp"

namespace ruche {

/// The scene as it is to be released for a first look: on about so many triangles, as far as the drawing's
/// details allow, without contact, and with a limit to its iterations (what does not come to rest by then is
/// shown as it is). A mesh file stays as it is.
Scene preview_scene(Scene scene, double triangles);

}  // namespace ruche
