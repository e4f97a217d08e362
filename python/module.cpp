#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "ruche/energy/model.hpp"
#include "ruche/statics/equilibrium.hpp"

namespace py = pybind11;
using namespace py::literals;
using namespace ruche;

PYBIND11_MODULE(ruche, m) {
    m.doc() = "smoke";
    m.def("quick", [](const Eigen::MatrixX2d& layout, const Eigen::MatrixX3i& tri,
                      const Eigen::VectorXd& plastic, const std::string& normals, double s, double axis) {
        ModelInput in;
        for (int i = 0; i < layout.rows(); ++i) in.mesh.vertices.push_back(layout.row(i).transpose());
        for (int i = 0; i < tri.rows(); ++i) {
            in.mesh.triangles.push_back({tri(i, 0), tri(i, 1), tri(i, 2)});
            in.print.push_back({.front = std::max(0.0, plastic[i]), .back = std::max(0.0, -plastic[i])});
        }
        in.prestretch = {s, s};
        in.fabric_axis_deg = axis;
        in.options.edge_normals = normals == "free" ? EdgeNormals::free : EdgeNormals::averaged;
        return std::make_unique<Model>(std::move(in));
    });
    py::class_<Model>(m, "Model")
        .def("initial", &Model::initial)
        .def("energy", &Model::energy)
        .def("gradient", &Model::gradient)
        .def("hessian", &Model::hessian)
        .def("terms",
             [](const Model& mm, const Eigen::VectorXd& x) {
                 auto t = mm.energy_terms(x);
                 return std::array<double, 4>{t.fabric_membrane, t.fabric_bending, t.plastic, t.gravity};
             })
        .def("energy_density", &Model::energy_density);
    m.def(
        "solve",
        [](const Model& mm, int seed, double noise, bool verbose) {
            SolveOptions o;
            o.seed = seed;
            o.noise_mm = noise;
            Control c;
            if (verbose) c.report = [](const Progress& p) { py::print(p.text); };
            Equilibrium e = solve(mm, o, c);
            py::dict d;
            d["x"] = e.x;
            d["status"] = int(e.status);
            d["stable"] = e.stable;
            d["energy"] = e.energy.total();
            d["residual"] = e.residual;
            d["iterations"] = e.iterations;
            d["factorizations"] = e.factorizations;
            d["seconds"] = e.seconds;
            d["message"] = e.message;
            d["typical"] = e.typical_force;
            d["margin"] = e.health.max_strain_margin;
            d["dihedral"] = e.health.max_dihedral_deg;
            d["rot"] = e.health.max_edge_rotation_deg;
            d["J"] = e.health.min_area_ratio;
            return d;
        },
        "model"_a, "seed"_a = 1, "noise"_a = 1e-3, "verbose"_a = false);
}
