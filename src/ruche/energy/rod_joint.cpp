#include "ruche/energy/rod_joint.hpp"

#include <algorithm>
#include <cmath>

namespace ruche {
namespace {

using Vector = Eigen::Matrix<double, 23, 1>;
using Vec4 = Eigen::Vector4d;
using Mat4 = Eigen::Matrix4d;

/// Among an element's vertices, those of edge `e`: start, end, left corner, right corner.
constexpr std::array<int, 4> edge_slot[2] = {{0, 1, 3, 4}, {1, 2, 5, 6}};

/// The frame of an edge and what its derivatives need.
struct Frame {
    DihedralFrame left, right;
    double length;  // current
    Vec3 t, m, n;
};

Frame frame_of(const RodJoint::Element& joint, int e, const Unknowns& x) {
    const Vec3 a = x.position(joint.vertices[e]);
    const Vec3 b = x.position(joint.vertices[e + 1]);
    Frame f{dihedral_frame(a, b, x.position(joint.corners[e][0])),
            dihedral_frame(b, a, x.position(joint.corners[e][1])),
            (b - a).norm(),
            {},
            {},
            {}};
    // The mean normal is the left one turned by -theta/2.
    const double phi = joint.signs[e] * x.edge_unknown(joint.unknowns[e] - x.vertex_count) / joint.lengths[e];
    const double turn = phi - 0.5 * dihedral_angle(f.left, f.right);
    f.t = f.left.e;
    f.n = std::cos(turn) * f.left.n - std::sin(turn) * f.left.u;
    f.m = f.n.cross(f.t);
    return f;
}

/// Unit quaternion (w, v) of the rotation that takes the first frame to the second, in components of either.
Vec4 relative_rotation(const Frame& first, const Frame& second) {
    Mat3 r0;
    Mat3 r1;
    r0 << first.t, first.m, first.n;
    r1 << second.t, second.m, second.n;
    const Mat3 d = r0.transpose() * r1;
    const double w = 0.5 * std::sqrt(std::max(0.0, 1.0 + d.trace()));
    const Vec3 axial(d(2, 1) - d(1, 2), d(0, 2) - d(2, 0), d(1, 0) - d(0, 1));
    Vec4 q;
    q << w, axial / (4.0 * w);
    return q;
}

/// The product of quaternions p q as a matrix on q, and as one on p.
Mat4 left_product(const Vec4& p) {
    Mat4 m;
    m << p[0], -p[1], -p[2], -p[3],  //
        p[1], p[0], -p[3], p[2],     //
        p[2], p[3], p[0], -p[1],     //
        p[3], -p[2], p[1], p[0];
    return m;
}
Mat4 right_product(const Vec4& q) {
    Mat4 m;
    m << q[0], -q[1], -q[2], -q[3],  //
        q[1], q[0], q[3], -q[2],     //
        q[2], -q[3], q[0], q[1],     //
        q[3], q[2], -q[1], q[0];
    return m;
}

/// How a frame turns with the element's unknowns, to first order: `spin` about t (psi), and the direction of
/// the edge along t, m, n (rho = (db - da) / length).
struct Motion {
    Vector spin = Vector::Zero();
    std::array<Vector, 3> rho = {Vector::Zero(), Vector::Zero(), Vector::Zero()};
};

Motion motion_of(const Frame& f, int e, double y_to_phi) {
    Motion motion;
    const auto& slot = edge_slot[e];
    const std::array<int, 3> left_slot = {slot[0], slot[1], slot[2]};
    const std::array<int, 3> right_slot = {slot[1], slot[0], slot[3]};
    for (int i = 0; i < 3; ++i) {
        // A triangle's part of d theta is its normal's turn about the edge; the right one counts it about -t.
        motion.spin.segment<3>(3 * left_slot[i]) += 0.5 * f.left.gradient(i);
        motion.spin.segment<3>(3 * right_slot[i]) -= 0.5 * f.right.gradient(i);
    }
    motion.spin[21 + e] = y_to_phi;
    const std::array<const Vec3*, 3> axes = {&f.t, &f.m, &f.n};
    for (int k = 0; k < 3; ++k) {
        motion.rho[k].segment<3>(3 * slot[0]) = -*axes[k] / f.length;
        motion.rho[k].segment<3>(3 * slot[1]) = *axes[k] / f.length;
    }
    return motion;
}

/// a b^T + b a^T.
void add_symmetric(double weight, const Vector& a, const Vector& b, Eigen::Matrix<double, 23, 23>& h) {
    h.noalias() += (weight * a) * b.transpose();
    h.noalias() += (weight * b) * a.transpose();
}

/// Second derivatives of a frame's rotation vector omega = (psi, -tau_n + psi tau_m / 2, tau_m + psi tau_n /
/// 2), tau_k = rho_k - rho_k rho_t, weighted with dW/domega. Exact: exp(omega) is the minimal rotation that
/// carries t along, after the turn by psi about it, to second order (Baker, Campbell, Hausdorff).
void add_rotation_curvature(const Vec3& slope, const Frame& f, const Motion& motion, int e,
                            Eigen::Matrix<double, 23, 23>& h) {
    const auto& [t, m, n] = motion.rho;
    add_symmetric(0.5 * slope[1], motion.spin, m, h);
    add_symmetric(0.5 * slope[2], motion.spin, n, h);
    add_symmetric(slope[1], n, t, h);
    add_symmetric(-slope[2], m, t, h);
    const auto& slot = edge_slot[e];
    f.left.add_second_derivative(0.5 * slope[0], {slot[0], slot[1], slot[2]}, h);
    f.right.add_second_derivative(-0.5 * slope[0], {slot[1], slot[0], slot[3]}, h);
}

}  // namespace

std::array<int, 9> RodJoint::nodes(int element) const {
    const Element& j = elements_[element];
    return {j.vertices[0],   j.vertices[1],   j.vertices[2], j.corners[0][0], j.corners[0][1],
            j.corners[1][0], j.corners[1][1], j.unknowns[0], j.unknowns[1]};
}

Vec3 RodJoint::strain(int element, const Unknowns& x) const {
    const Element& joint = elements_[element];
    const Vec4 q = relative_rotation(frame_of(joint, 0, x), frame_of(joint, 1, x));
    return 2.0 / q[0] * q.tail<3>();
}

Local<23> RodJoint::evaluate(int element, const Unknowns& x, Order order) const {
    const Element& joint = elements_[element];
    const std::array<Frame, 2> frames = {frame_of(joint, 0, x), frame_of(joint, 1, x)};
    const Vec4 q = relative_rotation(frames[0], frames[1]);
    const double w = q[0];
    const Vec3 kappa = 2.0 / w * q.tail<3>();
    const Vec3 stiffness = joint.stiffness * (2.0 / (joint.lengths[0] + joint.lengths[1]));
    const Vec3 moment = stiffness.cwiseProduct(kappa - joint.rest);
    Local<23> local(order);
    local.value = 0.5 * moment.dot(kappa - joint.rest);
    if (order == Order::value || !std::isfinite(local.value)) return local;

    // By turns of the frames: q becomes exp(-omega_0 / 2) q exp(omega_1 / 2), omega in components of the
    // frames.
    Eigen::Matrix<double, 3, 4> kappa_q;  // d kappa / dq
    kappa_q << -kappa / w, 2.0 / w * Mat3::Identity();
    const Mat4 times_q = right_product(q);
    const Mat4 q_times = left_product(q);
    Eigen::Matrix<double, 4, 6> q_omega;
    q_omega << -0.5 * times_q.rightCols<3>(), 0.5 * q_times.rightCols<3>();
    const Eigen::Matrix<double, 3, 6> kappa_omega = kappa_q * q_omega;
    const Eigen::Matrix<double, 6, 1> slopes = kappa_omega.transpose() * moment;

    const std::array<Motion, 2> motions = {motion_of(frames[0], 0, joint.signs[0] / joint.lengths[0]),
                                           motion_of(frames[1], 1, joint.signs[1] / joint.lengths[1])};
    Eigen::Matrix<double, 23, 6> omega;  // columns: d omega_0, d omega_1
    for (int e = 0; e < 2; ++e) {
        omega.col(3 * e) = motions[e].spin;
        omega.col(3 * e + 1) = -motions[e].rho[2];
        omega.col(3 * e + 2) = motions[e].rho[1];
    }
    local.gradient = omega * slopes;
    if (!order.wants_hessian()) return local;

    Eigen::Matrix<double, 6, 6> in_omega = kappa_omega.transpose() * stiffness.asDiagonal() * kappa_omega;
    if (order != Order::gauss_newton) {
        const Vec3 weighted_moment = order.exact_share() * moment;
        // moment . d2 kappa / dq2: kappa = 2 v / w.
        Mat4 kappa_curvature = Mat4::Zero();
        kappa_curvature(0, 0) = 2.0 * weighted_moment.dot(kappa) / (w * w);
        kappa_curvature.bottomLeftCorner<3, 1>() = -2.0 / (w * w) * weighted_moment;
        kappa_curvature.topRightCorner<1, 3>() = -2.0 / (w * w) * weighted_moment.transpose();
        in_omega += q_omega.transpose() * kappa_curvature * q_omega;
        // d2 q / domega_0 domega_1 = -e_i q e_j / 4; those by one frame alone are along q, where kappa is
        // constant.
        const Vec4 slope_q = kappa_q.transpose() * weighted_moment;
        Mat3 mixed;
        for (int j = 0; j < 3; ++j) {
            const Vec4 turned = q_times.col(1 + j);  // q e_j
            mixed.col(j) = -0.25 * right_product(turned).rightCols<3>().transpose() * slope_q;
        }
        in_omega.topRightCorner<3, 3>() += mixed;
        in_omega.bottomLeftCorner<3, 3>() += mixed.transpose();
    }
    local.hessian.noalias() = omega * in_omega * omega.transpose();
    if (order == Order::gauss_newton) return local;
    for (int e = 0; e < 2; ++e)
        add_rotation_curvature(order.exact_share() * slopes.segment<3>(3 * e), frames[e], motions[e], e,
                               local.hessian);
    return local;
}

}  // namespace ruche
