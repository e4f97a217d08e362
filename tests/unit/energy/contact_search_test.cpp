#include "ruche/energy/contact_search.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "energy/battery.hpp"
#include "energy/samples.hpp"
#include "ruche/meshing/structured.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

constexpr double gap_distance = 0.5;

/// Two sheets of 5 x 4 mm with meshes of their own, far apart in the layout.
ModelInput two_sheets(int columns, int other_columns) {
    ModelInput input;
    for (const int n : {columns, other_columns}) {
        TriangleMesh sheet = random_grid(n, n, 0.2, static_cast<unsigned>(n));
        const int first = input.mesh.vertex_count();
        for (const Vec2& p : sheet.vertices)
            input.mesh.vertices.emplace_back(5.0 / n * p.x() + (first > 0 ? 50.0 : 0.0), 4.0 / n * p.y());
        for (const Triangle& t : sheet.triangles)
            input.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    input.options.contact = true;
    input.options.contact_distance = gap_distance;
    return input;
}

/// The second sheet laid over the first one, at a height.
Eigen::VectorXd stacked(const Model& model, double height) {
    Eigen::VectorXd x = model.initial();
    for (int v = 0; v < model.vertex_count(); ++v) {
        if (x[3 * v] > 40.0) x.segment<3>(3 * v) += Vec3(-50.0, 0.0, height);
    }
    return x;
}

ContactSearch search_of(const Model& model) {
    return {model.input().mesh, model.edges(), model.input().options.contact_distance,
            model.input().prestretch[0]};
}

double barrier(double u) { return -(u - 1.0) * (u - 1.0) * std::log(u); }
double barrier_slope(double u) { return -2.0 * (u - 1.0) * std::log(u) - (u - 1.0) * (u - 1.0) / u; }

/// k of the model, mJ/mm^2.
constexpr double search_stiffness = 0.01 * gap_distance;

/// A strip 30 mm long, printed here and there; as a spiral it is rolled twice around.
Model rolled_strip() {
    ModelInput input;
    input.mesh = rectangle_mesh(MeshKind::jittered, {.length = 30.0, .width = 1.5, .across = 2});
    for (int t = 0; t < input.mesh.triangle_count(); ++t)
        input.print.push_back({.front = t % 7 < 4 ? 0.4 : 0.0});
    input.options.contact = true;
    input.options.contact_distance = gap_distance;
    return Model(std::move(input));
}

Eigen::VectorXd spiral(const Model& model, double between_turns = 0.4) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-0.02, 0.02);
    Eigen::VectorXd x = model.initial();
    for (int v = 0; v < model.vertex_count(); ++v) {
        const double angle = 0.42 * x[3 * v];
        const double radius = 2.0 + between_turns * angle / 6.2832;
        x.segment<3>(3 * v) = Vec3(radius * std::cos(angle), x[3 * v + 1], radius * std::sin(angle));
    }
    for (double& c : x) c += uniform(random);
    return x;
}

}  // namespace

TEST_CASE("contact search: two flat sheets have the energy of a pressure, whatever their meshes") {
    for (const auto& [n, m] : {std::pair{3, 5}, std::pair{8, 9}, std::pair{14, 20}}) {
        CAPTURE(n);
        Model model(two_sheets(n, m));
        for (const double d : {0.26, 0.35, 0.45}) {
            CAPTURE(d);
            const Eigen::VectorXd x = stacked(model, d);
            model.set_contacts(search_of(model).pairs(x, 1.0));
            const double u = d * d / (gap_distance * gap_distance);
            CHECK(model.energy_terms(x).contact ==
                  doctest::Approx(search_stiffness * 20.0 * barrier(u)).epsilon(1e-9));
            // The force that presses them together.
            const Eigen::VectorXd with = model.gradient(x);
            model.set_contacts({});
            const Eigen::VectorXd contact = with - model.gradient(x);
            double upwards = 0.0;
            for (int v = 0; v < model.vertex_count(); ++v) {
                if (model.input().mesh.vertices[v].x() > 40.0) upwards -= contact[3 * v + 2];
            }
            const double slope = barrier_slope(u) * 2.0 * d / (gap_distance * gap_distance);
            CHECK(upwards == doctest::Approx(-search_stiffness * 20.0 * slope).epsilon(1e-8));
        }
    }
}

TEST_CASE("contact search: edges join in below half the distance, and only add") {
    Model model(two_sheets(8, 9));
    const double d = 0.2;
    const Eigen::VectorXd x = stacked(model, d);
    model.set_contacts(search_of(model).pairs(x, 1.0));
    const double u = d * d / (gap_distance * gap_distance);
    CHECK(model.energy_terms(x).contact > 1.001 * search_stiffness * 20.0 * barrier(u));
}

TEST_CASE("contact search: a flat sheet, stretched or relaxed, touches itself nowhere") {
    const Model model = rolled_strip();
    for (const double scale : {1.0, 1.0 / 1.7, 0.15}) {
        CHECK(search_of(model).pairs(scale * model.initial(), 1.0).empty());
    }
    CHECK_FALSE(search_of(model).pairs(0.145 * model.initial(), 1.0).empty());
}

TEST_CASE("contact search: it finds every pair that a search without a tree finds") {
    const Model model = rolled_strip();
    const Eigen::VectorXd x = spiral(model, 0.2);
    const Unknowns at{x.data(), model.vertex_count()};
    const Eigen::VectorXd flat = model.initial();
    const Unknowns layout{flat.data(), model.vertex_count()};
    const TriangleMesh& mesh = model.input().mesh;
    int faces = 0;
    int edges = 0;
    const auto near = [&](const ContactPair& pair, double longest) {
        const double reach = std::min(longest, distance(pair.kind, corners(pair, layout)) / (4.0 * 1.7));
        // Parts that share a vertex are at no distance in the layout, up to rounding.
        return reach > 1e-9 && distance(pair.kind, corners(pair, at)) < reach;
    };
    for (int v = 0; v < model.vertex_count(); ++v) {
        for (const Triangle& t : mesh.triangles)
            faces += near({PairKind::vertex_triangle, {v, t[0], t[1], t[2]}}, gap_distance) ? 1 : 0;
    }
    const std::vector<Edge>& all = model.edges().edges;
    for (std::size_t e = 0; e < all.size(); ++e) {
        for (std::size_t f = 0; f < e; ++f) {
            const auto& a = all[e].vertex;
            const auto& b = all[f].vertex;
            edges += near({PairKind::edge_edge, {a[0], a[1], b[0], b[1]}}, 0.5 * gap_distance) ? 1 : 0;
        }
    }
    int found_faces = 0;
    int found_edges = 0;
    for (const ContactPair& pair : search_of(model).pairs(x, 1.0)) {
        found_faces += pair.kind == PairKind::vertex_triangle ? 1 : 0;
        found_edges += pair.kind == PairKind::edge_edge ? 1 : 0;
    }
    CHECK(faces > 50);
    CHECK(edges > 50);
    CHECK(found_faces == faces);
    CHECK(found_edges == edges);
}

TEST_CASE("contact search: the same pairs at any number of threads") {
    const Model model = rolled_strip();
    const Eigen::VectorXd x = spiral(model);
    const int before = thread_count();
    set_thread_count(1);
    const std::vector<ContactPair> serial = search_of(model).pairs(x, 1.5);
    set_thread_count(5);
    CHECK(search_of(model).pairs(x, 1.5) == serial);
    set_thread_count(before);
}

TEST_CASE("contact search: a sheet with contacts passes the battery") {
    Model model = rolled_strip();
    const Eigen::VectorXd x = spiral(model);
    model.set_contacts(search_of(model).pairs(x, 1.0));
    const double contact = model.energy_terms(x).contact;
    CHECK(contact > 0.0);
    check_derivatives(energy_of(model), x, 2e-5);
    check_orders(energy_of(model), x);
    std::mt19937 random(8);
    check_invariance(energy_of(model), energy_of(model), random_motion(random), x);
    check_invariance(energy_of(model), energy_of(model), {}, x);
    // Pairs that are not within reach change the pattern and nothing else.
    const double energy = model.energy(x);
    model.set_contacts(search_of(model).pairs(x, 2.0));
    CHECK(model.energy(x) == doctest::Approx(energy).epsilon(1e-13));
    CHECK(model.energy_terms(x).contact == doctest::Approx(contact).epsilon(1e-13));
}

TEST_CASE("contact search: a fast step through a sheet is stopped above it") {
    const Model model(two_sheets(6, 7));
    const Eigen::VectorXd above = stacked(model, 0.4);
    const Eigen::VectorXd below = stacked(model, -1e4);
    const double t = search_of(model).clear_fraction(above, below);
    const double height = 0.4 - t * (1e4 + 0.4);
    // A fifth of the present distance, at most a quarter more.
    CHECK(height > 0.08);
    CHECK(height < 0.1001);
    CHECK(search_of(model).clear_fraction(above, stacked(model, 0.2)) == 1.0);
    CHECK(search_of(model).clear_fraction(above, stacked(model, 1e4)) == 1.0);
}
