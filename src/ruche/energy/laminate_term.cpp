#include "ruche/energy/laminate_term.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cassert>
#include <cmath>
#include <numbers>

namespace ruche {
namespace {

/// Where the corners of the two triangles at edge i stand among an element's vertices, in the order edge
/// start, edge end, opposite corner.
constexpr std::array<int, 3> own_slot[3] = {{1, 2, 0}, {2, 0, 1}, {0, 1, 2}};
constexpr std::array<int, 3> flap_slot[3] = {{2, 1, 3}, {0, 2, 4}, {1, 0, 5}};

/// (a11, a12, a22, b11, b12, b22) from (L0, L1, L2, c0, c1, c2).
FormMatrix forms_of_strains() {
    FormMatrix t = FormMatrix::Zero();
    t(0, 2) = 1.0;
    t(1, 0) = -0.5;
    t(1, 1) = 0.5;
    t(1, 2) = 0.5;
    t(2, 1) = 1.0;
    t(3, 3) = 2.0;
    t(3, 4) = 2.0;
    t(4, 3) = 2.0;
    t(5, 3) = 2.0;
    t(5, 5) = 2.0;
    return t;
}

/// Replaces variable `index` of a quadratic energy by the value of least energy.
void eliminate(int index, FormMatrix& quadratic, FormVector& linear, double& constant) {
    const double pivot = quadratic(index, index);
    const FormVector column = quadratic.col(index);
    constant -= 0.5 * linear[index] * linear[index] / pivot;
    linear -= column * (linear[index] / pivot);
    quadratic -= column * column.transpose() / pivot;
    linear[index] = 0.0;
    quadratic.row(index).setZero();
    quadratic.col(index).setZero();
}

}  // namespace

LaminateTerm::LaminateTerm(double poissons_ratio, const std::vector<Element>& elements, const FabricLaw& law)
    : law_(law) {
    const FormMatrix to_forms = forms_of_strains();
    elements_.reserve(elements.size());
    for (const Element& element : elements) {
        const auto& p = element.layout;
        const Vec2 e1 = p[1] - p[0];
        const Vec2 e2 = p[2] - p[0];
        Mat2 layout_metric;
        layout_metric << e1.squaredNorm(), e1.dot(e2), e1.dot(e2), e2.squaredNorm();
        const LaminateForm form = laminate_form(element.plies, poissons_ratio, layout_metric);
        Prepared prepared;
        prepared.layout_lengths = {(p[2] - p[1]).squaredNorm(), e2.squaredNorm(), e1.squaredNorm()};
        // The triangle is half of the parametric unit square.
        prepared.quadratic = 0.5 * (to_forms.transpose() * form.quadratic * to_forms);
        prepared.linear = 0.5 * (to_forms.transpose() * form.linear);
        prepared.constant = 0.5 * form.constant;
        for (int i = 0; i < 3; ++i) {
            const EdgeSide& side = element.sides[i];
            const bool hinged = side.kind == EdgeSide::Kind::hinged;
            const bool open = side.kind == EdgeSide::Kind::open_rim;
            prepared.nodes[i] = element.vertices[i];
            prepared.nodes[3 + i] = hinged ? side.flap : -1;
            prepared.nodes[6 + i] = hinged || open ? side.unknown : -1;
            prepared.y_to_xi[i] = open ? 1.0 : 0.0;
            if (hinged && side.unknown >= 0) prepared.y_to_xi[i] = side.sign / side.mean_altitude;
            if (side.kind == EdgeSide::Kind::free_rim) {
                eliminate(3 + i, prepared.quadratic, prepared.linear, prepared.constant);
            }
        }
        elements_.push_back(prepared);
        if (element.fabric) fabric_.emplace_back(*element.fabric);
    }
    assert(fabric_.empty() || fabric_.size() == elements_.size());
}

struct LaminateTerm::Kinematics {
    Corners v;
    std::array<bool, 3> hinged;
    std::array<DihedralFrame, 3> own;   // of this triangle at edge i: corners (i+1, i+2, i)
    std::array<DihedralFrame, 3> flap;  // of the neighbour: corners (i+2, i+1, flap)
    Vec3 lengths;                       // L
    Vec3 altitude = Vec3::Zero();       // h_i
    Vec3 phi = Vec3::Zero();            // theta_i/2 +- xi_i
    Vec3 rim = Vec3::Zero();            // c_i of an open rim; 0 of a clamped one, any of a free one

    FormVector strain(const Vec3& layout_lengths) const {
        FormVector strain;
        strain.head<3>() = lengths - layout_lengths;
        for (int i = 0; i < 3; ++i) strain[3 + i] = hinged[i] ? altitude[i] * std::sin(phi[i]) : rim[i];
        return strain;
    }
};

LaminateTerm::Kinematics LaminateTerm::kinematics(const Prepared& e, const Unknowns& x) const {
    Kinematics k;
    k.v = {x.position(e.nodes[0]), x.position(e.nodes[1]), x.position(e.nodes[2])};
    k.lengths = squared_edge_lengths(k.v);
    const Vec3 cross = (k.v[1] - k.v[0]).cross(k.v[2] - k.v[0]);
    const double twice_area = cross.norm();
    const Vec3 normal = (1.0 / twice_area) * cross;
    for (int i = 0; i < 3; ++i) {
        k.hinged[i] = e.nodes[3 + i] >= 0;
        const double y = e.nodes[6 + i] >= 0 ? x.edge_unknown(e.nodes[6 + i] - x.vertex_count) : 0.0;
        if (!k.hinged[i]) {
            k.rim[i] = y;
            continue;
        }
        const Vec3& start = k.v[(i + 1) % 3];
        const Vec3& end = k.v[(i + 2) % 3];
        k.own[i] = dihedral_frame(start, end, k.v[i], normal, twice_area);
        k.flap[i] = dihedral_frame(end, start, x.position(e.nodes[3 + i]));
        k.altitude[i] = k.own[i].h;
        k.phi[i] = 0.5 * dihedral_angle(k.own[i], k.flap[i]) + e.y_to_xi[i] * y;
    }
    return k;
}

double LaminateTerm::max_normal_rotation(int element, const Unknowns& x) const {
    return kinematics(elements_[element], x).phi.cwiseAbs().maxCoeff();
}

void LaminateTerm::unwind(Eigen::VectorXd& x, int vertex_count) const {
    constexpr double turn = 2.0 * std::numbers::pi;
    for (const Prepared& e : elements_) {
        for (int i = 0; i < 3; ++i) {
            if (e.nodes[3 + i] < 0 || e.nodes[6 + i] < 0) continue;
            double& y = x[e.nodes[6 + i] + 2 * vertex_count];
            y -= std::round(y * e.y_to_xi[i] / turn) * turn / e.y_to_xi[i];
        }
    }
}

std::array<Vec3, FabricPly::points> LaminateTerm::fabric_strains(int element, const Unknowns& x) const {
    const Prepared& e = elements_[element];
    const FormVector strain = kinematics(e, x).strain(e.layout_lengths);
    std::array<Vec3, FabricPly::points> strains;
    for (int q = 0; q < FabricPly::points; ++q) strains[q] = fabric_[element].green_strain(q, strain);
    return strains;
}

Local<21> LaminateTerm::evaluate(int element, const Unknowns& x, Order order) const {
    const Prepared& e = elements_[element];
    const Kinematics k = kinematics(e, x);
    const FormVector strain = k.strain(e.layout_lengths);
    const FormVector pull = e.quadratic * strain;
    Local<21> local(order);
    local.value = e.constant + strain.dot(e.linear + 0.5 * pull);
    if (!has_fabric_law()) {
        if (order != Order::value) differentiate(e, k, {strain, e.linear + pull, e.quadratic}, order, local);
        return local;
    }
    const FabricPly::Response fabric = fabric_[element].evaluate(law_, strain, order);
    local.value += fabric.energy;
    if (order != Order::value && std::isfinite(local.value))
        differentiate(e, k, {strain, e.linear + pull + fabric.stress, e.quadratic + fabric.tangent}, order,
                      local);
    return local;
}

void LaminateTerm::differentiate(const Prepared& e, const Kinematics& k, const StrainResponse& response,
                                 Order order, Local<21>& local) {
    // Derivatives in the strain space (L, phi). h_i = 2A / sqrt(L_i), 16 A^2 = 2 (L0 L1 + L1 L2 + L2 L0) -
    // sum L^2, so with p_j = d(16 A^2)/dL_j: d ln h_i / dL_j = g_ij = p_j / (32 A^2) - delta_ij / (2 L_i).
    const FormVector& stress = response.stress;
    const Vec3 moment = stress.tail<3>();  // dW/dc
    const double sum = k.lengths.sum();
    const Vec3 p = Vec3::Constant(2.0 * sum) - 4.0 * k.lengths;
    // 16 A^2 from the cross product: from the lengths it cancels in thin triangles.
    const double area16 = 4.0 * (k.v[1] - k.v[0]).cross(k.v[2] - k.v[0]).squaredNorm();
    Mat3 log_slope = Mat3::Zero();  // g, row i: edge i
    const Vec3 c = response.strain.tail<3>();
    Vec3 c_phi = Vec3::Zero();  // dc_i/dphi_i; an open rim has its c_i in the place of phi_i
    for (int i = 0; i < 3; ++i) {
        if (!k.hinged[i]) {
            c_phi[i] = e.y_to_xi[i];
            continue;
        }
        log_slope.row(i) = (p / (2.0 * area16)).transpose();
        log_slope(i, i) -= 0.5 / k.lengths[i];
        c_phi[i] = k.altitude[i] * std::cos(k.phi[i]);
    }
    const Mat3 c_lengths = c.asDiagonal() * log_slope;  // dc_i/dL_j
    FormVector slopes;
    slopes.head<3>() = stress.head<3>() + c_lengths.transpose() * moment;
    slopes.tail<3>() = c_phi.cwiseProduct(moment);

    // d(L, phi) by the element's own corners; beyond them phi_i depends on one flap and one edge unknown
    // alone.
    Eigen::Matrix<double, 9, 6> measures = Eigen::Matrix<double, 9, 6>::Zero();
    measures.leftCols<3>() = edge_length_gradient(k.v).transpose();
    Mat3 flap_slope = Mat3::Zero();  // column i: dphi_i by flap i
    for (int i = 0; i < 3; ++i) {
        local.gradient[18 + i] = slopes[3 + i] * e.y_to_xi[i];
        if (!k.hinged[i]) continue;
        for (int j = 0; j < 3; ++j)
            measures.block<3, 1>(3 * own_slot[i][j], 3 + i) += 0.5 * k.own[i].gradient(j);
        for (int j = 0; j < 2; ++j)
            measures.block<3, 1>(3 * flap_slot[i][j], 3 + i) += 0.5 * k.flap[i].gradient(j);
        flap_slope.col(i) = 0.5 * k.flap[i].gradient(2);
        local.gradient.segment<3>(9 + 3 * i) = slopes[3 + i] * flap_slope.col(i);
    }
    local.gradient.head<9>() = measures.lazyProduct(slopes);
    if (!order.wants_hessian()) return;

    const double exact = order.exact_share();
    FormMatrix jacobian = FormMatrix::Identity();  // d(L, c)/d(L, phi)
    jacobian.bottomLeftCorner<3, 3>() = c_lengths;
    jacobian.bottomRightCorner<3, 3>() = c_phi.asDiagonal();
    FormMatrix in_measures = jacobian.transpose() * response.tangent * jacobian;
    if (order != Order::gauss_newton) {
        // Second derivatives of c_i = h_i(L) sin(phi_i), weighted with the moments:
        // d2 h_i / h_i = g g^T + dg,  dg_jk = d2(16A^2)_jk / (32 A^2) - p_j p_k / (2 (16A^2)^2) + delta_ijk /
        // (2 L_i^2).
        Mat3 area_curvature = Mat3::Constant(2.0);
        area_curvature.diagonal().setConstant(-2.0);
        const Mat3 log_curvature =
            area_curvature / (2.0 * area16) - p * p.transpose() / (2.0 * area16 * area16);
        for (int i = 0; i < 3; ++i) {
            if (!k.hinged[i]) continue;
            const double exact_moment = exact * moment[i];
            const Vec3 g = log_slope.row(i).transpose();
            Mat3 second = g * g.transpose() + log_curvature;
            second(i, i) += 0.5 / (k.lengths[i] * k.lengths[i]);
            in_measures.topLeftCorner<3, 3>() += exact_moment * c[i] * second;
            in_measures.block<3, 1>(0, 3 + i) += exact_moment * c_phi[i] * g;
            in_measures.block<1, 3>(3 + i, 0) += exact_moment * c_phi[i] * g.transpose();
            in_measures(3 + i, 3 + i) -= exact_moment * c[i];
        }
    }
    const Eigen::Matrix<double, 9, 6> weighted = measures.lazyProduct(in_measures);
    for (int m = 0; m < 6; ++m) add_lower_product<9>(weighted.col(m), measures.col(m), local.hessian);
    for (int i = 0; i < 3; ++i) {
        local.hessian.block<3, 9>(9 + 3 * i, 0) = flap_slope.col(i) * weighted.col(3 + i).transpose();
        local.hessian.block<1, 9>(18 + i, 0) = e.y_to_xi[i] * weighted.col(3 + i).transpose();
        for (int j = 0; j < 3; ++j) {
            const double both = in_measures(3 + i, 3 + j);
            if (j <= i) {
                local.hessian.block<3, 3>(9 + 3 * i, 9 + 3 * j) =
                    (both * flap_slope.col(i)) * flap_slope.col(j).transpose();
                local.hessian(18 + i, 18 + j) = both * e.y_to_xi[i] * e.y_to_xi[j];
            }
            local.hessian.block<1, 3>(18 + i, 9 + 3 * j) =
                (both * e.y_to_xi[i]) * flap_slope.col(j).transpose();
        }
    }
    if (order == Order::gauss_newton) return;

    slopes *= exact;
    add_edge_length_curvature(slopes.head<3>(), local.hessian);
    for (int i = 0; i < 3; ++i) {
        if (!k.hinged[i]) continue;
        k.own[i].add_second_derivative(0.5 * slopes[3 + i], own_slot[i], local.hessian);
        k.flap[i].add_second_derivative(0.5 * slopes[3 + i], flap_slot[i], local.hessian);
    }
}

}  // namespace ruche
