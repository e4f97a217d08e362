#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>

#include "ruche/core/error.hpp"
#include "ruche/energy/model.hpp"
#include "ruche/material/cards.hpp"
#include "ruche/material/consistent_modulus.hpp"
#include "ruche/material/laminate.hpp"
#include "ruche/output/metrics.hpp"
#include "ruche/output/report.hpp"
#include "ruche/scene/read_scene.hpp"
#include "ruche/scene/simulate.hpp"
#include "ruche/statics/equilibrium.hpp"
#include "ruche/study/sensitivity/sensitivity.hpp"

namespace py = pybind11;
using namespace py::literals;
using namespace ruche;

namespace {

using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

TriangleMesh make_mesh(const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>& layout,
                       const Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>& triangles) {
    TriangleMesh mesh;
    for (Eigen::Index i = 0; i < layout.rows(); ++i) mesh.vertices.emplace_back(layout.row(i).transpose());
    for (Eigen::Index i = 0; i < triangles.rows(); ++i) {
        mesh.triangles.push_back({triangles(i, 0), triangles(i, 1), triangles(i, 2)});
    }
    return mesh;
}

/// (m,) or (m, 2) numbers as front and back columns; a negative number in the first form is the back's.
Eigen::MatrixX2d sides(const py::object& values, Eigen::Index triangles, const char* name) {
    const auto array = py::cast<py::array_t<double, py::array::c_style | py::array::forcecast>>(values);
    const bool one_column = array.ndim() == 1;
    if (array.shape(0) != triangles || !(one_column || (array.ndim() == 2 && array.shape(1) == 2))) {
        throw InputError({.key = name}, "has the wrong shape",
                         "Give one number per triangle (m,), negative for the back, or (m, 2): front, back.");
    }
    Eigen::MatrixX2d result(triangles, 2);
    for (Eigen::Index t = 0; t < triangles; ++t) {
        const double first = one_column ? array.at(t) : array.at(t, 0);
        result(t, 0) = one_column ? std::max(0.0, first) : first;
        result(t, 1) = one_column ? std::max(0.0, -first) : array.at(t, 1);
        if (std::isnan(first)) result.row(t).setConstant(first);
    }
    return result;
}

/// A sequence of vertices that are held where they were printed, or {vertex: (x, y, z)} with None for a free
/// coordinate.
std::vector<Support> supports(const py::object& pins, const TriangleMesh& mesh) {
    std::vector<Support> result;
    if (pins.is_none()) return result;
    const auto held_in_place = [&](int vertex) {
        if (vertex < 0 || vertex >= mesh.vertex_count()) {
            throw InputError({.key = "pins"}, "there is no vertex " + std::to_string(vertex),
                             "Vertices are numbered from 0.");
        }
        const Vec2& p = mesh.vertices[vertex];
        return Support{.vertex = vertex, .fixed = {true, true, true}, .at = Vec3(p.x(), p.y(), 0.0)};
    };
    if (!py::isinstance<py::dict>(pins)) {
        for (const int vertex : py::cast<std::vector<int>>(pins)) result.push_back(held_in_place(vertex));
        return result;
    }
    for (const auto& [key, value] : py::cast<py::dict>(pins)) {
        Support support = held_in_place(py::cast<int>(key));
        const auto coordinates = py::cast<std::vector<py::object>>(value);
        if (coordinates.size() != 3)
            throw InputError({.key = "pins"}, "a place has three coordinates", "Use None for a free one.");
        for (int c = 0; c < 3; ++c) {
            support.fixed[c] = !coordinates[c].is_none();
            if (support.fixed[c]) support.at[c] = py::cast<double>(coordinates[c]);
        }
        result.push_back(support);
    }
    return result;
}

std::array<double, 2> prestretch_pair(const py::object& prestretch) {
    if (py::isinstance<py::float_>(prestretch) || py::isinstance<py::int_>(prestretch)) {
        const double s = py::cast<double>(prestretch);
        return {s, s};
    }
    return py::cast<std::array<double, 2>>(prestretch);
}

/// Sets fields of a parameter struct by bare name, checked against its table.
template <class Struct>
void set_fields(Struct& target, const py::dict& values, const std::string& section) {
    for (const auto& [key, value] : values) {
        const auto name = py::cast<std::string>(key);
        const Field<Struct>* field = nullptr;
        for (const Field<Struct>& f : fields<Struct>()) {
            if (bare_name(info(f)) == name || f.key == name) field = &f;
        }
        if (field == nullptr) throw InputError({.key = section + "." + name}, "unknown option", "");
        FieldValue converted = get(target, *field);
        std::visit([&, v = value](auto& slot) { slot = py::cast<std::decay_t<decltype(slot)>>(v); },
                   converted);
        check(info(*field), converted, {.key = section + "." + name});
        set(target, *field, converted);
    }
}

struct PythonMesh {
    TriangleMesh mesh;
};

std::unique_ptr<Model> make_model(const PythonMesh& mesh, const py::object& plastic_mm,
                                  const Material& material, const py::object& prestretch,
                                  double fabric_axis_deg, const std::array<double, 3>& gravity,
                                  const py::object& pins, const py::object& plastic_modulus,
                                  const std::vector<std::tuple<std::vector<int>, double, double>>& rods,
                                  const py::kwargs& switches) {
    ModelInput input;
    input.mesh = mesh.mesh;
    const auto count = static_cast<Eigen::Index>(mesh.mesh.triangles.size());
    const Eigen::MatrixX2d thickness = sides(plastic_mm, count, "plastic_mm");
    Eigen::MatrixX2d modulus = Eigen::MatrixX2d::Zero(count, 2);
    if (!plastic_modulus.is_none()) {
        modulus = sides(plastic_modulus, count, "plastic_modulus_mpa");
        const bool one_column = py::cast<py::array>(plastic_modulus).ndim() == 1;
        if (one_column) modulus.col(1) = modulus.col(0);
    }
    for (Eigen::Index t = 0; t < count; ++t) {
        input.print.push_back({thickness(t, 0), thickness(t, 1), modulus(t, 0), modulus(t, 1)});
    }
    input.material = material;
    input.prestretch = prestretch_pair(prestretch);
    input.fabric_axis_deg = fabric_axis_deg;
    input.gravity = gravity;
    input.supports = supports(pins, mesh.mesh);
    set_fields(input.options, switches, "Model");
    for (const auto& [vertices, width, thickness] : rods) {
        input.options.strips = StripModel::rods;
        input.rods.push_back({.vertices = vertices,
                              .width = width,
                              .thickness = std::abs(thickness),
                              .side = thickness < 0.0 ? Side::back : Side::front});
    }
    return std::make_unique<Model>(std::move(input));
}

Positions positions_of(const Eigen::VectorXd& x, int vertices) {
    return Eigen::Map<const Positions>(x.data(), vertices, 3);
}

/// What solve() returns.
struct Solution {
    Equilibrium equilibrium;
    Positions positions;
};

void check_size(const Model& model, const Eigen::VectorXd& x) {
    if (x.size() != model.size()) {
        throw InputError(
            {.key = "x"},
            "has " + std::to_string(x.size()) + " unknowns, the model " + std::to_string(model.size()), "");
    }
}

const char* status_name(SolveStatus status) {
    return status == SolveStatus::converged     ? "converged"
           : status == SolveStatus::interrupted ? "interrupted"
                                                : "not_converged";
}

/// Stops a solve when Python has a signal pending (Ctrl-C).
Control interruptible(std::atomic<bool>& stop) {
    Control control;
    control.stop = &stop;
    control.report = [&stop](const Progress&) {
        const py::gil_scoped_acquire gil;
        if (PyErr_CheckSignals() != 0) {
            PyErr_Clear();
            stop = true;
        }
    };
    return control;
}

void bind_material(py::module_& m) {
    py::class_<Material> material(
        m, "Material",
        "Fabric and plastic: mm, N, MPa; densities in kg/m^2 and kg/m^3. Fields are named as in a "
        "scene's [material], without the unit.");
    material.def(py::init<>());
    material.def_static(
        "preset",
        [](const std::string& name) {
            return resolve_card(name, {1.7, 1.7}).material;
        },
        "name"_a, "A material card that comes with the program, at its pre-stretch of 1.7.");
    material.def_static(
        "card",
        [](const std::string& path, const py::object& s) {
            return resolve_card(path, prestretch_pair(s)).material;
        },
        "name_or_path"_a, "prestretch"_a = 1.7);
    for (const Field<Material>& field : fields<Material>()) {
        const FieldInfo about = info(field);
        const std::string name(bare_name(about));
        const std::string doc =
            std::string(about.meaning) + (about.unit.empty() ? "" : " (" + std::string(about.unit) + ")");
        material.def_property(
            name.c_str(), [&field](const Material& self) { return std::get<double>(get(self, field)); },
            [&field, name](Material& self, double value) {
                check(info(field), value, {.key = "Material." + name});
                set(self, field, value);
            },
            doc.c_str());
    }
    material.def("__copy__", [](const Material& self) { return Material(self); });
    material.def("__deepcopy__", [](const Material& self, const py::dict&) { return Material(self); });
}

void bind_model(py::module_& m) {
    py::class_<PythonMesh>(
        m, "Mesh",
        "The flat layout: vertices (n, 2) in mm, triangles (m, 3), counter-clockwise from the front.")
        .def(py::init([](const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>& layout,
                         const Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>& triangles) {
                 return PythonMesh{make_mesh(layout, triangles)};
             }),
             "layout_mm"_a, "triangles"_a);
    py::class_<Model>(m, "Model", "Energy of a printed sheet, its gradient and its Hessian.")
        .def(py::init(&make_model), "mesh"_a, "plastic_mm"_a, "material"_a, "prestretch"_a = 1.7,
             "fabric_axis_deg"_a = 0.0, "gravity_mm_per_s2"_a = std::array<double, 3>{0, 0, 0},
             "pins"_a = py::none(), "plastic_modulus_mpa"_a = py::none(),
             "rods"_a = std::vector<std::tuple<std::vector<int>, double, double>>(),
             "plastic_mm: thickness per triangle (m,), 0 bare, negative on the back, or (m, 2) front and "
             "back. pins: "
             "vertices held where they were printed, or {vertex: (x, y, z)} with None for a free coordinate. "
             "rods, in place of plastic_mm: (vertices along edges, width in mm, thickness in mm, negative on "
             "the "
             "back) per strip. "
             "Further "
             "switches: edge_normals ('free' | 'averaged'), bending_normalisation ('plate' | 'as_printed'), "
             "laminate_thickness ('true' | 'as_printed'), shear_strain ('engineering' | 'tensor'), "
             "fabric_ply ('linear' | 'same_law'), log_extension.")
        .def_property_readonly("size", &Model::size,
                               "Number of unknowns: three per vertex, then edge unknowns.")
        .def("initial", &Model::initial, "Flat as printed, without noise.")
        .def(
            "energy",
            [](const Model& self, const Eigen::VectorXd& x) {
                check_size(self, x);
                return self.energy(x);
            },
            "x"_a, "mJ")
        .def(
            "gradient",
            [](const Model& self, const Eigen::VectorXd& x) {
                check_size(self, x);
                return self.gradient(x);
            },
            "x"_a, "N")
        .def(
            "hessian",
            [](const Model& self, const Eigen::VectorXd& x) {
                check_size(self, x);
                return self.hessian(x);
            },
            "x"_a, "SciPy CSC, N/mm")
        .def(
            "energy_terms",
            [](const Model& self, const Eigen::VectorXd& x) {
                check_size(self, x);
                const EnergyTerms terms = self.energy_terms(x);
                py::dict by_term("fabric_membrane"_a = terms.fabric_membrane,
                                 "fabric_bending"_a = terms.fabric_bending, "plastic"_a = terms.plastic,
                                 "gravity"_a = terms.gravity);
                if (self.input().options.contact) by_term["contact"] = terms.contact;
                return by_term;
            },
            "x"_a, "mJ by term");
}

void bind_solve(py::module_& m) {
    py::class_<Solution>(m, "Result", "A released shape.")
        .def_readonly("positions", &Solution::positions, "(n, 3), mm")
        .def_property_readonly(
            "x", [](const Solution& s) { return s.equilibrium.x; }, "all unknowns")
        .def_property_readonly(
            "energy", [](const Solution& s) { return s.equilibrium.energy.total(); }, "mJ")
        .def_property_readonly(
            "residual", [](const Solution& s) { return s.equilibrium.residual; }, "N")
        .def_property_readonly(
            "converged", [](const Solution& s) { return s.equilibrium.status == SolveStatus::converged; })
        .def_property_readonly("status", [](const Solution& s) { return status_name(s.equilibrium.status); })
        .def_property_readonly("stable", [](const Solution& s) { return s.equilibrium.stable; })
        .def_property_readonly("iterations", [](const Solution& s) { return s.equilibrium.iterations; })
        .def_property_readonly("factorizations",
                               [](const Solution& s) { return s.equilibrium.factorizations; })
        .def_property_readonly("seconds", [](const Solution& s) { return s.equilibrium.seconds; })
        .def_property_readonly("message", [](const Solution& s) { return s.equilibrium.message; });
    m.def(
        "solve",
        [](const Model& model, const std::optional<Eigen::VectorXd>& start, const py::kwargs& options) {
            SolveOptions solve_options;
            set_fields(solve_options, options, "solve");
            if (start) check_size(model, *start);
            std::atomic<bool> stop = false;
            const Control control = interruptible(stop);
            Solution solution;
            {
                const py::gil_scoped_release release;
                solution.equilibrium = solve(model, solve_options, control, start ? &*start : nullptr);
            }
            solution.positions = positions_of(solution.equilibrium.x, model.vertex_count());
            return solution;
        },
        "model"_a, "start"_a = py::none(),
        "Releases the sheet: a strict local minimum of the energy. Options as in a scene's [solver]: "
        "residual_tolerance, "
        "max_iterations, seed, noise, deterministic, threads.");
    py::class_<Result, std::unique_ptr<Result>>(m, "SceneResult", "Everything about a simulated scene.")
        .def_property_readonly(
            "positions",
            [](const Result& r) { return positions_of(r.equilibrium.x, r.layout.mesh.vertex_count()); })
        .def_property_readonly("layout",
                               [](const Result& r) {
                                   Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> layout(
                                       r.layout.mesh.vertex_count(), 2);
                                   for (int v = 0; v < r.layout.mesh.vertex_count(); ++v)
                                       layout.row(v) = r.layout.mesh.vertices[v].transpose();
                                   return layout;
                               })
        .def_property_readonly("triangles",
                               [](const Result& r) {
                                   Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor> triangles(
                                       r.layout.mesh.triangle_count(), 3);
                                   for (int t = 0; t < r.layout.mesh.triangle_count(); ++t) {
                                       for (int i = 0; i < 3; ++i)
                                           triangles(t, i) = r.layout.mesh.triangles[t][i];
                                   }
                                   return triangles;
                               })
        .def_property_readonly("energy", [](const Result& r) { return r.equilibrium.energy.total(); })
        .def_property_readonly("residual", [](const Result& r) { return r.equilibrium.residual; })
        .def_property_readonly("converged",
                               [](const Result& r) { return r.equilibrium.status == SolveStatus::converged; })
        .def_property_readonly("stable", [](const Result& r) { return r.equilibrium.stable; })
        .def_property_readonly("iterations", [](const Result& r) { return r.equilibrium.iterations; })
        .def_property_readonly(
            "report",
            [](const Result& r) { return py::module_::import("json").attr("loads")(report_json(r)); },
            "What report.json holds, as a dict.")
        .def(
            "sensitivity",
            [](const Result& r) -> py::object {
                std::optional<Sensitivities> found;
                {
                    const py::gil_scoped_release release;
                    found = sensitivities(r);
                }
                if (!found) return py::none();
                return py::module_::import("json").attr("loads")(sensitivity_json(*found, r.scene.file));
            },
            "d ln measure / d ln parameter, as a dict like the JSON of `ruche sensitivity`; None for a shape "
            "that is not stable.");
    m.def(
        "simulate",
        [](const std::string& path, const std::vector<std::string>& set) {
            std::vector<Override> overrides;
            overrides.reserve(set.size());
            for (const std::string& text : set) overrides.push_back(parse_override(text, "set"));
            const Scene scene = read_scene(path, overrides);
            std::atomic<bool> stop = false;
            const Control control = interruptible(stop);
            const py::gil_scoped_release release;
            return std::make_unique<Result>(simulate(scene, control));
        },
        "scene"_a, "set"_a = std::vector<std::string>{},
        "The whole pipeline for a scene file; `set` as --set path=value.");
}

}  // namespace

PYBIND11_MODULE(ruche, m) {
    m.doc() = "Ruche: the shape that plastic printed on pre-stretched fabric takes. Units: mm, N, MPa, mJ.";
    py::register_exception<InputError>(m, "InputError", PyExc_ValueError);
    bind_material(m);
    bind_model(m);
    bind_solve(m);
    m.def(
        "consistent_fabric_modulus",
        [](const Material& material, const py::object& prestretch) {
            return consistent_fabric_modulus(material, prestretch_pair(prestretch));
        },
        "material"_a, "prestretch"_a = 1.7,
        "The fabric_youngs_modulus (MPa) with which a linear fabric ply, held at the pre-stretch, pulls as "
        "hard as "
        "the fabric's law says, in the mean of both axes.");
    m.def(
        "laminate_energy_density",
        [](const Mat2& a, const Mat2& b, const std::vector<std::tuple<double, double, double, Mat2>>& plies,
           double poissons_ratio) {
            std::vector<Ply> stack;
            stack.reserve(plies.size());
            for (const auto& [z0, z1, modulus, rest_metric] : plies)
                stack.push_back({z0, z1, modulus, rest_metric});
            return laminate_energy_density(a, b, stack, poissons_ratio);
        },
        "a"_a, "b"_a, "plies"_a, "poissons_ratio"_a,
        "Energy of plies (z0, z1, youngs_modulus, rest_metric) for fundamental forms a and b in an "
        "orthonormal layout "
        "basis, mJ/mm^2 of layout.");
}
