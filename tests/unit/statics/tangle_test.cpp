#include "ruche/statics/tangle.hpp"

#include <doctest/doctest.h>

#include "energy/samples.hpp"
#include "ruche/core/control.hpp"
#include "ruche/statics/equilibrium.hpp"
#include "ruche/statics/untangle.hpp"

using namespace ruche;

namespace {

/// As crumpled as sheets on their default mesh have been seen.
Health crumpled() {
    return {.max_strain_margin = 1e-3,
            .min_area_ratio = 0.0005,
            .max_dihedral_deg = 110.0,
            .max_edge_rotation_deg = 45.0,
            .self_intersections = 3};
}

Equilibrium end(bool tangled, bool certain = true) {
    Equilibrium e;
    e.x = Eigen::VectorXd::Zero(3);
    e.status = certain ? SolveStatus::converged : SolveStatus::not_converged;
    e.stable = certain;
    e.health = crumpled();
    if (tangled) e.health.max_dihedral_deg = 175.0;
    e.health.tangled = tangled;
    e.message = certain ? "strict local minimum" : "lost";
    return e;
}

/// Runs that end as listed, one after the other; notes from where each began.
struct Script {
    std::vector<Equilibrium> ends;
    Eigen::VectorXd last_good;
    std::vector<double> began_at = {};
    bool wary = false;

    Equilibrium play(bool rough = false) {
        const Reruns reruns{.run =
                                [&](const Eigen::VectorXd& x) {
                                    CHECK(wary == !began_at.empty());  // all but the first
                                    began_at.push_back(x[0]);
                                    return ends.at(began_at.size() - 1);
                                },
                            .last_good = [&] { return last_good; },
                            .be_wary = [&] { wary = true; },
                            .flat = [] { return Eigen::VectorXd(Eigen::VectorXd::Constant(3, 7.0)); },
                            .rough = rough};
        return solve_around_tangles(Eigen::VectorXd::Constant(3, 1.0), reruns, {});
    }
};

const Eigen::VectorXd good = Eigen::VectorXd::Constant(3, 4.0);

}  // namespace

TEST_CASE("tangle: a crumpled sheet is none, each limit on its own is one") {
    CHECK(tangle(crumpled()).empty());
    CHECK(tangle({}).empty());
    Health h = crumpled();
    h.max_strain_margin = 0.06;
    CHECK(tangle(h).find("beyond the limit") != std::string::npos);
    h = crumpled();
    h.min_area_ratio = 5e-5;
    CHECK(tangle(h).find("crushed to 0.005 %") != std::string::npos);
    h = crumpled();
    h.max_dihedral_deg = 171.0;
    CHECK(tangle(h).find("171") != std::string::npos);
    h = crumpled();
    h.max_edge_rotation_deg = 90.0;
    CHECK(tangle(h).find("edge") != std::string::npos);
}

TEST_CASE(
    "tangle: bare fabric that is stretched less than its law allows has a negative margin and is none") {
    Health h = crumpled();
    h.max_strain_margin = -infinity;  // no bare fabric at all
    CHECK(tangle(h).empty());
}

TEST_CASE("retry: an end without a tangle is the result, whatever else it is") {
    Script script{.ends = {end(false)}, .last_good = good};
    CHECK(script.play().message == "strict local minimum");
    script = {.ends = {end(false, false)}, .last_good = good};
    CHECK(script.play().message == "lost");
}

TEST_CASE("retry: a tangled minimum is solved again from the last good state, and the message says so") {
    Script script{.ends = {end(true), end(false)}, .last_good = good};
    const Equilibrium result = script.play();
    CHECK(script.began_at == std::vector<double>{1.0, 4.0});
    CHECK(result.status == SolveStatus::converged);
    CHECK(result.stable);
    CHECK_FALSE(result.health.tangled);
    CHECK(result.message.find("175 degrees") != std::string::npos);
    CHECK(result.message.find("last good state") != std::string::npos);
}

TEST_CASE("retry: where that fails, or no state was good, it begins again from the flat one") {
    Script script{.ends = {end(true), end(false, false), end(false)}, .last_good = good};
    CHECK(script.play().status == SolveStatus::converged);
    CHECK(script.began_at == std::vector<double>{1.0, 4.0, 7.0});
    script = {.ends = {end(true), end(false)}, .last_good = {}};
    CHECK(script.play().message.find("flat state") != std::string::npos);
    CHECK(script.began_at == std::vector<double>{1.0, 7.0});
}

TEST_CASE("retry: a tangle that is left over is not converged, although certified") {
    Script script{.ends = {end(true), end(true), end(true)}, .last_good = good};
    const Equilibrium result = script.play();
    CHECK(result.status == SolveStatus::not_converged);
    CHECK(result.health.tangled);
    CHECK(result.message.starts_with("tangled: "));
}

TEST_CASE("retry: a start for a finer mesh need only be free of tangles") {
    Script script{.ends = {end(true, false), end(false, false)}, .last_good = good};
    CHECK_FALSE(script.play(true).health.tangled);
    CHECK(script.began_at.size() == 2);
}

TEST_CASE("retry: what is only a start for a finer mesh is not solved again, the finest mesh is") {
    ModelInput sheet;
    sheet.mesh = ruche::test::random_grid(6, 6, 0.2, 5);
    sheet.print.assign(sheet.mesh.triangles.size(), Print{.front = 0.8});
    sheet.prestretch = {1.4, 1.4};
    const Model model(sheet);
    Eigen::VectorXd crushed = Eigen::VectorXd::Zero(3 * model.vertex_count());
    for (int v = 0; v < model.vertex_count(); ++v) crushed.segment<2>(3 * v) = 1e-3 * sheet.mesh.vertices[v];
    SolveOptions options;
    options.max_iterations = 0;
    const LayoutShape start{sheet.mesh, sheet.print, crushed};
    CHECK(solve(model, options, {}, start).message.find("a first attempt was tangled") != std::string::npos);
    options.enough_rotation = 0.005;
    const Equilibrium on_the_way = solve(model, options, {}, start);
    CHECK(on_the_way.health.tangled);
    CHECK(on_the_way.message.find("a first attempt") == std::string::npos);
}
