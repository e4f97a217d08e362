#include "energy/oracle_model.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "energy/oracle.hpp"
#include "ruche/energy/rods.hpp"
#include "ruche/material/rod_section.hpp"

namespace ruche::test {
namespace {

/// The triangles on an edge with the local index of the edge in each, in order of appearance.
struct Sides {
    std::vector<std::pair<int, int>> of;
    int unknown = -1;
};
using Key = std::pair<int, int>;

class Oracle {
  public:
    Oracle(const ModelInput& input, const Eigen::VectorXd& x)
        : input_(input), x_(x), vertices_(input.mesh.vertex_count()) {
        if (input_.print.empty()) input_.print.resize(input_.mesh.triangles.size());
        const double phi = input.fabric_axis_deg * std::numbers::pi / 180.0;
        relax_ << std::cos(phi) / input.prestretch[0], std::sin(phi) / input.prestretch[0],
            -std::sin(phi) / input.prestretch[1], std::cos(phi) / input.prestretch[1];
        sums_ = {0.0, Eigen::VectorXd::Zero(x.size()), Eigen::MatrixXd::Zero(x.size(), x.size())};
        find_sides();
    }

    Sums run() {
        for (int t = 0; t < input_.mesh.triangle_count(); ++t) {
            if (bare(t)) {
                add_fabric(t);
            } else {
                add_laminate(t);
            }
            add_weight(t);
        }
        for (const Rod& rod : input_.rods) {
            for (std::size_t k = 0; k + 1 < rod.vertices.size(); ++k)
                ++rods_on_[std::minmax(rod.vertices[k], rod.vertices[k + 1])];
        }
        for (const Key& key : order_) {
            if (!rods_on_.contains(key)) add_hinge(sides_.at(key));
        }
        int unknown = 3 * vertices_;
        for (const Rod& rod : input_.rods) {
            add_rod(rod, unknown);
            unknown += static_cast<int>(rod.vertices.size()) - 1;
        }
        add_joints();
        for (const NodalForce& f : input_.forces) add_force(f.vertex, f.force);
        if (input_.table.present) add_table();
        return sums_;
    }

  private:
    bool bare(int t) const { return input_.print[t].front == 0.0 && input_.print[t].back == 0.0; }
    int vertex(int t, int i) const { return input_.mesh.triangles[t][i % 3]; }
    Vec2 layout(int t, int i) const { return input_.mesh.vertices[vertex(t, i)]; }
    Key key(int t, int i) const { return std::minmax(vertex(t, i + 1), vertex(t, i + 2)); }
    double area(int t) const {
        const Vec2 p = layout(t, 1) - layout(t, 0);
        const Vec2 q = layout(t, 2) - layout(t, 0);
        return 0.5 * (p.x() * q.y() - p.y() * q.x());
    }

    void find_sides() {
        for (int t = 0; t < input_.mesh.triangle_count(); ++t) {
            for (int i = 0; i < 3; ++i) {
                if (!sides_.contains(key(t, i))) order_.push_back(key(t, i));
                sides_[key(t, i)].of.emplace_back(t, i);
            }
        }
        int next = 3 * vertices_;
        for (const Key& k : order_) {
            Sides& s = sides_[k];
            const auto printed =
                std::count_if(s.of.begin(), s.of.end(), [&](const auto& side) { return !bare(side.first); });
            const bool own_law = input_.options.fabric_ply == FabricPlyLaw::same_law;
            const bool unknown = printed == 2 || (printed == 1 && own_law);
            if (unknown && input_.options.edge_normals == EdgeNormals::free) s.unknown = next++;
        }
    }

    /// Adds an element; `nodes` are vertices (or -1), `extra` further unknowns (or -1).
    template <int N, class Element>
    void add(const Element& element, const std::vector<int>& nodes, const std::vector<int>& extra = {}) {
        std::vector<int> at;
        for (const int v : nodes) {
            for (int c = 0; c < 3; ++c) at.push_back(v < 0 ? -1 : 3 * v + c);
        }
        at.insert(at.end(), extra.begin(), extra.end());
        std::vector<Jet<N>> local;
        for (int i = 0; i < N; ++i) local.push_back(Jet<N>::unknown(i, at[i] < 0 ? 0.0 : x_[at[i]]));
        const Jet<N> energy = element.template energy<Jet<N>>(local);
        sums_.value += energy.value;
        for (int i = 0; i < N; ++i) {
            if (at[i] < 0) continue;
            sums_.gradient[at[i]] += energy.gradient[i];
            for (int j = 0; j < N; ++j) {
                if (at[j] >= 0) sums_.hessian(at[i], at[j]) += energy.hessian(i, j);
            }
        }
    }

    std::array<Vec2, 3> relaxed(int t) const {
        return {relax_ * layout(t, 0), relax_ * layout(t, 1), relax_ * layout(t, 2)};
    }
    FabricLaw::Options law_options() const {
        return {.log_extension = input_.options.log_extension,
                .tensor_shear = input_.options.shear_strain == ShearStrain::tensor};
    }

    void add_fabric(int t) {
        const FabricElement element{relaxed(t), input_.material, law_options()};
        add<9>(element, {vertex(t, 0), vertex(t, 1), vertex(t, 2)});
    }

    double hinge_stiffness(const Sides& s) const {
        const auto [t, i] = s.of[0];
        const double rest_area =
            (area(t) + area(s.of[1].first)) / (input_.prestretch[0] * input_.prestretch[1]);
        const double length2 = (relax_ * (layout(t, i + 2) - layout(t, i + 1))).squaredNorm();
        const double factor = input_.options.bending_normalisation == BendingNormalisation::plate ? 1.0 : 6.0;
        return factor * input_.material.fabric_bending_stiffness * length2 / rest_area;
    }

    /// Corners to the left and right of the way from a to b.
    std::array<int, 2> corners(int a, int b) {
        const Sides& s = sides_.at(std::minmax(a, b));
        const auto [t, i] = s.of[0];
        const std::array<int, 2> found = {vertex(t, i), vertex(s.of[1].first, s.of[1].second)};
        return vertex(t, i + 1) == a ? found : std::array<int, 2>{found[1], found[0]};
    }

    RodSection section(const Rod& rod) const {
        const Material& m = input_.material;
        return {rod.width, rod.thickness,
                rod.youngs_modulus > 0.0 ? rod.youngs_modulus : m.plastic_youngs_modulus,
                m.laminate_poissons_ratio};
    }
    Vec2 along(int a, int b) const { return input_.mesh.vertices[b] - input_.mesh.vertices[a]; }

    void add_rod(const Rod& rod, int unknown) {
        for (std::size_t k = 0; k + 1 < rod.vertices.size(); ++k) {
            const int a = rod.vertices[k];
            const int b = rod.vertices[k + 1];
            const auto [left, right] = corners(a, b);
            const double hinge =
                hinge_stiffness(sides_.at(std::minmax(a, b))) / rods_on_.at(std::minmax(a, b));
            const int y = unknown + static_cast<int>(k);
            const double length = along(a, b).norm();
            add<13>(RodEdgeElement{{{}, -1, length, stretching_stiffness(section(rod)), hinge}},
                    {a, b, left, right}, {y});
            const double mass = 1e-12 * input_.material.plastic_density * rod.width * rod.thickness * length;
            const Vec3 g(input_.gravity[0], input_.gravity[1], input_.gravity[2]);
            add_force(a, 0.5 * mass * g);
            add_force(b, 0.5 * mass * g);
            ends_.push_back({&rod, y, a, b, 1.0});
            ends_.push_back({&rod, y, b, a, -1.0});
        }
    }

    /// An edge of a rod as seen from one of its ends.
    struct End {
        const Rod* rod;
        int y, at, far;
        double sign;
    };

    void add_joints() {
        for (std::size_t i = 0; i < ends_.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                const bool met = ends_[i].at == ends_[j].at && ends_[i].far != ends_[j].far;
                if (met && ends_[i].rod->side == ends_[j].rod->side) add_joint(ends_[i], ends_[j]);
            }
        }
    }

    void add_joint(const End& in, const End& out) {
        const Vec2 d = along(in.far, in.at);
        const Vec2 e = along(out.at, out.far);
        const auto half = [&](const Rod& rod, const Vec2& step) -> Mat3 {
            const Vec3 turn = 0.5 * step.norm() * natural_curvature(input_, rod, step.normalized());
            return Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
        };
        const double turn = std::atan2(d.x() * e.y() - d.y() * e.x(), d.dot(e));
        const Mat3 rest =
            half(*in.rod, d) * Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix() * half(*out.rod, e);
        const Vec3 kappa = 2.0 / (1.0 + rest.trace()) *
                           Vec3(rest(2, 1) - rest(1, 2), rest(0, 2) - rest(2, 0), rest(1, 0) - rest(0, 1));
        const Vec3 stiffness =
            0.5 * (turning_stiffness(section(*in.rod)) + turning_stiffness(section(*out.rod)));
        const auto [left, right] = corners(in.far, in.at);
        const auto [left1, right1] = corners(out.at, out.far);
        add<23>(RodJointElement{{{}, {}, {}, {d.norm(), e.norm()}, {-in.sign, out.sign}, stiffness, kappa}},
                {in.far, in.at, out.far, left, right, left1, right1}, {in.y, out.y});
    }

    void add_hinge(const Sides& s) {
        if (s.of.size() < 2) return;
        const auto [t, i] = s.of[0];
        const auto [u, j] = s.of[1];
        if (!bare(t) && !bare(u)) return;
        const HingeElement element{hinge_stiffness(s)};
        add<12>(element, {vertex(t, i + 1), vertex(t, i + 2), vertex(t, i), vertex(u, j)});
    }

    void add_laminate(int t) {
        const Material& m = input_.material;
        const Print& print = input_.print[t];
        const double scale = input_.options.laminate_thickness == LaminateThickness::as_printed ? 0.5 : 1.0;
        const double fabric = scale * m.fabric_thickness;
        Mat2 edges;
        edges << layout(t, 1) - layout(t, 0), layout(t, 2) - layout(t, 0);
        const Mat2 metric = edges.transpose() * edges;
        const Mat2 fabric_metric = edges.transpose() * relax_.transpose() * relax_ * edges;
        const double front_modulus =
            print.front_modulus > 0.0 ? print.front_modulus : m.plastic_youngs_modulus;
        const double back_modulus = print.back_modulus > 0.0 ? print.back_modulus : m.plastic_youngs_modulus;
        // z = 0 at the interface; in mid-fabric when both sides are printed.
        double bottom = print.back > 0.0 ? 0.0 : -fabric;
        if (print.front > 0.0 && print.back > 0.0) bottom = -0.5 * fabric;
        LaminateElement element{{}, m.laminate_poissons_ratio, m, law_options()};
        element.element.plies = {
            {bottom, bottom + fabric, m.fabric_youngs_modulus, fabric_metric},
            {bottom + fabric, bottom + fabric + scale * print.front, front_modulus, metric},
            {bottom - scale * print.back, bottom, back_modulus, metric}};
        if (input_.options.fabric_ply == FabricPlyLaw::same_law) {
            element.element.plies.erase(element.element.plies.begin());
            element.element.fabric = {
                bottom, bottom + fabric, {layout(t, 0), layout(t, 1), layout(t, 2)}, relaxed(t)};
        }
        std::vector<int> nodes = {vertex(t, 0), vertex(t, 1), vertex(t, 2)};
        std::vector<int> unknowns;
        for (int i = 0; i < 3; ++i) {
            const Sides& s = sides_[key(t, i)];
            LaminateTerm::EdgeSide& side = element.element.sides[i];
            nodes.push_back(-1);
            unknowns.push_back(s.unknown);
            side.kind = rim_kind();
            if (s.of.size() < 2) continue;
            const bool first = s.of[0].first == t;
            const auto [u, j] = s.of[first ? 1 : 0];
            if (bare(u) && input_.options.edge_normals == EdgeNormals::free) continue;
            nodes.back() = vertex(u, j);
            const double length = (layout(t, i + 2) - layout(t, i + 1)).norm();
            side = {.kind = LaminateTerm::EdgeSide::Kind::hinged,
                    .flap = nodes.back(),
                    .unknown = s.unknown,
                    .sign = first ? 1.0 : -1.0,
                    .mean_altitude = (area(t) + area(u)) / length};
        }
        nodes.resize(6, -1);
        add<21>(element, nodes, unknowns);
    }

    LaminateTerm::EdgeSide::Kind rim_kind() const {
        using Kind = LaminateTerm::EdgeSide::Kind;
        if (input_.options.edge_normals != EdgeNormals::free) return Kind::clamped_rim;
        return input_.options.fabric_ply == FabricPlyLaw::same_law ? Kind::open_rim : Kind::free_rim;
    }

    void add_force(int v, const Vec3& force) {
        sums_.value -= force.dot(x_.segment<3>(3 * v));
        sums_.gradient.segment<3>(3 * v) -= force;
    }

    void add_weight(int t) {
        const Material& m = input_.material;
        const Print& print = input_.print[t];
        const double relaxed_area = area(t) / (input_.prestretch[0] * input_.prestretch[1]);
        const double mass = 1e-9 * m.fabric_areal_density * relaxed_area +
                            1e-12 * m.plastic_density * (print.front + print.back) * area(t);
        const Vec3 g(input_.gravity[0], input_.gravity[1], input_.gravity[2]);
        for (int i = 0; i < 3; ++i) add_force(vertex(t, i), mass / 3.0 * g);
    }

    void add_table() {
        const Vec3 g(input_.gravity[0], input_.gravity[1], input_.gravity[2]);
        const Vec3 up = -g / g.norm();
        std::vector<double> share(vertices_, 0.0);
        for (int t = 0; t < input_.mesh.triangle_count(); ++t) {
            for (int i = 0; i < 3; ++i) share[vertex(t, i)] += area(t) / 3.0;
        }
        for (int v = 0; v < vertices_; ++v) {
            const double depth = input_.table.height - up.dot(x_.segment<3>(3 * v));
            if (depth <= 0.0) continue;
            const double k = input_.table.stiffness_per_area * share[v];
            sums_.value += 0.5 * k * depth * depth;
            sums_.gradient.segment<3>(3 * v) -= k * depth * up;
            sums_.hessian.block<3, 3>(3 * v, 3 * v) += k * up * up.transpose();
        }
    }

    ModelInput input_;
    const Eigen::VectorXd& x_;
    int vertices_;
    Mat2 relax_;
    std::map<Key, Sides> sides_;
    std::vector<Key> order_;
    std::map<Key, int> rods_on_;
    std::vector<End> ends_;
    Sums sums_;
};

}  // namespace

Sums oracle_sums(const ModelInput& input, const Eigen::VectorXd& x) { return Oracle(input, x).run(); }

}  // namespace ruche::test
