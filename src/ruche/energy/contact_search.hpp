#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "ruche/energy/contact.hpp"
#include "ruche/geometry/triangle_mesh.hpp"

namespace ruche {

/// Finds which parts of a sheet may touch, and how far it can move before they do.
///
/// Every vertex is paired with every triangle, every edge with every edge, as far as they share no vertex.
/// - Two parts repel each other from min(distance, l / (4 s)) on, l their distance in the layout and s the
///   larger pre-stretch: parts that are near each other in the sheet begin when they are a quarter as far
///   apart as they are in relaxed fabric, so that a sheet that touches itself nowhere has no contact energy
///   at all.
/// - Where a vertex is near several triangles, inclusion and exclusion counts each point of the surface once:
///   triangles minus inner edges plus inner vertices (Li, Ferguson, Schneider, Langlois, Zorin, Panozzo,
///   Jiang, Kaufman, Convergent Incremental Potential Contact, 2023). With half the vertex's layout area as
///   weight the energy is that of a pressure between two surfaces, whatever their meshes.
/// - Edges are a guard for where borders cross with no vertex near: they begin at half that distance.
class ContactSearch {
  public:
    /// `distance` in mm, the longest reach of a pair; `stretch`: s.
    ContactSearch(const TriangleMesh& mesh, const MeshEdges& edges, double distance, double stretch);
    ~ContactSearch();

    /// All pairs closer than `margin` times their reach, in an order that depends on nothing but the mesh.
    std::vector<ContactPair> pairs(const Eigen::VectorXd& x, double margin) const;

    /// The fraction of the straight way from `x` to `y` on which no two parts come closer than a fifth of
    /// their present distance or of their reach, whichever is less.
    double clear_fraction(const Eigen::VectorXd& x, const Eigen::VectorXd& y) const;

  private:
    struct Parts;
    std::unique_ptr<const Parts> parts_;
};

}  // namespace ruche
