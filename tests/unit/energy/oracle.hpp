#pragma once

#include <array>
#include <cmath>
#include <span>

#include "energy/jet.hpp"
#include "ruche/energy/fabric_bending.hpp"
#include "ruche/energy/fabric_membrane.hpp"
#include "ruche/energy/laminate_term.hpp"
#include "ruche/energy/rod_edge.hpp"
#include "ruche/energy/rod_joint.hpp"
#include "ruche/material/material.hpp"

/// The energies of the theory page, each as one formula on a scalar type S (double or Jet): the oracle that
/// the product's hand-derived gradients and Hessians are compared with.
namespace ruche::test {

template <class S>
using Point = std::array<S, 3>;

template <class S>
Point<S> operator-(const Point<S>& a, const Point<S>& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class S>
Point<S> operator+(const Point<S>& a, const Point<S>& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <class S>
S dot(const Point<S>& a, const Point<S>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class S>
Point<S> cross(const Point<S>& a, const Point<S>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A symmetric 2x2 matrix.
template <class S>
struct Form {
    S m11, m12, m22;
};

/// Dihedral angle across a-b of the triangles (a, b, c), (b, a, d); positive when d rises to the front.
template <class S>
S dihedral(const Point<S>& a, const Point<S>& b, const Point<S>& c, const Point<S>& d) {
    using std::atan2;
    using std::sqrt;
    const Point<S> edge = b - a;
    const Point<S> left = cross(edge, c - a);
    const Point<S> right = cross(a - b, d - b);
    return atan2(dot(cross(right, left), edge) / sqrt(dot(edge, edge)), dot(left, right));
}

/// Psi~ of paper eqs 3-5 with the linear extension of the stress, MPa.
template <class S>
S fabric_density(const Form<S>& c, const Material& m, const FabricLaw::Options& options) {
    using std::log;
    const double nu = m.fabric_poissons_ratio;
    const double plane = 1.0 - nu * nu;
    const std::array<S, 2> strain = {0.5 * (c.m11 - 1.0), 0.5 * (c.m22 - 1.0)};
    const double shear = m.alpha_3 * (options.tensor_shear ? 0.5 : 1.0);
    S own = 0.5 / plane * (m.alpha_1 * (strain[0] * strain[0]) + m.alpha_2 * (strain[1] * strain[1])) +
            nu * std::sqrt(m.alpha_1 * m.alpha_2) / plane * (strain[0] * strain[1]) +
            0.5 * shear * (c.m12 * c.m12);
    const double beta[2] = {m.beta_1, m.beta_2};
    const double gamma[2] = {m.gamma_1, m.gamma_2};
    for (int i = 0; i < 2; ++i) {
        const double limit = gamma[i] - options.log_extension;
        if (!(strain[i] > limit)) {
            const S rest = gamma[i] - strain[i];
            own = own + beta[i] * (rest * log((1.0 / gamma[i]) * rest) + strain[i]);
            continue;
        }
        const double stress = -std::log(options.log_extension / gamma[i]);
        const S beyond = strain[i] - limit;
        own = own + beta[i] * (stress * beyond + 0.5 / options.log_extension * (beyond * beyond) +
                               (limit - options.log_extension * stress));
    }
    const double share = m.neo_hookean_share;
    if (share == 0.0) return own;
    const double lambda = m.fabric_youngs_modulus * nu / plane;
    const double mu = m.fabric_youngs_modulus / (2.0 * (1.0 + nu));
    const S log_j = 0.5 * log(c.m11 * c.m22 - c.m12 * c.m12);
    return (1.0 - share) * own +
           share * (0.5 * mu * (c.m11 + c.m22 - 2.0 - 2.0 * log_j) + 0.5 * lambda * (log_j * log_j));
}

struct FabricElement {
    std::array<Vec2, 3> relaxed;
    Material material;
    FabricLaw::Options options;

    template <class S>
    S energy(std::span<const S> x) const {
        Mat2 edges;
        edges << relaxed[1] - relaxed[0], relaxed[2] - relaxed[0];
        const Mat2 d = edges.inverse();
        const Point<S> v[3] = {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}, {x[6], x[7], x[8]}};
        Point<S> f[2];  // columns of F
        for (int i = 0; i < 3; ++i) {
            const S e1 = v[1][i] - v[0][i];
            const S e2 = v[2][i] - v[0][i];
            for (int j = 0; j < 2; ++j) f[j][i] = d(0, j) * e1 + d(1, j) * e2;
        }
        const double volume = material.fabric_thickness * 0.5 * edges.determinant();
        return volume *
               fabric_density<S>({dot(f[0], f[0]), dot(f[0], f[1]), dot(f[1], f[1])}, material, options);
    }
};

struct HingeElement {
    double stiffness;

    template <class S>
    S energy(std::span<const S> x) const {
        using std::tan;
        const S theta =
            dihedral<S>({x[0], x[1], x[2]}, {x[3], x[4], x[5]}, {x[6], x[7], x[8]}, {x[9], x[10], x[11]});
        const S t = tan(0.5 * theta);
        return 2.0 * stiffness * (t * t);
    }
};

/// Energy of a stack of plies for one triangle, its forms in the basis of the plies' metrics (eq. 8, true
/// thicknesses).
template <class S>
S laminate_energy(const Form<S>& a, const Form<S>& b, std::span<const Ply> plies, double nu) {
    S energy(0.0);
    for (const Ply& ply : plies) {
        const Mat2 inverse = ply.rest_metric.inverse();
        const auto times = [&](const Form<S>& f) -> std::array<S, 4> {
            return {
                inverse(0, 0) * f.m11 + inverse(0, 1) * f.m12, inverse(0, 0) * f.m12 + inverse(0, 1) * f.m22,
                inverse(1, 0) * f.m11 + inverse(1, 1) * f.m12, inverse(1, 0) * f.m12 + inverse(1, 1) * f.m22};
        };
        std::array<S, 4> A = times(a);
        A[0] = A[0] - 1.0;
        A[3] = A[3] - 1.0;
        const std::array<S, 4> B = times(b);
        const auto product = [&](const std::array<S, 4>& p, const std::array<S, 4>& q) -> S {
            return nu / (1.0 - nu * nu) * ((p[0] + p[3]) * (q[0] + q[3])) +
                   1.0 / (1.0 + nu) * (p[0] * q[0] + p[1] * q[2] + p[2] * q[1] + p[3] * q[3]);
        };
        const double z0 = ply.z0;
        const double z1 = ply.z1;
        const double factor = 0.25 * ply.youngs_modulus * std::sqrt(ply.rest_metric.determinant());
        energy =
            energy + factor * ((z1 - z0) / 4.0 * product(A, A) - (z1 * z1 - z0 * z0) / 2.0 * product(A, B) +
                               (z1 * z1 * z1 - z0 * z0 * z0) / 3.0 * product(B, B));
    }
    return energy;
}

/// A printed triangle; unknowns: corners, flaps, edge unknowns, as LaminateTerm has them.
struct LaminateElement {
    LaminateTerm::Element element;
    double poissons_ratio;
    Material material = {};           ///< of the fabric ply when it has the fabric's own law
    FabricLaw::Options options = {};  ///< of that law

    template <class S>
    S energy(std::span<const S> x) const {
        using std::sin;
        using std::sqrt;
        const auto point = [&](int slot) -> Point<S> {
            return {x[3 * slot], x[3 * slot + 1], x[3 * slot + 2]};
        };
        const Point<S> e1 = point(1) - point(0);
        const Point<S> e2 = point(2) - point(0);
        const Form<S> a{dot(e1, e1), dot(e1, e2), dot(e2, e2)};
        const Point<S> normal = cross(e1, e2);
        std::array<S, 3> c = {S(0.0), S(0.0), S(0.0)};
        std::array<bool, 3> free{};
        for (int i = 0; i < 3; ++i) {
            const LaminateTerm::EdgeSide& side = element.sides[i];
            free[i] = side.kind == LaminateTerm::EdgeSide::Kind::free_rim;
            if (side.kind == LaminateTerm::EdgeSide::Kind::open_rim) c[i] = x[18 + i];
            if (side.kind != LaminateTerm::EdgeSide::Kind::hinged) continue;
            const Point<S> start = point((i + 1) % 3);
            const Point<S> end = point((i + 2) % 3);
            S phi = 0.5 * dihedral(start, end, point(i), point(3 + i));
            if (side.unknown >= 0) phi = phi + side.sign / side.mean_altitude * x[18 + i];
            const S altitude = sqrt(dot(normal, normal) / dot(end - start, end - start));
            c[i] = altitude * sin(phi);
        }
        const auto energy_of = [&](const std::array<S, 3>& k) -> S {
            const Form<S> b{2.0 * (k[0] + k[1]), 2.0 * k[0], 2.0 * (k[0] + k[2])};
            S energy = laminate_energy(a, b, element.plies, poissons_ratio);
            if (element.fabric) energy = energy + fabric_energy(a, b);
            return energy;
        };
        return least_over_free(energy_of, c, free);
    }

  private:
    /// Three-point Gauss quadrature through the fabric's thickness.
    template <class S>
    S fabric_energy(const Form<S>& a, const Form<S>& b) const {
        const auto& p = element.fabric->relaxed;
        Mat2 edges;
        edges << p[1] - p[0], p[2] - p[0];
        const Mat2 d = edges.inverse();
        const double t = element.fabric->z1 - element.fabric->z0;
        S energy(0.0);
        for (const int q : {-1, 0, 1}) {
            const double z = element.fabric->z0 + 0.5 * t * (1.0 + q * std::sqrt(3.0 / 5.0));
            const Form<S> m{a.m11 - 2.0 * z * b.m11, a.m12 - 2.0 * z * b.m12, a.m22 - 2.0 * z * b.m22};
            const auto entry = [&](int i, int j) -> S {
                return d(0, i) * d(0, j) * m.m11 + (d(0, i) * d(1, j) + d(1, i) * d(0, j)) * m.m12 +
                       d(1, i) * d(1, j) * m.m22;
            };
            energy =
                energy + (q == 0 ? 4.0 / 9.0 : 5.0 / 18.0) * t * 0.5 * edges.determinant() *
                             fabric_density<S>({entry(0, 0), entry(0, 1), entry(1, 1)}, material, options);
        }
        return energy;
    }

    /// The least value of a quadratic function over the components of c that are free, from nothing but
    /// values of the function: with its values at -1, 0 and 1 the minimum of a parabola is known.
    template <class S, class F>
    static S least_over_free(const F& energy, const std::array<S, 3>& c, const std::array<bool, 3>& free,
                             int from = 0) {
        if (from == 3) return energy(c);
        if (!free[from]) return least_over_free(energy, c, free, from + 1);
        const auto at = [&](double value) -> S {
            std::array<S, 3> moved = c;
            moved[from] = S(value);
            return least_over_free(energy, moved, free, from + 1);
        };
        const S middle = at(0.0);
        const S left = at(-1.0);
        const S right = at(1.0);
        const S slope = 0.5 * (right - left);
        const S curvature = left + right - 2.0 * middle;
        return middle - 0.5 * (slope * slope / curvature);
    }
};

/// A unit vector.
template <class S>
Point<S> normalised(const Point<S>& p) {
    using std::sqrt;
    const S length = sqrt(dot(p, p));
    return {p[0] / length, p[1] / length, p[2] / length};
}
template <class S>
Point<S> scaled(const S& k, const Point<S>& p) {
    return {k * p[0], k * p[1], k * p[2]};
}

/// A rod's edge; unknowns: start, end, corners left and right, y.
struct RodEdgeElement {
    RodEdge::Element element;

    template <class S>
    S energy(std::span<const S> x) const {
        using std::tan;
        const auto point = [&](int v) -> Point<S> { return {x[3 * v], x[3 * v + 1], x[3 * v + 2]}; };
        const Point<S> d = point(1) - point(0);
        const double length = element.length;
        const S strain = 0.5 * ((1.0 / (length * length)) * dot(d, d) - 1.0);
        const S half = 0.5 * dihedral(point(0), point(1), point(2), point(3));
        const S phi = (1.0 / length) * x[12];
        const S left = tan(0.5 * (half - phi));
        const S right = tan(0.5 * (half + phi));
        return 0.5 * element.stretching_stiffness * length * (strain * strain) +
               4.0 * element.hinge_stiffness * (left * left + right * right);
    }
};

/// Two edges of a rod; unknowns: three vertices, corners left and right of each edge, two y.
struct RodJointElement {
    RodJoint::Element element;

    template <class S>
    S energy(std::span<const S> x) const {
        const std::array<std::array<Point<S>, 3>, 2> frames = {frame<S>(x, 0), frame<S>(x, 1)};
        const auto d = [&](int i, int j) -> S { return dot(frames[0][i], frames[1][j]); };
        const S divisor = d(0, 0) + d(1, 1) + d(2, 2) + 1.0;
        const double l = 0.5 * (element.lengths[0] + element.lengths[1]);
        S sum(0.0);
        for (int k = 0; k < 3; ++k) {
            const int i = (k + 1) % 3;
            const int j = (k + 2) % 3;
            const S off = 2.0 * (d(j, i) - d(i, j)) / divisor - element.rest[k];
            sum = sum + 0.5 * element.stiffness[k] / l * (off * off);
        }
        return sum;
    }

  private:
    template <class S>
    std::array<Point<S>, 3> frame(std::span<const S> x, int e) const {
        using std::cos;
        using std::sin;
        const auto point = [&](int v) -> Point<S> { return {x[3 * v], x[3 * v + 1], x[3 * v + 2]}; };
        const Point<S> d = point(e + 1) - point(e);
        const Point<S> left = normalised(cross(d, point(3 + 2 * e) - point(e)));
        const Point<S> right = normalised(cross(point(4 + 2 * e) - point(e), d));
        const Point<S> t = normalised(d);
        const Point<S> mean = normalised(left + right);
        const S phi = (element.signs[e] / element.lengths[e]) * x[21 + e];
        const Point<S> n = scaled(S(cos(phi)), mean) + scaled(S(sin(phi)), cross(t, mean));
        return {t, cross(n, t), n};
    }
};

}  // namespace ruche::test
