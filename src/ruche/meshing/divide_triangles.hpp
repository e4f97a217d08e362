#pragma once

#include "ruche/meshing/triangulate.hpp"

namespace ruche {

/// Every triangle in four like it, by the middles of its edges.
Triangulation divided(Triangulation triangulation);

}  // namespace ruche
