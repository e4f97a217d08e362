#include "ruche/energy/model.hpp"

#include <algorithm>
#include <cmath>

#include "ruche/core/error.hpp"
#include "ruche/energy/edge_roles.hpp"
#include "ruche/energy/model_parts.hpp"
#include "ruche/energy/rods.hpp"
#include "ruche/geometry/mesh_order.hpp"

namespace ruche {
namespace {

std::array<Vec2, 3> layout_corners(const TriangleMesh& mesh, int t) {
    const Triangle& tri = mesh.triangles[t];
    return {mesh.vertices[tri[0]], mesh.vertices[tri[1]], mesh.vertices[tri[2]]};
}

void check(const ModelInput& input) {
    const TriangleMesh& mesh = input.mesh;
    const auto fail = [](const std::string& key, const std::string& problem, const std::string& advice) {
        throw InputError({.key = key}, problem, advice);
    };
    if (mesh.triangles.empty()) fail("mesh", "there are no triangles", "A sheet needs at least one.");
    if (input.print.size() != mesh.triangles.size()) {
        fail("print",
             std::to_string(input.print.size()) + " values for " + std::to_string(mesh.triangles.size()) +
                 " triangles",
             "Give the printed thickness of every triangle, 0 for bare fabric.");
    }
    for (const Vec2& p : mesh.vertices) {
        if (!p.allFinite()) fail("mesh", "a vertex is not finite", "Coordinates are numbers in mm.");
    }
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        const std::string key = "mesh triangle " + std::to_string(t);
        for (const int v : mesh.triangles[t]) {
            if (v < 0 || v >= mesh.vertex_count())
                fail(key, "refers to vertex " + std::to_string(v), "Vertices are numbered from 0.");
        }
        if (!(layout_area(mesh, t) > 0.0)) {
            fail(key, "is inverted or has no area",
                 "Triangles are counter-clockwise seen from the printed side.");
        }
        const Print& print = input.print[t];
        for (const double value : {print.front, print.back, print.front_modulus, print.back_modulus}) {
            if (!(value >= 0.0) || !std::isfinite(value))
                fail(key, "has a print that is not a number >= 0", "Thickness is in mm, modulus in MPa.");
        }
    }
    for (const auto& field : fields<Material>()) {
        check(info(field), get(input.material, field), {.key = "material." + std::string(field.key)});
    }
    for (const auto& field : fields<ModelOptions>()) {
        check(info(field), get(input.options, field), {.key = "model." + std::string(field.key)});
    }
    if (input.options.log_extension >= std::min(input.material.gamma_1, input.material.gamma_2)) {
        fail("model.log_extension", "is not below gamma_1 and gamma_2",
             "The linear extension would begin at rest; the default is 1e-3.");
    }
    for (const double s : input.prestretch) {
        if (!(s > 0.0) || !std::isfinite(s))
            fail("prestretch", "must be positive", "Length on the frame over relaxed length.");
    }
    const bool finite_loads =
        std::isfinite(input.fabric_axis_deg) && std::isfinite(input.table.height) &&
        std::all_of(input.gravity.begin(), input.gravity.end(), [](double g) { return std::isfinite(g); });
    if (!finite_loads) fail("model", "axis, gravity and table height must be finite numbers", "");
    for (const Support& support : input.supports) {
        if (support.vertex < 0 || support.vertex >= mesh.vertex_count())
            fail("support", "refers to vertex " + std::to_string(support.vertex), "");
    }
    for (const NodalForce& force : input.forces) {
        if (force.vertex < 0 || force.vertex >= mesh.vertex_count())
            fail("force", "refers to vertex " + std::to_string(force.vertex), "");
        if (!force.force.allFinite()) fail("force", "is not a finite number", "Components are in N.");
    }
}

}  // namespace

FabricLaw Model::Parts::law() const {
    return {input.material,
            {.log_extension = input.options.log_extension,
             .tensor_shear = input.options.shear_strain == ShearStrain::tensor}};
}

void Model::Parts::build_elastic_terms() {
    const TriangleMesh& mesh = input.mesh;
    const Material& m = input.material;
    const Mat2 relax = relaxation(input);
    RodElements rods = rod_elements(input, edges);
    const EdgeRoles roles = edge_roles(input, edges, rods.on_rod);
    // Rods stand beside no print, so the unknowns are the ones or the others.
    edge_unknowns = input.rods.empty() ? roles.unknowns : rods.unknowns;
    std::vector<FabricMembrane::Element> membranes;
    std::vector<LaminateTerm::Element> laminates;
    // Neighbours in memory are neighbours in space, whatever order the mesh came in.
    for (const int t : spatial_order(mesh)) {
        const auto p = layout_corners(mesh, t);
        const std::array<Vec2, 3> relaxed = {relax * p[0], relax * p[1], relax * p[2]};
        if (input.print[t].bare()) {
            bare.push_back(t);
            membranes.push_back({mesh.triangles[t], relaxed});
            continue;
        }
        Mat2 layout_edges;
        layout_edges << p[1] - p[0], p[2] - p[0];
        const Mat2 fabric_edges = relax * layout_edges;
        printed.push_back(t);
        laminates.push_back({mesh.triangles[t],
                             p,
                             roles.sides[t],
                             plies(input, input.print[t], layout_edges.transpose() * layout_edges,
                                   fabric_edges.transpose() * fabric_edges),
                             {}});
        if (input.options.fabric_ply == FabricPlyLaw::same_law) {
            LaminateTerm::Element& element = laminates.back();
            element.fabric = {element.plies[0].z0, element.plies[0].z1, p, relaxed};
            element.plies.erase(element.plies.begin());
        }
    }
    membrane =
        std::make_shared<TermAssembly<FabricMembrane>>(FabricMembrane(law(), m.fabric_thickness, membranes));
    bending = std::make_shared<TermAssembly<FabricBending>>(FabricBending(roles.hinges));
    rod_edges = std::make_shared<TermAssembly<RodEdge>>(RodEdge(std::move(rods.edges)));
    rod_joints = std::make_shared<TermAssembly<RodJoint>>(RodJoint(std::move(rods.joints)));
    laminate = std::make_shared<TermAssembly<LaminateTerm>>(
        LaminateTerm(m.laminate_poissons_ratio, laminates, law()));
}

void Model::Parts::build_loads() {
    const TriangleMesh& mesh = input.mesh;
    const Material& m = input.material;
    constexpr double tonne_per_mm2 = 1e-9;   // of 1 kg/m^2
    constexpr double tonne_per_mm3 = 1e-12;  // of 1 kg/m^3
    const double relaxed_share = 1.0 / (input.prestretch[0] * input.prestretch[1]);
    std::vector<AreaMass> masses;
    std::vector<AreaMass> areas;
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        const double area = layout_area(mesh, t);
        const double plastic = input.print[t].front + input.print[t].back;
        const double per_area = m.fabric_areal_density * tonne_per_mm2 * relaxed_share +
                                m.plastic_density * tonne_per_mm3 * plastic;
        masses.push_back({mesh.triangles[t], area * per_area});
        areas.push_back({mesh.triangles[t], area});
    }
    const Vec3 gravity(input.gravity[0], input.gravity[1], input.gravity[2]);
    Eigen::VectorXd mass = lumped_mass(mesh.vertex_count(), masses);
    for (const Rod& rod : input.rods) {
        for (std::size_t k = 0; k + 1 < rod.vertices.size(); ++k) {
            const int a = rod.vertices[k];
            const int b = rod.vertices[k + 1];
            const double volume = rod.width * rod.thickness * (mesh.vertices[b] - mesh.vertices[a]).norm();
            for (const int v : {a, b}) mass[v] += 0.5 * m.plastic_density * tonne_per_mm3 * volume;
        }
    }
    dead_load = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(mesh.vertex_count()));
    for (int v = 0; v < mesh.vertex_count(); ++v) dead_load.segment<3>(3 * v) = mass[v] * gravity;
    for (const NodalForce& force : input.forces) dead_load.segment<3>(3 * force.vertex) += force.force;

    std::vector<double> stiffness;
    if (input.table.present) {
        const Eigen::VectorXd area = lumped_mass(mesh.vertex_count(), areas);
        stiffness.assign(area.begin(), area.end());
        for (double& k : stiffness) k *= input.table.stiffness_per_area;
    }
    const Vec3 up = gravity.norm() > 0.0 ? Vec3(-gravity.normalized()) : Vec3::UnitZ();
    table = std::make_shared<TermAssembly<TableContact>>(
        TableContact({.up = up, .height = input.table.height}, std::move(stiffness)));
}

void Model::Parts::build_contact(std::vector<ContactPair> pairs) {
    // Turns of a rolled sheet press on each other with 1e-3 to 1e-2 MPa; at half the distance it is 4.3 times
    // this pressure.
    constexpr double pressure = 0.01;  // MPa
    contact = std::make_shared<TermAssembly<ContactBarrier>>(
        ContactBarrier(pressure * input.options.contact_distance, std::move(pairs)));
}

void Model::Parts::build_pattern() {
    const NodePattern::Cliques cliques[] = {membrane->cliques(),  bending->cliques(),    laminate->cliques(),
                                            rod_edges->cliques(), rod_joints->cliques(), contact->cliques()};
    pattern = std::make_shared<NodePattern>(input.mesh.vertex_count(), static_cast<int>(edge_unknowns.size()),
                                            cliques);
    const auto prepare = [&]<class T>(std::shared_ptr<const TermAssembly<T>>& term) {
        auto prepared = std::make_shared<TermAssembly<T>>(term->term());
        prepared->prepare(pattern);
        term = std::move(prepared);
    };
    prepare(membrane), prepare(bending), prepare(laminate), prepare(rod_edges), prepare(rod_joints);
    prepare(table), prepare(contact);
}

Model::Model(ModelInput input) : parts_(std::make_unique<Parts>()) {
    if (input.print.empty()) input.print.resize(input.mesh.triangles.size());
    check(input);
    parts_->input = std::move(input);
    parts_->edges = find_edges(parts_->input.mesh);
    parts_->build_elastic_terms();
    parts_->build_loads();
    parts_->build_contact({});
    parts_->build_pattern();
}

Model::~Model() = default;
Model::Model(Model&&) noexcept = default;
Model& Model::operator=(Model&&) noexcept = default;

Model::Model(const Model& other) : parts_(std::make_unique<Parts>(*other.parts_)) {}

Model Model::with_log_extension(double log_extension) const {
    Model other(*this);
    Parts& parts = *other.parts_;
    parts.input.options.log_extension = log_extension;
    check(parts.input);
    auto membrane = std::make_shared<TermAssembly<FabricMembrane>>(*parts.membrane);
    membrane->exchange(parts.membrane->term().with_law(parts.law()));
    parts.membrane = std::move(membrane);
    if (!parts.laminate->term().has_fabric_law()) return other;
    auto laminate = std::make_shared<TermAssembly<LaminateTerm>>(*parts.laminate);
    laminate->exchange(parts.laminate->term().with_law(parts.law()));
    parts.laminate = std::move(laminate);
    return other;
}

int Model::size() const { return parts_->pattern->unknown_count(); }
int Model::vertex_count() const { return parts_->input.mesh.vertex_count(); }
const ModelInput& Model::input() const { return parts_->input; }
const MeshEdges& Model::edges() const { return parts_->edges; }
const NodePattern& Model::pattern() const { return *parts_->pattern; }
std::array<int, 4> Model::vertices_of_edge_unknown(int k) const { return parts_->edge_unknowns[k]; }

void Model::set_contacts(std::vector<ContactPair> pairs) {
    parts_->build_contact(std::move(pairs));
    parts_->build_pattern();
}
const std::vector<ContactPair>& Model::contacts() const { return parts_->contact->term().pairs(); }

Eigen::VectorXd Model::initial() const {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(size());
    for (int v = 0; v < vertex_count(); ++v) x.segment<2>(3 * v) = parts_->input.mesh.vertices[v];
    return x;
}

void Model::unwind(Eigen::VectorXd& x) const { parts_->laminate->term().unwind(x, vertex_count()); }

EnergyTerms Model::evaluate_fabric(const Eigen::VectorXd& x, Order order, AssembledSums& sums) const {
    const Unknowns unknowns = parts_->unknowns(x);
    if (order != Order::value) sums.gradient.setZero(size());
    if (order.wants_hessian()) sums.hessian.assign(parts_->pattern->row_index().size(), 0.0);
    EnergyTerms terms;
    terms.fabric_membrane = parts_->membrane->add(unknowns, order, sums);
    terms.fabric_bending = parts_->bending->add(unknowns, order, sums);
    return terms;
}

EnergyTerms Model::evaluate(const Eigen::VectorXd& x, Order order, AssembledSums& sums) const {
    const Unknowns unknowns = parts_->unknowns(x);
    EnergyTerms terms = evaluate_fabric(x, order, sums);
    terms.plastic = parts_->laminate->add(unknowns, order, sums);
    terms.plastic += parts_->rod_edges->add(unknowns, order, sums);
    terms.plastic += parts_->rod_joints->add(unknowns, order, sums);
    terms.gravity = parts_->table->add(unknowns, order, sums);
    terms.contact = parts_->contact->add(unknowns, order, sums);
    const Eigen::Index positions = parts_->dead_load.size();
    terms.gravity -= parts_->dead_load.dot(x.head(positions));
    if (order != Order::value) sums.gradient.head(positions) -= parts_->dead_load;
    return terms;
}

EnergyTerms Model::energy_terms(const Eigen::VectorXd& x) const {
    AssembledSums none;
    return evaluate(x, Order::value, none);
}

Eigen::VectorXd Model::gradient(const Eigen::VectorXd& x) const {
    AssembledSums sums;
    evaluate(x, Order::gradient, sums);
    return sums.gradient;
}

Eigen::SparseMatrix<double> Model::hessian(const Eigen::VectorXd& x) const {
    AssembledSums sums;
    evaluate(x, Order::hessian, sums);
    return parts_->pattern->full_matrix(sums.hessian);
}

std::vector<double> Model::energy_density(const Eigen::VectorXd& x) const {
    const Unknowns unknowns = parts_->unknowns(x);
    std::vector<double> density(parts_->input.mesh.triangles.size(), 0.0);
    const auto fill = [&](const auto& term, const std::vector<int>& triangle) {
        for (int e = 0; e < term.element_count(); ++e) {
            density[triangle[e]] =
                term.evaluate(e, unknowns, Order::value).value / layout_area(parts_->input.mesh, triangle[e]);
        }
    };
    fill(parts_->membrane->term(), parts_->bare);
    fill(parts_->laminate->term(), parts_->printed);
    return density;
}

}  // namespace ruche
