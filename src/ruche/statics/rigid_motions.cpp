#include "ruche/statics/rigid_motions.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>

#include "ruche/core/error.hpp"

namespace ruche {
namespace {

/// Columns: the rigid motions (three translations, three rotations about `centre` scaled by `size`) at a
/// point.
using PointMotions = Eigen::Matrix<double, 3, Eigen::Dynamic>;
PointMotions rigid_motions_at(const Vec3& point, const Vec3& centre, double size) {
    PointMotions motions(3, 6);
    motions.leftCols<3>() = Mat3::Identity();
    for (int axis = 0; axis < 3; ++axis)
        motions.col(3 + axis) = Vec3::Unit(axis).cross(point - centre) / size;
    return motions;
}

/// Orthonormal basis of the combinations that `rows` maps to zero.
Eigen::MatrixXd null_space(const Eigen::MatrixXd& rows) {
    if (rows.rows() == 0) return Eigen::MatrixXd::Identity(rows.cols(), rows.cols());
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeFullV);
    const double threshold = 1e-9 * std::max(1.0, svd.singularValues().maxCoeff());
    const Eigen::Index rank = (svd.singularValues().array() > threshold).count();
    return svd.matrixV().rightCols(rows.cols() - rank);
}

}  // namespace

RigidMotions::RigidMotions(const Model& model) {
    const ModelInput& input = model.input();
    const MeshPieces pieces = find_pieces(input.mesh);
    pieces_.resize(pieces.count);
    for (int v = 0; v < input.mesh.vertex_count(); ++v) {
        if (pieces.of_vertex[v] >= 0) pieces_[pieces.of_vertex[v]].vertices.push_back(v);
    }
    for (const Support& support : input.supports) {
        if (pieces.of_vertex[support.vertex] >= 0)
            pieces_[pieces.of_vertex[support.vertex]].supports.push_back(support);
    }
    gravity_ = Vec3(input.gravity[0], input.gravity[1], input.gravity[2]);
    for (const NodalForce& force : input.forces) {
        if (pieces.of_vertex[force.vertex] >= 0)
            pieces_[pieces.of_vertex[force.vertex]].forces.push_back(force);
    }
    table_ = input.table.present;
}

std::vector<GaugeDirection> RigidMotions::gauge(const Eigen::VectorXd& x, Resisting resisting) const {
    std::vector<GaugeDirection> result;
    const auto at = [&](int v) -> Vec3 { return x.segment<3>(3 * static_cast<Eigen::Index>(v)); };
    for (const Piece& piece : pieces_) {
        Vec3 centre = Vec3::Zero();
        for (const int v : piece.vertices) centre += at(v) / static_cast<double>(piece.vertices.size());
        const auto farthest = [&](auto&& distance) {
            int best = piece.vertices.front();
            for (const int v : piece.vertices) {
                if (distance(at(v)) > distance(at(best))) best = v;
            }
            return best;
        };
        const int first = farthest([&](const Vec3& p) { return (p - centre).norm(); });
        const int second = farthest([&](const Vec3& p) { return (p - at(first)).norm(); });
        const Vec3 line = (at(second) - at(first)).normalized();
        const int third = farthest([&](const Vec3& p) { return (p - at(first)).cross(line).norm(); });
        const double size = std::max(1e-300, (at(first) - centre).norm());

        // What the supports, the table and gravity resist.
        std::vector<Eigen::RowVectorXd> resisted;
        for (const Support& support : piece.supports) {
            const PointMotions motions = rigid_motions_at(at(support.vertex), centre, size);
            for (int c = 0; c < 3; ++c) {
                if (support.fixed[c]) resisted.emplace_back(motions.row(c));
            }
        }
        const bool loads = resisting == Resisting::supports_and_loads;
        const bool heavy = gravity_.norm() > 0.0;
        if (loads && (heavy || table_)) {
            // Height, and rotations about horizontal axes.
            const Vec3 up = heavy ? Vec3(-gravity_.normalized()) : Vec3::UnitZ();
            Eigen::RowVectorXd height = Eigen::RowVectorXd::Zero(6);
            height.head<3>() = up.transpose();
            resisted.push_back(height);
            const Mat3 horizontal = Mat3::Identity() - up * up.transpose();
            for (int axis = 0; axis < 3; ++axis) {
                Eigen::RowVectorXd tilt = Eigen::RowVectorXd::Zero(6);
                tilt.tail<3>() = horizontal.row(axis);
                resisted.push_back(tilt);
            }
        }
        // Dead forces resist the rotations on whose second variation they do work: sum (f.x) I - sym(x f^T).
        Mat3 stiffness = Mat3::Zero();
        for (const NodalForce& load : piece.forces) {
            const Vec3 arm = at(load.vertex) - centre;
            const Mat3 outer = arm * load.force.transpose();
            stiffness += arm.dot(load.force) * Mat3::Identity() - 0.5 * (outer + outer.transpose());
        }
        if (loads && stiffness.norm() > 0.0) {
            stiffness /= stiffness.norm();
            for (int axis = 0; axis < 3; ++axis) {
                Eigen::RowVectorXd turn = Eigen::RowVectorXd::Zero(6);
                turn.tail<3>() = stiffness.row(axis);
                resisted.push_back(turn);
            }
        }
        Eigen::MatrixXd rows(resisted.size(), 6);
        for (std::size_t i = 0; i < resisted.size(); ++i)
            rows.row(static_cast<Eigen::Index>(i)) = resisted[i];
        Eigen::MatrixXd free = null_space(rows);

        for (const int v : {first, second, third}) {
            if (free.cols() == 0) break;
            const Eigen::MatrixXd moved = rigid_motions_at(at(v), centre, size) * free;
            const Eigen::JacobiSVD<Eigen::MatrixXd> svd(moved, Eigen::ComputeFullU | Eigen::ComputeFullV);
            const Eigen::Index rank = (svd.singularValues().array() > 1e-6).count();
            for (Eigen::Index k = 0; k < rank; ++k) result.push_back({v, svd.matrixU().col(k)});
            free = (free * svd.matrixV().rightCols(free.cols() - rank)).eval();
        }
    }
    return result;
}

void RigidMotions::hold(const NodePattern& pattern, const Eigen::VectorXd& x, Resisting resisting,
                        std::vector<double>& hessian) const {
    for (const GaugeDirection& gauge : gauge(x, resisting)) {
        const int at = pattern.block_offset(gauge.vertex, gauge.vertex);
        const int length = pattern.column_length(gauge.vertex);
        const double stiffness =
            (hessian[at] + hessian[at + length + 1] + hessian[at + 2 * length + 2]) / 3.0;
        for (int c = 0; c < 3; ++c) {
            for (int r = 0; r < 3; ++r)
                hessian[at + c * length + r] += stiffness * gauge.direction[r] * gauge.direction[c];
        }
    }
}

void require_held(const Model& model) {
    const ModelInput& input = model.input();
    const Vec3 gravity(input.gravity[0], input.gravity[1], input.gravity[2]);
    if (gravity.norm() == 0.0 || input.table.present) return;
    const MeshPieces pieces = find_pieces(input.mesh);
    std::vector<char> held(pieces.count, 0);
    for (const Support& support : input.supports) {
        if (pieces.of_vertex[support.vertex] >= 0) held[pieces.of_vertex[support.vertex]] = 1;
    }
    for (const char h : held) {
        if (!h) {
            throw InputError(
                {.key = "gravity"}, "a piece of the sheet would fall for ever: nothing holds it",
                "Add a [[support]], put it on a table (gravity.table = true), or remove gravity.");
        }
    }
}

}  // namespace ruche
