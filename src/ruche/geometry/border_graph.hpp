#pragma once

#include <array>
#include <span>
#include <vector>

#include "ruche/geometry/polygon.hpp"

namespace ruche {

/// The borders of several regions as one straight-line graph: segments meet only at points, a border that
/// regions share is there once. A point of the plane lies in region r when a path to it from far away crosses
/// an odd number of segments that bound r.
struct BorderGraph {
    struct Segment {
        std::array<int, 2> point;
        std::vector<int> regions;  ///< whose border it is, ascending
    };
    std::vector<Vec2> points;  ///< on the 1 nm grid
    std::vector<Segment> segments;
};

/// Builds the graph; open lines may be part of it, the k-th with the number of regions + k among `regions` of
/// its segments (it bounds nothing). Points closer than `snap` (mm, at least two grid steps) become one, and
/// a segment that passes closer to a point than that is led through it; nothing else moves. A graph's own
/// regions give the same graph again. Throws InputError when the borders are so entangled that this does not
/// come to an end.
BorderGraph border_graph(std::span<const Region> regions, double snap, std::span<const Polyline> lines = {});

/// Leaves out points of chains between junctions as `simplify` does, within the smallest of `tolerance`
/// (mm, one per region) of the regions that the chain bounds, and snaps again. Returns for each region the
/// largest distance of a point left out from the border that remains.
std::vector<double> simplify_borders(BorderGraph& graph, std::span<const double> tolerance, double snap);

/// Region `r` as polygons on the graph's points.
Region region_of(const BorderGraph& graph, int r);

}  // namespace ruche
