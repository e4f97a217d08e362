#pragma once

#include <span>

#include "ruche/geometry/helix_fit.hpp"
#include "ruche/meshing/print_mesh.hpp"
#include "ruche/output/curvature.hpp"

namespace ruche {

/// A ring of the layout, mm.
struct LayoutRing {
    Vec2 middle = Vec2::Zero();
    double inner = 0.0;
    double outer = 1e5;

    bool holds(const Vec2& p) const {
        const double r = (p - middle).norm();
        return r >= inner && r <= outer;
    }
};

/// Released over printed length around the ring's middle, mean over the area of its triangles. NaN without
/// any.
double transverse_stretch(const PrintMesh& layout, std::span<const Vec3> shape, const LayoutRing& ring);

/// Curvature of a part of the sheet as a whole, ripples included: integrals over its released area.
struct IntegratedCurvature {
    double gauss = 0.0;  ///< 1/mm^2: angle defects of the vertices inside the ring
    double mean = 0.0;   ///< 1/mm: |e| theta / 2 over the edges inside; positive where the back is concave
};

/// Vertices and edges on the sheet's border have none. For a fine mesh these are the integrals over the
/// smooth surface (Cohen-Steiner and Morvan 2003). NaN where the ring holds no triangles.
IntegratedCurvature integrated_curvature(const PrintMesh& layout, std::span<const Vec3> shape,
                                         const LayoutRing& ring);

/// Principal curvatures and their mean from quadrics fitted at the vertices (output/curvature), weighted with
/// their layout area; 1/mm, positive where the back is concave. Unlike the integrals it does not count what
/// the ring's border cuts, and it smooths ripples that are as short as elements. NaN where the ring holds no
/// vertices.
VertexCurvature fitted_curvature(const PrintMesh& layout, std::span<const Vec3> shape,
                                 const LayoutRing& ring);

/// Where the layout's point is in the released shape. NaN where the layout has no such point.
Vec3 position_of(const PrintMesh& layout, std::span<const Vec3> shape, const Vec2& point);

/// The helix through the released centre line of a strip, its first one. Not valid without one.
HelixFit strip_helix(const PrintMesh& layout, std::span<const Vec3> shape, int strip);

/// Curvature of the circle through the printed vertices as one looks along a direction of the layout, y by
/// default, that of the released sheet in the mean: the silhouette of a roll seen from its front. Only of
/// what lies inside the middle `share` of the box around the print; 1 counts all. Of the surface where
/// plastic and fabric meet, as everything here: the outside of the plastic has a larger radius. Not negative;
/// NaN when there is no circle.
double silhouette_curvature(const PrintMesh& layout, std::span<const Vec3> shape, double share = 1.0,
                            const Vec2& along = Vec2::UnitY());

/// The strips whose id begins with `begin` and whose centre line lies inside the middle `share` of the box
/// around all centre lines; indices into layout.strips.
std::vector<int> chosen_strips(const PrintMesh& layout, const std::string& begin, double share);

/// The layout with only the middle share of each centre line left, to be measured.
PrintMesh with_middles(PrintMesh layout, double share);

}  // namespace ruche
