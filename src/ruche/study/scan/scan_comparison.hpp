#pragma once

#include <string>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/meshing/raw_mesh.hpp"
#include "ruche/output/surface_fields.hpp"
#include "ruche/scene/result.hpp"
#include "ruche/study/scan/registration.hpp"

namespace ruche {

/// Which surface of the sheet a scanner has seen.
enum class Skin { automatic, front, back, both };

struct ScanOptions {
    std::string unit;  ///< of the file: "mm", "cm", "m", "inch"; empty: guessed from the sizes
    Skin skin = Skin::automatic;
    bool free_scale = false;  ///< let the scan grow or shrink to fit, and say by how much
    double kept = 0.9;        ///< share of the scan that is of the sheet at least
};

/// How a result and a scan of what was made differ.
struct ScanComparison {
    std::string unit;
    double unit_mm = 1.0;
    bool unit_guessed = false;
    Skin skin = Skin::both;     ///< that the distances are from; never automatic
    Registration registration;  ///< of the scan in mm
    int points = 0;
    double rms = 0.0;   ///< mm, of all points
    double mean = 0.0;  ///< mm, signed: positive where what was made lies outside
    /// Of the absolute distances, mm: percent and value.
    std::vector<std::pair<double, double>> percentiles;
    double covered = 0.0;  ///< share of the sheet's vertices with a point of the scan near them
    /// Per vertex of the result: mean signed distance, mm; not a number where the scan has nothing.
    std::vector<double> vertex_distance;
    std::vector<std::string> warnings;
};

/// Puts the scan on the released sheet and measures its distance from the sheet's skins, which lie a layer's
/// thickness off the reference surface. Throws InputError for a unit that is none and for a scan that is not
/// of this size in any unit.
ScanComparison compare_with_scan(const Result& result, const SurfaceFields& fields, const RawMesh& scan,
                                 const ScanOptions& options, const Control& control = {});

std::string_view name_of(Skin skin);

/// All of it but the map, as JSON.
std::string to_json(const ScanComparison& comparison, const std::string& scan);

}  // namespace ruche
