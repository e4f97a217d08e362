#pragma once

#include <string>

namespace ruche {

/// What a list of results shows of a report.json, as JSON: status, stable, triangles, seconds, box_size_mm,
/// energy_mJ, curvature_per_mm (lowest, median, highest of the strips) and the settings by "section.key" that
/// somebody gave. Empty when the file is none of ours.
std::string run_summary(const std::string& report);

}  // namespace ruche
