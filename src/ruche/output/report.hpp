#pragma once

#include <string>

#include "ruche/scene/result.hpp"

namespace ruche {

/// The whole of report.json: state, energies, health, strips, every resolved parameter with unit and source,
/// assumptions, warnings, timings. Numbers that are not finite become null; text that is not UTF-8 is
/// mended. Units are part of the keys.
std::string report_json(const Result& result);

/// Where the shape with this number lies in the folder of a result whose alternatives were looked for.
std::string alternative_folder(int number);

}  // namespace ruche
