#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "ruche/core/error.hpp"
#include "ruche/meshing/mesh_strips.hpp"
#include "ruche/meshing/print_mesh.hpp"
#include "ruche/meshing/raw_mesh.hpp"

namespace ruche {
namespace {

constexpr double thickest_mm = 100.0;
constexpr double largest_mm = 1e5;
constexpr double flat_within = 1e-6;    // of the size: largest difference of z
constexpr double sliver_within = 1e-9;  // smallest triangle's altitude over its longest edge

class Checker {
  public:
    Checker(RawMesh raw, std::string file) : raw_(std::move(raw)), file_(std::move(file)) {}

    PrintMesh finish() {
        if (raw_.triangles.empty()) fail("mesh", "there are no triangles");
        check_vertices();
        check_indices();
        check_print();
        drop_unused();
        check_duplicates();
        PrintMesh layout;
        layout.mesh = flattened();
        layout.print = std::move(raw_.print);
        layout.warnings = std::move(warnings_);
        try {
            find_strips(layout, raw_.strip, raw_.strip_names);
        } catch (const InputError& error) {
            throw InputError({.file = file_, .key = error.place().key}, error.problem(), error.advice());
        }
        return layout;
    }

  private:
    void check_vertices() const {
        for (std::size_t v = 0; v < raw_.vertices.size(); ++v) {
            const Vec3& x = raw_.vertices[v];
            if (!x.allFinite())
                fail(vertex(v), fmt::format("({}, {}, {}) is not finite", x.x(), x.y(), x.z()));
            if (x.cwiseAbs().maxCoeff() > largest_mm)
                fail(vertex(v), fmt::format("({}, {}, {}) mm is more than 100 m away", x.x(), x.y(), x.z()),
                     "Coordinates are millimetres.");
        }
    }

    void check_indices() const {
        const auto count = static_cast<int>(raw_.vertices.size());
        for (std::size_t t = 0; t < raw_.triangles.size(); ++t) {
            const Triangle& tri = raw_.triangles[t];
            for (const int v : tri) {
                if (v < 0 || v >= count)
                    fail(triangle(t),
                         fmt::format("a corner is vertex {}, but there are {} vertices", v, count));
            }
            if (tri[0] == tri[1] || tri[1] == tri[2] || tri[2] == tri[0])
                fail(triangle(t), fmt::format("two of its corners are the same vertex ({}, {}, {})", tri[0],
                                              tri[1], tri[2]));
        }
    }

    void check_print() const {
        for (std::size_t t = 0; t < raw_.print.size(); ++t) {
            const Print& p = raw_.print[t];
            for (const double thickness : {p.front, p.back}) {
                if (!(thickness >= 0.0 && thickness <= thickest_mm))
                    fail(triangle(t), fmt::format("a printed thickness of {} mm", thickness),
                         "Thickness is between 0 (bare) and 100 mm; front_mm and back_mm say the side.");
            }
            for (const double modulus : {p.front_modulus, p.back_modulus}) {
                if (!(modulus >= 0.0 && std::isfinite(modulus)))
                    fail(triangle(t), fmt::format("a Young's modulus of {} MPa", modulus),
                         "It is positive, or 0 for the material card's.");
            }
        }
    }

    /// A vertex that no triangle uses has no equation: it is left out.
    void drop_unused() {
        std::vector<int> number(raw_.vertices.size(), -1);
        for (const Triangle& tri : raw_.triangles) {
            for (const int v : tri) number[v] = 0;
        }
        int kept = 0;
        for (std::size_t v = 0; v < number.size(); ++v) {
            if (number[v] < 0) continue;
            raw_.vertices[kept] = raw_.vertices[v];
            number[v] = kept++;
        }
        const auto unused = static_cast<int>(raw_.vertices.size()) - kept;
        if (unused == 0) return;
        raw_.vertices.resize(kept);
        for (Triangle& tri : raw_.triangles) {
            for (int& v : tri) v = number[v];
        }
        warnings_.push_back(fmt::format("{}: {} vertices that no triangle uses are left out", file_, unused));
    }

    void check_duplicates() const {
        std::vector<int> order(raw_.vertices.size());
        std::iota(order.begin(), order.end(), 0);
        const auto key = [&](int v) {
            const Vec3& x = raw_.vertices[v];
            return std::array<double, 3>{x.x(), x.y(), static_cast<double>(v)};
        };
        std::ranges::sort(order, {}, key);
        for (std::size_t i = 1; i < order.size(); ++i) {
            const int a = order[i - 1];
            const int b = order[i];
            if (raw_.vertices[a].head<2>() == raw_.vertices[b].head<2>())
                fail(vertex(b),
                     fmt::format("it lies on vertex {}, at ({}, {})", a, raw_.vertices[a].x(),
                                 raw_.vertices[a].y()),
                     "The sheet would be cut there: merge vertices at the same place.");
        }
    }

    /// The flat mesh, all triangles counter-clockwise.
    TriangleMesh flattened() const {
        Vec3 low = raw_.vertices.front();
        Vec3 high = low;
        for (const Vec3& x : raw_.vertices) {
            low = low.cwiseMin(x);
            high = high.cwiseMax(x);
        }
        if (high.z() - low.z() > flat_within * (high - low).maxCoeff())
            fail("mesh", fmt::format("the layout is not flat: z goes from {} to {} mm", low.z(), high.z()),
                 "The layout is the printed pattern on the frame, in a plane of constant z.");
        TriangleMesh mesh;
        for (const Vec3& x : raw_.vertices) mesh.vertices.emplace_back(x.x(), x.y());
        mesh.triangles = raw_.triangles;
        int clockwise = 0;
        for (int t = 0; t < mesh.triangle_count(); ++t) {
            const double area = layout_area(mesh, t);
            double longest = 0.0;
            for (int i = 0; i < 3; ++i) {
                const Triangle& tri = mesh.triangles[t];
                longest = std::max(longest,
                                   (mesh.vertices[tri[i]] - mesh.vertices[tri[(i + 1) % 3]]).squaredNorm());
            }
            if (!(std::abs(area) > sliver_within * longest))
                fail(triangle(t), fmt::format("it has no area ({:.3g} mm^2)", std::abs(area)));
            clockwise += area < 0;
        }
        if (clockwise == mesh.triangle_count()) {
            for (Triangle& tri : mesh.triangles) std::swap(tri[1], tri[2]);
        } else if (clockwise > 0) {
            const bool few = 2 * clockwise <= mesh.triangle_count();
            int odd = 0;
            while ((layout_area(mesh, odd) < 0) != few) ++odd;
            fail(triangle(odd),
                 fmt::format("{} of {} triangles are clockwise", clockwise, mesh.triangle_count()),
                 "The sheet is one surface without folds: orient all triangles counter-clockwise, seen from "
                 "the "
                 "printed side.");
        }
        return mesh;
    }

    static std::string vertex(std::size_t v) { return fmt::format("vertex {}", v); }
    static std::string triangle(std::size_t t) { return fmt::format("triangle {}", t); }

    [[noreturn]] void fail(const std::string& what, const std::string& problem,
                           const std::string& advice = {}) const {
        throw InputError({.file = file_, .key = what}, problem, advice);
    }

    RawMesh raw_;
    std::string file_;
    std::vector<std::string> warnings_;
};

}  // namespace

PrintMesh read_print_mesh(const std::string& path, const std::string& thickness_table) {
    std::string ending = std::filesystem::path(path).extension().string();
    for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (ending != ".ply" && ending != ".obj")
        throw InputError({.file = path}, fmt::format("a layout mesh cannot be read from \"{}\"", ending),
                         "Give a .ply, or an .obj with a thickness_table.");
    if (ending == ".ply" && !thickness_table.empty())
        throw InputError({.file = thickness_table}, "a thickness_table is for OBJ meshes",
                         "A PLY carries front_mm and back_mm itself.");
    return Checker(ending == ".ply" ? read_ply(path) : read_obj(path, thickness_table), path).finish();
}

}  // namespace ruche
