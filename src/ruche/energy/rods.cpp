#include "ruche/energy/rods.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "ruche/core/error.hpp"
#include "ruche/energy/edge_roles.hpp"
#include "ruche/material/rod_section.hpp"

namespace ruche {
namespace {

RodSection section_of(const ModelInput& input, const Rod& rod) {
    const double own = rod.youngs_modulus;
    return {.width = rod.width,
            .thickness = rod.thickness,
            .youngs_modulus = own > 0.0 ? own : input.material.plastic_youngs_modulus,
            .poissons_ratio = input.material.laminate_poissons_ratio};
}

/// A way along an edge of a rod.
struct Step {
    int number;  // of the edge among those of all rods
    int mesh_edge;
    double sign;  // -1 against the rod's own way
    std::array<int, 2> vertices;
    std::array<int, 2> corners;  // left and right
    Vec2 along;                  // in the layout
    const Rod* rod;

    Step reversed() const {
        return {number, mesh_edge, -sign, {vertices[1], vertices[0]}, {corners[1], corners[0]}, -along, rod};
    }
};

Eigen::Quaterniond turned_by(const Vec3& rotation) {
    const double angle = rotation.norm();
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, angle > 0.0 ? Vec3(rotation / angle) : Vec3::UnitX()));
}

class RodBuilder {
  public:
    RodBuilder(const ModelInput& input, const MeshEdges& edges) : input_(input), edges_(edges) {
        result_.on_rod.assign(edges.edges.size(), 0);
        for (int e = 0; e < static_cast<int>(edges.edges.size()); ++e) {
            const auto& v = edges.edges[e].vertex;
            number_[std::minmax(v[0], v[1])] = e;
        }
    }

    RodElements build() && {
        for (std::size_t r = 0; r < input_.rods.size(); ++r) add_steps(r);
        for (const Step& step : steps_) add_edge(step);
        for (const Side side : {Side::front, Side::back}) add_joints(side);
        return std::move(result_);
    }

  private:
    [[noreturn]] static void fail(std::size_t rod, const std::string& problem, const std::string& advice) {
        throw InputError({.key = "rod " + std::to_string(rod)}, problem, advice);
    }

    void add_steps(std::size_t r) {
        const Rod& rod = input_.rods[r];
        const bool positive = rod.width > 0.0 && rod.thickness > 0.0 && rod.youngs_modulus >= 0.0 &&
                              std::isfinite(rod.width * rod.thickness * (1.0 + rod.youngs_modulus));
        if (!positive) fail(r, "has no section", "Width and thickness are positive, in mm.");
        if (rod.vertices.size() < 2) fail(r, "has no edge", "A rod has two vertices or more.");
        for (std::size_t k = 0; k + 1 < rod.vertices.size(); ++k) {
            const int a = rod.vertices[k];
            const int b = rod.vertices[k + 1];
            const std::string from_to = "from vertex " + std::to_string(a) + " to " + std::to_string(b);
            const auto found = number_.find(std::minmax(a, b));
            if (found == number_.end())
                fail(r, "goes " + from_to + ", which is no edge of the mesh",
                     "Neighbours in a rod are joined by an edge.");
            const Edge& edge = edges_.edges[found->second];
            if (edge.on_boundary())
                fail(r, "runs along the rim of the fabric, " + from_to,
                     "A rod has fabric on both of its sides.");
            const auto corner = [&](int side) {
                return input_.mesh.triangles[edge.triangle[side]][edge.local[side]];
            };
            const int left = edge.vertex[0] == a ? 0 : 1;
            steps_.push_back({static_cast<int>(steps_.size()),
                              found->second,
                              1.0,
                              {a, b},
                              {corner(left), corner(1 - left)},
                              input_.mesh.vertices[b] - input_.mesh.vertices[a],
                              &rod});
            ++rods_on_[found->second];
        }
    }

    void add_edge(const Step& step) {
        result_.on_rod[step.mesh_edge] = 1;
        result_.unknowns.push_back({step.vertices[0], step.vertices[1], step.corners[0], step.corners[1]});
        // Rods of both sides on one edge share the fabric there.
        const double hinge =
            hinge_stiffness(input_, edges_.edges[step.mesh_edge]) / rods_on_.at(step.mesh_edge);
        result_.edges.push_back({result_.unknowns.back(), node(step), step.along.norm(),
                                 stretching_stiffness(section_of(input_, *step.rod)), hinge});
    }

    /// Where edges of rods on one side meet the plastic is one piece: a joint between every two of them.
    void add_joints(Side side) {
        std::map<int, std::vector<Step>> from;  // by vertex, steps that begin there
        for (const Step& step : steps_) {
            if (step.rod->side != side) continue;
            from[step.vertices[0]].push_back(step);
            from[step.vertices[1]].push_back(step.reversed());
        }
        for (const auto& [vertex, steps] : from) {
            for (std::size_t i = 0; i < steps.size(); ++i) {
                for (std::size_t j = i + 1; j < steps.size(); ++j) {
                    if (steps[i].mesh_edge != steps[j].mesh_edge) add_joint(steps[i].reversed(), steps[j]);
                }
            }
        }
    }

    void add_joint(const Step& in, const Step& out) {
        const Vec2& a = in.along;
        const Vec2& b = out.along;
        const double turn = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
        // Without load: half of the first edge's natural curvature, the turn in the layout, half of the
        // second's.
        const auto half = [&](const Step& step) {
            return turned_by(0.5 * step.along.norm() *
                             natural_curvature(input_, *step.rod, step.along.normalized()));
        };
        const Eigen::Quaterniond rest = half(in) * turned_by(Vec3(0.0, 0.0, turn)) * half(out);
        const Vec3 stiffness = 0.5 * (turning_stiffness(section_of(input_, *in.rod)) +
                                      turning_stiffness(section_of(input_, *out.rod)));
        result_.joints.push_back({{in.vertices[0], in.vertices[1], out.vertices[1]},
                                  {in.corners, out.corners},
                                  {node(in), node(out)},
                                  {a.norm(), b.norm()},
                                  {in.sign, out.sign},
                                  stiffness,
                                  Vec3(2.0 / rest.w() * rest.vec())});
    }

    int node(const Step& step) const { return input_.mesh.vertex_count() + step.number; }

    const ModelInput& input_;
    const MeshEdges& edges_;
    std::map<std::pair<int, int>, int> number_;  // of an edge, by its vertices
    std::map<int, int> rods_on_;                 // by edge of the mesh
    std::vector<Step> steps_;
    RodElements result_;
};

}  // namespace

Vec3 natural_curvature(const ModelInput& input, const Rod& rod, const Vec2& direction) {
    Mat2 basis;
    basis << direction.x(), -direction.y(), direction.y(), direction.x();
    const Mat2 relaxed = relaxation(input) * basis;
    const bool front = rod.side == Side::front;
    const Print print{.front = front ? rod.thickness : 0.0,
                      .back = front ? 0.0 : rod.thickness,
                      .front_modulus = rod.youngs_modulus,
                      .back_modulus = rod.youngs_modulus};
    const FormVector forms = free_forms(plies(input, print, Mat2::Identity(), relaxed.transpose() * relaxed),
                                        input.material.laminate_poissons_ratio, Mat2::Identity());
    const double a11 = forms[0];
    const double a12 = forms[1];
    const double area2 = a11 * forms[2] - a12 * a12;
    return {(forms[4] - a12 / a11 * forms[3]) / std::sqrt(area2), -forms[3] / a11, 0.0};
}

RodElements rod_elements(const ModelInput& input, const MeshEdges& edges) {
    const bool shell = input.options.strips == StripModel::shell;
    const bool printed = std::ranges::any_of(input.print, [](const Print& print) { return !print.bare(); });
    if (shell ? !input.rods.empty() : printed)
        throw InputError({.key = "model.strips"},
                         shell ? "is shell, and there are rods" : "is rods, and there are printed triangles",
                         "Strips are either printed triangles or rods.");
    if (input.rods.empty()) return {.edges = {}, .joints = {}, .unknowns = {}, .on_rod = {}};
    return RodBuilder(input, edges).build();
}

}  // namespace ruche
