#include "reference_data.hpp"

#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace ruche::test {
namespace {

nlohmann::json read_vectors(const std::string& name) {
    std::ifstream file(std::string(RUCHE_TEST_DATA) + "/vectors/" + name + ".json");
    return nlohmann::json::parse(file);
}

Eigen::VectorXd vector(const nlohmann::json& list, double factor) {
    const auto values = list.get<std::vector<double>>();
    return factor * Eigen::Map<const Eigen::VectorXd>(values.data(), Eigen::Index(values.size()));
}

std::vector<Vec3> triples(const nlohmann::json& list, double factor) {
    std::vector<Vec3> result;
    for (const auto& row : list) result.emplace_back(factor * Vec3(vector(row, 1.0)));
    return result;
}

constexpr double mm = 1e3;     // of 1 m
constexpr double mpa = 1e-6;   // of 1 Pa
constexpr double mj = 1e3;     // of 1 J
constexpr double n_mm = 1e-3;  // N/mm of 1 N/m

}  // namespace

std::vector<std::vector<double>> read_csv(const std::string& name) {
    std::ifstream file(std::string(RUCHE_TEST_DATA) + "/reference/" + name);
    if (!file) throw std::runtime_error("no reference " + name);
    std::vector<std::vector<double>> rows;
    std::string line;
    std::getline(file, line);  // header
    while (std::getline(file, line)) {
        std::vector<double> row;
        const char* at = line.data();
        const char* end = at + line.size();
        while (at < end) {
            double value = 0.0;
            const auto read = std::from_chars(at, end, value);
            if (read.ec != std::errc()) throw std::runtime_error("not a number in " + name + ": " + line);
            row.push_back(value);
            at = read.ptr + 1;
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

ReferenceMesh read_reference_mesh(const std::string& name) {
    const nlohmann::json file = read_vectors(name);
    ReferenceMesh r;
    r.name = name;
    for (const auto& p : file["layout_vertices_2d"]) r.mesh.vertices.emplace_back(vector(p, mm));
    r.mesh.triangles = file["faces"].get<std::vector<Triangle>>();
    r.x.resize(3 * r.mesh.vertex_count());
    for (int v = 0; v < r.mesh.vertex_count(); ++v) {
        r.x.segment<3>(3 * v) = vector(file["deformed_vertices_3d"][v], mm);
    }
    r.w = vector(file["w"], 1.0);
    r.plastic_faces = file["plastic_faces"].get<std::vector<int>>();
    const auto& p = file["params"];
    r.prestretch = p["s"];
    r.fabric_thickness = mm * double(p["h_f"]);
    r.plastic_thickness = mm * double(p["h_p"]);
    r.plastic_modulus = mpa * double(p["E_p"]);
    r.fabric_modulus = mpa * double(p["E_f"]);
    r.laminate_poissons_ratio = p["nu_b"];
    r.fabric_poissons_ratio = p["nu_f"];
    r.alpha_1 = mpa * double(p["alpha1"]);
    r.alpha_2 = mpa * double(p["alpha2"]);
    r.alpha_3 = mpa * double(p["alpha3"]);
    r.bending_stiffness = mj * double(p["k_B"]);
    const auto& forms = file["terms"]["_forms"];
    r.a = triples(forms["a_11_12_22"], mm * mm);
    r.libshell_b = triples(forms["libshell_b_11_12_22"], mm);
    return r;
}

ReferenceValues ReferenceMesh::values(const std::string& term) const {
    const nlohmann::json file = read_vectors(name);
    const auto& entry = file["terms"][term];
    return {mj * double(entry["energy"]), vector(entry["gradient"], 1.0),
            vector(entry["hessian_times_w"], n_mm)};
}

}  // namespace ruche::test
