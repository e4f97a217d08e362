#pragma once

#include <vector>

#include "ruche/geometry/surface_search.hpp"
#include "ruche/output/surface_fields.hpp"
#include "ruche/scene/result.hpp"

namespace ruche {

/// The front or the back of the released sheet: the reference surface, each triangle moved along the
/// vertices' normals by the thickness of what lies there. In the order of the layout's triangles. The fabric
/// counts with its relaxed thickness; bare fabric continues the fabric under the print where all print is on
/// one side, and lies on both sides of the reference surface else.
std::vector<Corners> front_skin(const Result& result, const SurfaceFields& fields);
std::vector<Corners> back_skin(const Result& result, const SurfaceFields& fields);

/// The upright sides of the print, where a skin steps from one triangle to the next: two triangles an edge.
/// What tells where along the sheet a scan lies is mostly these.
std::vector<Corners> sides_of_print(const Result& result, const std::vector<Corners>& skin);

}  // namespace ruche
