#pragma once

#include <Eigen/Core>
#include <vector>

#include "ruche/energy/term.hpp"

namespace ruche {

/// Mass of each vertex (a third of each of its triangles), tonnes; areas in mm^2 of layout.
struct AreaMass {
    std::array<int, 3> vertices;
    double mass;
};
Eigen::VectorXd lumped_mass(int vertex_count, const std::vector<AreaMass>& triangles);

/// A frictionless plane that the sheet may rest on: W = 1/2 k_v min(0, up . x_v - height)^2 per vertex.
class TableContact {
  public:
    static constexpr std::string_view name = "table";
    static constexpr int vertex_slots = 1;
    static constexpr int edge_slots = 0;

    struct Plane {
        Vec3 up = Vec3::UnitZ();
        double height = 0.0;  ///< mm
    };

    /// `stiffness` per vertex, N/mm; empty = no table.
    TableContact(const Plane& plane, std::vector<double> stiffness)
        : plane_(plane), stiffness_(std::move(stiffness)) {}

    int element_count() const { return static_cast<int>(stiffness_.size()); }
    std::array<int, 1> nodes(int element) const { return {element}; }
    Local<3> evaluate(int element, const Unknowns& x, Order order) const;

  private:
    Plane plane_;
    std::vector<double> stiffness_;
};

}  // namespace ruche
