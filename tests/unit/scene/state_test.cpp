#include "ruche/scene/state.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "ruche/core/document.hpp"
#include "ruche/scene/read_scene.hpp"
#include "ruche/scene/write_scene.hpp"

using namespace ruche;

namespace {
/// A grid of squares of `size` mm over [0, 4] x [0, 4], each cut in two.
TriangleMesh grid(int squares) {
    TriangleMesh mesh;
    const double size = 4.0 / squares;
    for (int j = 0; j <= squares; ++j)
        for (int i = 0; i <= squares; ++i) mesh.vertices.emplace_back(i * size, j * size);
    for (int j = 0; j < squares; ++j)
        for (int i = 0; i < squares; ++i) {
            const int corner = j * (squares + 1) + i;
            mesh.triangles.push_back({corner, corner + 1, corner + squares + 2});
            mesh.triangles.push_back({corner, corner + squares + 2, corner + squares + 1});
        }
    return mesh;
}

Vec3 tilted(const Vec2& p) { return {0.8 * p.x() + 1, 1.1 * p.y(), 0.5 * p.x() - 0.25 * p.y() + 2}; }

State sample_state() {
    State state{.scene = "[fabric]\nprestretch = [1.7, 1.7]\n",
                .fingerprint = 77,
                .layout = grid(3),
                .iterations = 12};
    const Eigen::Index vertices = state.layout.vertex_count();
    state.x = Eigen::VectorXd::LinSpaced(3 * vertices + 5, -1.0 / 3.0, 1e-7);
    for (Eigen::Index v = 0; v < vertices; ++v)
        state.x.segment<3>(3 * v) = tilted(state.layout.vertices[static_cast<std::size_t>(v)]);
    return state;
}

std::string file_bytes(const std::string& path) { return read_file(path, "state", 1U << 20U); }
void write_bytes(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}
const std::string path = "state_test.ruche";
}  // namespace

TEST_CASE("state: comes back bit by bit") {
    const State state = sample_state();
    write_state(path, state);
    const State again = read_state(path);
    CHECK(again.scene == state.scene);
    CHECK(again.fingerprint == state.fingerprint);
    CHECK(again.iterations == state.iterations);
    CHECK(again.layout.vertices == state.layout.vertices);
    CHECK(again.layout.triangles == state.layout.triangles);
    REQUIRE(again.x.size() == state.x.size());
    CHECK((again.x.array() == state.x.array()).all());
    std::filesystem::remove(path);
}

TEST_CASE("state: truncated anywhere or changed anywhere, it is refused") {
    write_state(path, sample_state());
    const std::string whole = file_bytes(path);
    for (std::size_t length = 0; length < whole.size(); length += 13) {
        write_bytes(path, whole.substr(0, length));
        CHECK_THROWS_AS(read_state(path), InputError);
    }
    for (std::size_t at = 0; at < whole.size(); at += 17) {
        std::string changed = whole;
        changed[at] = static_cast<char>(changed[at] ^ 0x10);
        write_bytes(path, changed);
        CHECK_THROWS_AS(read_state(path), InputError);
    }
    write_bytes(path, "solid cube\n");
    CHECK_THROWS_WITH_AS(read_state(path), doctest::Contains("is not a state file"), InputError);
    std::filesystem::remove(path);
    CHECK_THROWS_WITH_AS(read_state(path), doctest::Contains("there is no such file"), InputError);
}

TEST_CASE("fingerprint: changes with everything that changes the energy, and with nothing else") {
    ModelInput model;
    model.mesh = grid(2);
    model.print.resize(model.mesh.triangles.size());
    const std::uint64_t before = fingerprint(model);
    CHECK(fingerprint(model) == before);
    const auto differs = [&](auto&& change) {
        ModelInput other = model;
        change(other);
        return fingerprint(other) != before;
    };
    CHECK(differs([](ModelInput& m) { m.mesh.vertices[3].x() += 1e-12; }));
    CHECK(differs([](ModelInput& m) { std::swap(m.mesh.triangles[0], m.mesh.triangles[1]); }));
    CHECK(differs([](ModelInput& m) { m.print[1].back = 0.6; }));
    CHECK(differs([](ModelInput& m) { m.material.plastic_density += 1; }));
    CHECK(differs([](ModelInput& m) { m.prestretch[1] = 1.6; }));
    CHECK(differs([](ModelInput& m) { m.fabric_axis_deg = 1; }));
    CHECK(differs([](ModelInput& m) { m.gravity[2] = -1; }));
    CHECK(differs([](ModelInput& m) { m.supports.push_back({}); }));
    CHECK(differs([](ModelInput& m) { m.forces.push_back({}); }));
    CHECK(differs([](ModelInput& m) { m.table.present = true; }));
    CHECK(differs([](ModelInput& m) { m.options.edge_normals = EdgeNormals::averaged; }));
}

TEST_CASE("resume_from: goes on with the same scene and says what differs in another") {
    const Scene scene = parse_scene("pattern.mesh = \"a.ply\"", "k.toml");
    ModelInput model;
    model.mesh = grid(3);
    State state = sample_state();
    state.scene = to_toml(scene);
    state.fingerprint = fingerprint(model);
    CHECK(resume_from(state, scene, model, path).size() == state.x.size());
    Scene other = scene;
    other.fabric.prestretch = {1.6, 1.6};
    other.solver.seed = 9;  // does not matter
    model.prestretch = {1.6, 1.6};
    CHECK_THROWS_WITH_AS(
        resume_from(state, other, model, path),
        doctest::Contains("belongs to another scene: fabric.prestretch was [1.7, 1.7], now [1.6, 1.6]\n"),
        InputError);
    model = ModelInput{.mesh = grid(2)};
    CHECK_THROWS_WITH_AS(resume_from(state, scene, model, path),
                         doctest::Contains("the drawing or the mesh has changed"), InputError);
}

TEST_CASE("start_from: takes everything for the same mesh") {
    State state = sample_state();
    const Model model(
        {.mesh = state.layout, .print = std::vector<Print>(state.layout.triangles.size(), {.front = 0.6})});
    REQUIRE(model.size() > 3 * model.vertex_count());
    state.x = Eigen::VectorXd::LinSpaced(model.size(), -1.0 / 3.0, 1e-7);
    CHECK((start_from(state, model).array() == state.x.array()).all());
}

TEST_CASE("start_from: interpolates on another mesh, exactly where the shape is plane, also beyond it") {
    const State state = sample_state();
    TriangleMesh finer = grid(7);
    for (Vec2& vertex : finer.vertices) vertex = 1.4 * vertex - Vec2(0.8, 0.8);
    const Model model({.mesh = finer, .print = std::vector<Print>(finer.triangles.size(), {.front = 0.6})});
    const Eigen::VectorXd x = start_from(state, model);
    // Plane and equally strained: up to a shift, which is free, because the old layout does not reach
    // everywhere.
    const Vec3 shift = x.segment<3>(0) - tilted(finer.vertices[0]);
    for (int v = 0; v < finer.vertex_count(); ++v)
        CHECK((x.segment<3>(3 * v) - tilted(finer.vertices[static_cast<std::size_t>(v)]) - shift).norm() <
              1e-9);
    CHECK(x.size() > 3 * finer.vertex_count());
    CHECK(x.tail(x.size() - 3 * finer.vertex_count()).norm() == 0);
}
