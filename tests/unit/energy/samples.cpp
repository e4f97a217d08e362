#include "energy/samples.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "energy/battery.hpp"

namespace ruche::test {

TriangleMesh random_grid(int nx, int ny, double jitter, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-jitter, jitter);
    TriangleMesh mesh;
    std::vector<int> number((nx + 1) * (ny + 1));
    std::iota(number.begin(), number.end(), 0);
    std::shuffle(number.begin(), number.end(), random);
    mesh.vertices.resize(number.size());
    for (int j = 0; j <= ny; ++j) {
        for (int i = 0; i <= nx; ++i) {
            const bool inside = i > 0 && j > 0 && i < nx && j < ny;
            const Vec2 shift = inside ? Vec2(uniform(random), uniform(random)) : Vec2(Vec2::Zero());
            mesh.vertices[number[j * (nx + 1) + i]] = Vec2(i, j) + shift;
        }
    }
    for (int j = 0; j < ny; ++j) {
        for (int i = 0; i < nx; ++i) {
            const int a = number[j * (nx + 1) + i];
            const int b = number[j * (nx + 1) + i + 1];
            const int c = number[(j + 1) * (nx + 1) + i + 1];
            const int d = number[(j + 1) * (nx + 1) + i];
            if (random() % 2 == 0) {
                mesh.triangles.push_back({a, b, c});
                mesh.triangles.push_back({c, d, a});
            } else {
                mesh.triangles.push_back({b, c, d});
                mesh.triangles.push_back({d, a, b});
            }
        }
    }
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
    return mesh;
}

Eigen::VectorXd rolled(const Model& model, const Roll& roll) {
    std::mt19937 random(roll.seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    Eigen::VectorXd x = model.initial();
    const int positions = 3 * model.vertex_count();
    for (int v = 0; v < model.vertex_count(); ++v) {
        const double along = roll.scale * (0.9 * x[3 * v] + 0.3 * x[3 * v + 1]);
        const double across = roll.scale * (0.9 * x[3 * v + 1] - 0.3 * x[3 * v]);
        x.segment<3>(3 * v) = Vec3(roll.radius * std::sin(along / roll.radius), across,
                                   roll.radius * (1.0 - std::cos(along / roll.radius)));
    }
    for (int i = 0; i < x.size(); ++i) {
        x[i] += (i < positions ? roll.noise : roll.edge_noise) * uniform(random);
    }
    const Motion motion = random_motion(random);
    return roll.turned ? motion(energy_of(model), x) : x;
}

ModelInput patchwork() {
    ModelInput input;
    input.mesh = random_grid(5, 4, 0.2, 3);
    for (int t = 0; t < input.mesh.triangle_count(); ++t) {
        const auto& tri = input.mesh.triangles[t];
        const Vec2 centre =
            (input.mesh.vertices[tri[0]] + input.mesh.vertices[tri[1]] + input.mesh.vertices[tri[2]]) / 3.0;
        const bool printed = (centre.y() > 1.0 && centre.y() < 3.0) || centre.x() > 4.0;
        input.print.push_back({.front = printed ? 0.6 : 0.0});
    }
    return input;
}

ModelInput two_strips() {
    ModelInput sheet;
    sheet.mesh = random_grid(16, 16, 0.2, 5);
    for (const Triangle& tri : sheet.mesh.triangles) {
        const double x = (sheet.mesh.vertices[tri[0]].x() + sheet.mesh.vertices[tri[1]].x() +
                          sheet.mesh.vertices[tri[2]].x()) /
                         3.0;
        sheet.print.push_back({.front = (x > 4 && x < 6) || (x > 10 && x < 12) ? 0.8 : 0.0});
    }
    sheet.prestretch = {1.4, 1.4};
    return sheet;
}

ModelInput rod_patchwork() {
    ModelInput input = patchwork();
    input.print.clear();
    input.options.strips = StripModel::rods;
    const auto line = [&](const std::vector<Vec2>& points) {
        std::vector<int> vertices;
        for (const Vec2& p : points) {
            const auto nearer = [&](const Vec2& a, const Vec2& b) { return (a - p).norm() < (b - p).norm(); };
            vertices.push_back(static_cast<int>(std::ranges::min_element(input.mesh.vertices, nearer) -
                                                input.mesh.vertices.begin()));
        }
        return vertices;
    };
    input.rods = {
        {.vertices = line({{0, 2}, {1, 2}, {2, 2}, {3, 2}, {3, 3}, {4, 3}}), .width = 1.2, .thickness = 0.6},
        {.vertices = line({{2, 4}, {2, 3}, {2, 2}, {2, 1}}),
         .width = 0.8,
         .thickness = 0.5,
         .side = Side::back,
         .youngs_modulus = 30.0},
        {.vertices = line({{3, 2}, {2, 2}, {1, 2}}), .width = 1.0, .thickness = 0.4, .side = Side::back},
        {.vertices = line({{3, 1}, {4, 1}}), .width = 1.0, .thickness = 0.4}};
    return input;
}

std::vector<SetUp> set_ups() {
    std::vector<SetUp> result;
    const auto add = [&](const char* name, auto&& change, bool turns_freely = true) {
        ModelInput input = patchwork();
        change(input);
        result.push_back({name, std::move(input), turns_freely});
    };
    const auto for_each_print = [](ModelInput& input, auto&& change) {
        for (int t = 0; t < int(input.print.size()); ++t) {
            if (!input.print[t].bare()) change(input.print[t], t);
        }
    };
    add("front", [](ModelInput&) {});
    add("back", [&](ModelInput& input) {
        for_each_print(input, [](Print& print, int) { std::swap(print.front, print.back); });
    });
    add("two-sided, several thicknesses and moduli", [&](ModelInput& input) {
        for_each_print(input, [](Print& print, int t) {
            print = {.front = t % 3 == 0 ? 0.0 : 0.4 + 0.1 * (t % 4),
                     .back = t % 3 == 1 ? 0.0 : 0.3,
                     .front_modulus = t % 2 == 0 ? 30.0 : 0.0,
                     .back_modulus = 5.0};
        });
    });
    add("averaged edge normals",
        [](ModelInput& input) { input.options.edge_normals = EdgeNormals::averaged; });
    add("fabric's own law under plastic, several moduli", [&](ModelInput& input) {
        input.options.fabric_ply = FabricPlyLaw::same_law;
        for_each_print(input, [](Print& print, int t) {
            print = {.front = t % 3 == 0 ? 0.0 : 0.5, .back = t % 3 == 1 ? 0.0 : 0.3, .back_modulus = 5.0};
        });
    });
    add("fabric's own law under plastic, averaged edge normals, as printed, tensor shear",
        [](ModelInput& input) {
            input.options.fabric_ply = FabricPlyLaw::same_law;
            input.options.edge_normals = EdgeNormals::averaged;
            input.options.laminate_thickness = LaminateThickness::as_printed;
            input.options.shear_strain = ShearStrain::tensor;
        });
    result.push_back({"rods", rod_patchwork()});
    ModelInput oblique = rod_patchwork();
    oblique.prestretch = {1.5, 1.3};
    oblique.fabric_axis_deg = 30.0;
    oblique.gravity = {0.0, 0.0, -9810.0};
    oblique.options.bending_normalisation = BendingNormalisation::as_printed;
    result.push_back({"rods, unequal pre-stretch, weight", oblique, false});
    add("anisotropic pre-stretch and axis angle", [](ModelInput& input) {
        input.prestretch = {1.5, 1.3};
        input.fabric_axis_deg = 30.0;
    });
    add("as printed, tensor shear", [](ModelInput& input) {
        input.options.bending_normalisation = BendingNormalisation::as_printed;
        input.options.laminate_thickness = LaminateThickness::as_printed;
        input.options.shear_strain = ShearStrain::tensor;
    });
    add("bare", [](ModelInput& input) { input.print.clear(); });
    add("all plastic", [](ModelInput& input) { input.print.assign(input.print.size(), {.front = 0.8}); });
    // Two neighbours of each printed triangle then have the same opposite vertex.
    add("a vertex of three printed triangles", [](ModelInput& input) {
        input.mesh.vertices = {Vec2(0.0, 0.0), Vec2(2.0, 0.1), Vec2(0.9, 1.8), Vec2(0.9, 0.7)};
        input.mesh.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
        input.print.assign(3, {.front = 0.6});
    });
    add(
        "gravity, force and table",
        [](ModelInput& input) {
            input.gravity = {0.0, 0.0, -9810.0};
            input.table = {.present = true, .height = 0.4, .stiffness_per_area = 0.5};
            input.forces = {{.vertex = 2, .force = Vec3(0.0, 0.0, 0.2)}};
        },
        false);
    return result;
}

Star random_star(unsigned seed, double bend) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-0.15, 0.15);
    const auto noise = [&]() -> Vec2 { return Vec2(uniform(random), uniform(random)); };
    Star star;
    star.layout = {Vec2(0.0, 0.0), Vec2(1.0, 0.0),  Vec2(0.4, 0.9),
                   Vec2(1.3, 0.9), Vec2(-0.6, 0.8), Vec2(0.5, -0.8)};
    for (Vec2& p : star.layout) p += noise();
    star.x = Eigen::VectorXd::Zero(21);
    std::uniform_real_distribution<double> lift(-bend, bend);
    for (int v = 0; v < 6; ++v) {
        star.x.segment<2>(3 * v) = 0.9 * star.layout[v] + 0.5 * noise();
        star.x[3 * v + 2] = lift(random);
    }
    for (int k = 0; k < 3; ++k) star.x[18 + k] = 0.5 * lift(random);
    const Motion motion = random_motion(random);
    for (int v = 0; v < 6; ++v) {
        star.x.segment<3>(3 * v) = motion.rotation * star.x.segment<3>(3 * v) + motion.translation;
    }
    return star;
}

PrintedLaminate sample_print(bool front, bool back) {
    return {.front = front ? 0.6 : 0.0,
            .back = back ? 0.4 : 0.0,
            .fabric = 0.46,
            .front_modulus = 72.3,
            .back_modulus = 20.0,
            .fabric_modulus = 1.05};
}

/// The relaxed fabric of the stars, in fabric axes.
static const Mat2 star_relaxation = Vec2(1.0 / 1.7, 1.0 / 1.5).asDiagonal();

LaminateTerm::Element laminate_element(const Star& star, const std::array<EdgeKind, 3>& kinds,
                                       const PrintedLaminate& print) {
    using Kind = LaminateTerm::EdgeSide::Kind;
    LaminateTerm::Element element{.vertices = {0, 1, 2},
                                  .layout = {star.layout[0], star.layout[1], star.layout[2]},
                                  .sides = {},
                                  .plies = {},
                                  .fabric = {}};
    for (int i = 0; i < 3; ++i) {
        LaminateTerm::EdgeSide& side = element.sides[i];
        if (kinds[i] == EdgeKind::open_rim) {
            side = {.kind = Kind::open_rim, .unknown = 6 + i};
            continue;
        }
        if (kinds[i] == EdgeKind::free_rim || kinds[i] == EdgeKind::clamped_rim) {
            side.kind = kinds[i] == EdgeKind::free_rim ? Kind::free_rim : Kind::clamped_rim;
            continue;
        }
        side = {.kind = Kind::hinged,
                .flap = 3 + i,
                .unknown = kinds[i] == EdgeKind::free ? 6 + i : -1,
                .sign = i == 1 ? -1.0 : 1.0,
                .mean_altitude = 0.7 + 0.1 * i};
    }
    Mat2 edges;
    edges << star.layout[1] - star.layout[0], star.layout[2] - star.layout[0];
    const Mat2 fabric = star_relaxation * edges;
    element.plies = printed_plies(print, edges.transpose() * edges, fabric.transpose() * fabric);
    return element;
}

LaminateTerm::Element with_fabric_law(LaminateTerm::Element element) {
    const auto& p = element.layout;
    element.fabric = {element.plies[0].z0,
                      element.plies[0].z1,
                      p,
                      {star_relaxation * p[0], star_relaxation * p[1], star_relaxation * p[2]}};
    element.plies.erase(element.plies.begin());
    return element;
}

}  // namespace ruche::test
