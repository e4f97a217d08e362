#pragma once

#include <string>

#include "ruche/output/surface_fields.hpp"
#include "ruche/scene/result.hpp"

namespace ruche {

/// Whether the program was built with the page in it.
bool can_write_page();

/// The whole of report.html: one file that opens from disk and asks the network for nothing. It holds the
/// report, the drawing and the shape with their fields (positions and stretches in 16 bits of their range,
/// curvature and energy density in half precision), and the film of the release where there is one. Throws
/// std::runtime_error when a position is not finite, std::logic_error without `can_write_page`. With the
/// fields' distance to a scan it shows that first, and with what else is known of it: `comparison`, JSON.
std::string html_report(const Result& result, const SurfaceFields& fields,
                        const std::string& comparison = {});

}  // namespace ruche
