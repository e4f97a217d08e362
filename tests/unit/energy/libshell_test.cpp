#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "energy/battery.hpp"
#include "energy/oracle.hpp"
#include "reference_data.hpp"
#include "ruche/material/laminate.hpp"

/// The laminate against libshell, code that others wrote, on its meshes and states (tests/data/vectors). Its
/// normals at the edges are averages weighted with the current areas, an operator that the product does not
/// have: it is written here on a differentiating scalar, with the product's laminate_form as energy.
using namespace ruche;
using namespace ruche::test;

namespace {

/// The layers of a bilayer as libshell has them (eq. 8 as printed: half of the given thicknesses).
struct Bilayer {
    const ReferenceMesh& reference;
    bool plastic_up = true;

    std::vector<Ply> plies(const Mat2& layout_metric) const {
        const double fabric = 0.5 * reference.fabric_thickness;
        const double plastic = 0.5 * reference.plastic_thickness;
        const Mat2 relaxed = layout_metric / (reference.prestretch * reference.prestretch);
        if (plastic_up) {
            return {{0.0, plastic, reference.plastic_modulus, layout_metric},
                    {-fabric, 0.0, reference.fabric_modulus, relaxed}};
        }
        return {{0.0, fabric, reference.fabric_modulus, relaxed},
                {-plastic, 0.0, reference.plastic_modulus, layout_metric}};
    }
};

Mat2 layout_metric(const TriangleMesh& mesh, int face) {
    const Triangle& t = mesh.triangles[face];
    Mat2 edges;
    edges << mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]];
    return edges.transpose() * edges;
}

/// Second fundamental form of a triangle (corners 0-2, flaps 3-5) with edge normals averaged by area; with
/// the product's sign, n . d2r.
template <class S>
Form<S> area_weighted_form(const std::array<Point<S>, 6>& v, const std::array<bool, 3>& has_flap) {
    const Point<S> face = cross(v[1] - v[0], v[2] - v[0]);
    std::array<S, 3> bend = {S(0.0), S(0.0), S(0.0)};
    for (int i = 0; i < 3; ++i) {
        if (!has_flap[i]) continue;
        const Point<S>& p = v[(i + 1) % 3];
        const Point<S>& q = v[(i + 2) % 3];
        const Point<S> normal = face + cross(p - q, v[3 + i] - q);
        bend[i] = dot((p - v[i]) + (q - v[i]), normal) / sqrt(dot(normal, normal));
    }
    return {-1.0 * (bend[0] + bend[1]), -1.0 * bend[0], -1.0 * (bend[0] + bend[2])};
}

enum class Part { all, stretching };

/// The product's energy of a face at forms (a, b).
Jet<18> face_energy(const LaminateForm& form, const Form<Jet<18>>& a, const Form<Jet<18>>& b,
                    const Mat2& metric) {
    const std::array<Jet<18>, 6> d = {
        a.m11 - metric(0, 0), a.m12 - metric(0, 1), a.m22 - metric(1, 1), b.m11, b.m12, b.m22};
    Jet<18> energy(form.constant);
    for (int i = 0; i < 6; ++i) {
        energy = energy + form.linear[i] * d[i];
        for (int j = 0; j < 6; ++j) energy = energy + 0.5 * form.quadratic(i, j) * (d[i] * d[j]);
    }
    return 0.5 * energy;  // half of the parametric unit square
}

Sums total(const Bilayer& bilayer, const std::vector<int>& faces, Part part) {
    const ReferenceMesh& reference = bilayer.reference;
    const TriangleMesh& mesh = reference.mesh;
    const MeshEdges edges = find_edges(mesh);
    const Eigen::Index size = reference.x.size();
    Sums sums{0.0, Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size)};
    for (const int f : faces) {
        std::array<int, 6> node{};
        std::array<bool, 3> has_flap{};
        for (int i = 0; i < 3; ++i) {
            node[i] = mesh.triangles[f][i];
            const Edge& edge = edges.edges[edges.of_triangle[f][i]];
            const int other = edge.triangle[0] == f ? 1 : 0;
            has_flap[i] = !edge.on_boundary();
            node[3 + i] = has_flap[i] ? mesh.triangles[edge.triangle[other]][edge.local[other]] : -1;
        }
        std::array<Point<Jet<18>>, 6> v;
        for (int k = 0; k < 6; ++k) {
            for (int c = 0; c < 3; ++c) {
                v[k][c] = Jet<18>::unknown(3 * k + c, node[k] < 0 ? 0.0 : reference.x[3 * node[k] + c]);
            }
        }
        const Point<Jet<18>> e1 = v[1] - v[0];
        const Point<Jet<18>> e2 = v[2] - v[0];
        const Form<Jet<18>> b = part == Part::all ? area_weighted_form(v, has_flap) : Form<Jet<18>>{};
        const Mat2 metric = layout_metric(mesh, f);
        const LaminateForm form =
            laminate_form(bilayer.plies(metric), reference.laminate_poissons_ratio, metric);
        const Jet<18> energy = face_energy(form, {dot(e1, e1), dot(e1, e2), dot(e2, e2)}, b, metric);
        sums.value += energy.value;
        for (int k = 0; k < 6; ++k) {
            if (node[k] < 0) continue;
            sums.gradient.segment<3>(3 * node[k]) += energy.gradient.segment<3>(3 * k);
            for (int l = 0; l < 6; ++l) {
                if (node[l] < 0) continue;
                sums.hessian.block<3, 3>(3 * node[k], 3 * node[l]) +=
                    energy.hessian.block<3, 3>(3 * k, 3 * l);
            }
        }
    }
    return sums;
}

std::vector<int> all_faces(const ReferenceMesh& reference) {
    std::vector<int> faces(reference.mesh.triangles.size());
    for (int f = 0; f < int(faces.size()); ++f) faces[f] = f;
    return faces;
}

/// The agreement that the data's README asks for.
void check_reference(const Sums& sums, const ReferenceMesh& reference, const ReferenceValues& expected) {
    CHECK(std::abs(sums.value / expected.energy - 1.0) <= 1e-12);
    CHECK((sums.gradient - expected.gradient).cwiseAbs().maxCoeff() <=
          1e-10 * expected.gradient.cwiseAbs().maxCoeff());
    CHECK((sums.hessian * reference.w - expected.hessian_times_w).cwiseAbs().maxCoeff() <=
          1e-9 * expected.hessian_times_w.cwiseAbs().maxCoeff());
}

}  // namespace

TEST_CASE("libshell: the laminate's energy density agrees on its first and second fundamental forms") {
    for (const char* name : {"mesh1", "mesh2"}) {
        CAPTURE(name);
        const ReferenceMesh reference = read_reference_mesh(name);
        for (const bool up : {true, false}) {
            double energy = 0.0;
            double stretching = 0.0;
            for (const int f : all_faces(reference)) {
                const auto matrix = [](const Vec3& form) -> Mat2 {
                    return (Mat2() << form[0], form[1], form[1], form[2]).finished();
                };
                const Mat2 a = matrix(reference.a[f]);
                const Mat2 b = -matrix(reference.libshell_b[f]);
                const auto plies = Bilayer{reference, up}.plies(layout_metric(reference.mesh, f));
                const double nu = reference.laminate_poissons_ratio;
                energy += 0.5 * laminate_energy_density(a, b, plies, nu);
                stretching += 0.5 * laminate_energy_density(a, Mat2::Zero(), plies, nu);
            }
            const std::string entry =
                std::string("libshell_bilayer_all_faces_plastic_") + (up ? "up" : "down");
            CHECK(std::abs(energy / reference.values(entry).energy - 1.0) <= 1e-12);
            if (!up) continue;
            const double only = reference.values(entry + "__stretching_only").energy;
            CHECK(std::abs(stretching / only - 1.0) <= 1e-12);
            const double rest = reference.values(entry + "__bending_and_cross_only").energy;
            CHECK(std::abs((energy - stretching) - rest) <= 1e-12 * energy);
        }
    }
}

TEST_CASE("libshell: full energy, gradient and Hessian agree with area-weighted edge normals") {
    for (const char* name : {"mesh1", "mesh2"}) {
        CAPTURE(name);
        const ReferenceMesh reference = read_reference_mesh(name);
        const std::vector<int> faces = all_faces(reference);
        const Sums up = total({reference, true}, faces, Part::all);
        check_reference(up, reference, reference.values("libshell_bilayer_all_faces_plastic_up"));
        check_reference(total({reference, false}, faces, Part::all), reference,
                        reference.values("libshell_bilayer_all_faces_plastic_down"));
        const Sums flat = total({reference, true}, faces, Part::stretching);
        check_reference(flat, reference,
                        reference.values("libshell_bilayer_all_faces_plastic_up__stretching_only"));
        const ReferenceValues rest =
            reference.values("libshell_bilayer_all_faces_plastic_up__bending_and_cross_only");
        CHECK(std::abs(up.value - flat.value - rest.energy) <= 1e-12 * up.value);
        CHECK((up.gradient - flat.gradient - rest.gradient).norm() <= 1e-10 * up.gradient.norm());
    }
}

TEST_CASE("libshell: printed faces alone, with their neighbours from the whole mesh, agree") {
    for (const char* name : {"mesh1", "mesh2"}) {
        CAPTURE(name);
        const ReferenceMesh reference = read_reference_mesh(name);
        check_reference(total({reference, true}, reference.plastic_faces, Part::all), reference,
                        reference.values("libshell_bilayer_plastic_faces_only_flaps_from_full_mesh"));
    }
}
