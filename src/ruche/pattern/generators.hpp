#pragma once

#include <string>

#include "ruche/core/fields.hpp"
#include "ruche/pattern/generated_pattern.hpp"

/// The built-in patterns. Each is an options struct, its `fields` table and a function; all lengths in mm.
/// Every function throws InputError when the options contradict each other. To add one: the struct, the
/// table, the function, and a line in generator_registry.cpp.
namespace ruche {

enum class StripCap { butt, round };

/// One straight strip along x, centred on the origin.
struct SingleStripOptions {
    double length = 30.0;
    double width = 1.0;
    StripCap cap = StripCap::butt;
};
GeneratedPattern generate_strip(const SingleStripOptions& options);

/// Parallel strips along x in rows; every other row is shifted by half a period (length + axial gap). Rolls
/// into a cylinder (Jourdan et al. 2022).
struct StaggeredStripsOptions {
    double width = 1.0;
    double length = 12.0;
    double axial_gap = 2.0;  ///< between the ends of neighbours in a row
    double pitch = 2.5;      ///< between the centre lines of neighbouring rows
    int rows = 13;
    int strips_per_row = 4;
    bool half_strips = true;  ///< fill up the shifted rows at both ends, so that the patch is a rectangle
    bool alternate_sides = false;
    StripCap cap = StripCap::butt;
};
GeneratedPattern generate_staggered(const StaggeredStripsOptions& options);

/// Radial strips on an annulus of fabric, further ones inserted outward, as far as possible from those that
/// are there. Many strips outside make a half torus; a constant count makes a bell.
struct RadialStripsOptions {
    double inner = 12.0;
    double outer = 34.0;
    double width = 1.0;
    std::string rings = "12:20, 16.5:20, 22:40";  ///< "radius where strips begin : how many", ...
};
GeneratedPattern generate_radial(const RadialStripsOptions& options);

/// 3-pointed stars on the vertices of a hexagonal tiling, arms along its edges, on a disc of fabric (Jourdan
/// et al. 2020); those that fit on the disc.
struct StarTilingOptions {
    double edge = 6.4;  ///< of the tiling = distance between neighbouring stars
    double arm = 2.9;
    double width = 1.2;
    double radius = 19.0;  ///< of the disc of fabric
    double rim = 0.5;      ///< bare fabric between the print and the disc's edge, at least
};
GeneratedPattern generate_stars(const StarTilingOptions& options);

enum class HexagonStyle { outlined, filled };

/// A tiling of hexagons with gaps on a disc of fabric; those that fit on the disc.
struct HexagonTilingOptions {
    double edge = 5.0;  ///< of the tiling, before the gap is taken off
    double gap = 1.5;   ///< between the plastic of neighbouring hexagons
    HexagonStyle style = HexagonStyle::outlined;
    double width = 1.0;  ///< of the outline
    double radius = 30.0;
    double rim = 0.5;
};
GeneratedPattern generate_hexagons(const HexagonTilingOptions& options);

/// A network of curves given as polylines in a text file: one point "x, y" in mm per line, an empty line
/// between curves; or three columns "curve, x, y". '#' starts a comment; a header line is skipped. A curve
/// whose last point is its first is closed.
struct CurveNetworkOptions {
    std::string file;
    double width = 1.0;
    StripCap cap = StripCap::round;
};
GeneratedPattern generate_curves(const CurveNetworkOptions& options);

enum class DirectionField { parallel, radial, circular, hyperbolic, file };

/// Locally parallel strips that follow a direction field over a disc or an annulus of fabric, at a distance
/// from each other that varies with the radius, or both as a file gives them (patterns as in Jourdan et al.
/// 2022; the fields are given, nothing is designed). Lines are traced by evenly spaced streamlines (Jobard
/// and Lefer 1997): new ones begin beside those that are there wherever there is room, and end where they
/// come too close to another; then they are cut into strips.
struct TracedStripsOptions {
    DirectionField field = DirectionField::radial;
    std::string file;   ///< of DirectionField::file: see DirectionGrid
    double turn = 0.0;  ///< degrees, from the field's direction to the strips'; radial and 45: spirals
    double inner = 4.0;
    double outer = 20.0;
    double rim = 0.5;            ///< bare fabric between the print and both borders
    double spacing = 2.5;        ///< between centre lines of neighbours, at the inner radius; not with a file
    double outer_spacing = 2.5;  ///< at the outer radius; linear in between
    double width = 1.0;
    double length = 12.0;      ///< of each strip; 0 = lines are not cut
    double gap = 2.0;          ///< between strips of one line
    double back_inside = 0.0;  ///< strips whose middle lies nearer to the middle are printed on the back
};
GeneratedPattern generate_traced(const TracedStripsOptions& options);

template <>
std::span<const Field<TracedStripsOptions>> fields<TracedStripsOptions>();
template <>
std::span<const Field<SingleStripOptions>> fields<SingleStripOptions>();
template <>
std::span<const Field<StaggeredStripsOptions>> fields<StaggeredStripsOptions>();
template <>
std::span<const Field<RadialStripsOptions>> fields<RadialStripsOptions>();
template <>
std::span<const Field<StarTilingOptions>> fields<StarTilingOptions>();
template <>
std::span<const Field<HexagonTilingOptions>> fields<HexagonTilingOptions>();
template <>
std::span<const Field<CurveNetworkOptions>> fields<CurveNetworkOptions>();

}  // namespace ruche
