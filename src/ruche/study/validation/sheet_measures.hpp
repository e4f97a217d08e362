#pragma once

#include <span>

#include "ruche/meshing/print_mesh.hpp"

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

/// Curvature of the circle through all printed vertices as one looks along a direction of the layout, y by
/// default, where the released sheet's mean direction is meant: the silhouette of a roll seen from its front.
/// Not negative; NaN when there is no circle.
double silhouette_curvature(const PrintMesh& layout, std::span<const Vec3> shape,
                            const Vec2& along = Vec2::UnitY());

/// The strips whose id begins with `begin` and whose centre line lies inside the middle `share` of the box
/// around all centre lines; indices into layout.strips.
std::vector<int> chosen_strips(const PrintMesh& layout, const std::string& begin, double share);

/// The layout with only the middle share of each centre line left, to be measured.
PrintMesh with_middles(PrintMesh layout, double share);

}  // namespace ruche
