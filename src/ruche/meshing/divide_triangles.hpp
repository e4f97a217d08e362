#pragma once

#include "ruche/meshing/triangulate.hpp"

namespace ruche {

/// Every triangle in four like it, by the middles of its edges. Those of the original mesh keep their number,
/// as the middle one of the four.
Triangulation divided(Triangulation triangulation);

}  // namespace ruche
