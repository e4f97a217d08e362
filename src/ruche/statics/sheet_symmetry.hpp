#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "ruche/energy/model.hpp"

namespace ruche {

/// A way in which a sheet is its own image: the map p -> turn (p - centre) + centre of the layout, after
/// which outline, print and the fabric's axes are where they were, or where they were with front and back
/// exchanged. It takes every shape x of the sheet to another one of the same energy: the point p of the image
/// is Q x(map p), with a reflection Q of space if the map is a reflection or exchanges the sides, but not if
/// it does both.
struct SheetSymmetry {
    Mat2 turn = Mat2::Identity();
    Vec2 centre = Vec2::Zero();
    bool sides_exchanged = false;
    std::string name;  ///< "mirrored at the axis at 90 degrees", "turned by 180 degrees", ...

    bool reflects_space() const { return (turn.determinant() < 0.0) != sides_exchanged; }
};

/// All such maps but the identity among the turns by multiples of 90 degrees about the middle of the layout
/// and the reflections at axes that are multiples of 45 degrees from the fabric's first axis (where the sheet
/// is isotropic: from the layout's principal axis). None when gravity, supports or forces act. Decided at the
/// triangles' centroids, of which a thousandth (by area) may be wrong.
std::vector<SheetSymmetry> find_symmetries(const ModelInput& sheet);

/// The image of a shape, with the mesh and print that it belongs to: the same sheet, meshed otherwise.
struct ShapeImage {
    TriangleMesh layout;
    std::vector<Print> print;
    Eigen::VectorXd x;  ///< positions only
};
ShapeImage image(const SheetSymmetry& symmetry, const ModelInput& sheet, const Eigen::VectorXd& x);

}  // namespace ruche
