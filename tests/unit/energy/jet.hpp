#pragma once

#include <Eigen/Core>
#include <cmath>

namespace ruche::test {

/// A number with its exact first and second derivatives with respect to N unknowns (forward mode). The oracle
/// of the energies: slow, plain, and free of any formula for a derivative of a strain measure.
template <int N>
struct Jet {
    using Gradient = Eigen::Matrix<double, N, 1>;
    using Hessian = Eigen::Matrix<double, N, N>;

    double value = 0.0;
    Gradient gradient = Gradient::Zero();
    Hessian hessian = Hessian::Zero();

    Jet() = default;
    Jet(double constant) : value(constant) {}  // NOLINT(google-explicit-constructor): constants mix freely
    static Jet unknown(int index, double value) {
        Jet u(value);
        u.gradient[index] = 1.0;
        return u;
    }
};

/// f(u) from f, f' and f'' at u.
template <int N>
Jet<N> chain(const Jet<N>& u, double f, double f1, double f2) {
    Jet<N> r(f);
    r.gradient = f1 * u.gradient;
    r.hessian.noalias() = (f2 * u.gradient) * u.gradient.transpose();
    r.hessian += f1 * u.hessian;
    return r;
}

/// f(u, v) from f and its partial derivatives.
struct Partials {
    double f, u, v, uu, uv, vv;
};
template <int N>
Jet<N> chain(const Jet<N>& u, const Jet<N>& v, const Partials& d) {
    Jet<N> r(d.f);
    r.gradient = d.u * u.gradient + d.v * v.gradient;
    r.hessian.noalias() = (d.uu * u.gradient + d.uv * v.gradient) * u.gradient.transpose();
    r.hessian.noalias() += (d.uv * u.gradient + d.vv * v.gradient) * v.gradient.transpose();
    r.hessian += d.u * u.hessian + d.v * v.hessian;
    return r;
}

template <int N>
Jet<N> operator+(const Jet<N>& u, const Jet<N>& v) {
    Jet<N> r(u.value + v.value);
    r.gradient = u.gradient + v.gradient;
    r.hessian = u.hessian + v.hessian;
    return r;
}
template <int N>
Jet<N> operator*(double k, const Jet<N>& u) {
    Jet<N> r(k * u.value);
    r.gradient = k * u.gradient;
    r.hessian = k * u.hessian;
    return r;
}
template <int N>
Jet<N> operator+(const Jet<N>& u, double k) {
    Jet<N> r = u;
    r.value += k;
    return r;
}
template <int N>
Jet<N> operator-(const Jet<N>& u, const Jet<N>& v) {
    return u + (-1.0) * v;
}
template <int N>
Jet<N> operator-(const Jet<N>& u, double k) {
    return u + (-k);
}
template <int N>
Jet<N> operator-(double k, const Jet<N>& u) {
    return (-1.0) * u + k;
}
template <int N>
Jet<N> operator*(const Jet<N>& u, const Jet<N>& v) {
    return chain(u, v, {u.value * v.value, v.value, u.value, 0.0, 1.0, 0.0});
}
template <int N>
Jet<N> operator/(const Jet<N>& u, const Jet<N>& v) {
    const double r = 1.0 / v.value;
    return chain(u, v, {u.value * r, r, -u.value * r * r, 0.0, -r * r, 2.0 * u.value * r * r * r});
}
template <int N>
bool operator>(const Jet<N>& u, double k) {
    return u.value > k;
}

template <int N>
Jet<N> sqrt(const Jet<N>& u) {
    const double root = std::sqrt(u.value);
    return chain(u, root, 0.5 / root, -0.25 / (root * u.value));
}
template <int N>
Jet<N> log(const Jet<N>& u) {
    return chain(u, std::log(u.value), 1.0 / u.value, -1.0 / (u.value * u.value));
}
template <int N>
Jet<N> sin(const Jet<N>& u) {
    return chain(u, std::sin(u.value), std::cos(u.value), -std::sin(u.value));
}
template <int N>
Jet<N> cos(const Jet<N>& u) {
    return chain(u, std::cos(u.value), -std::sin(u.value), -std::cos(u.value));
}
template <int N>
Jet<N> tan(const Jet<N>& u) {
    const double t = std::tan(u.value);
    return chain(u, t, 1.0 + t * t, 2.0 * t * (1.0 + t * t));
}
template <int N>
Jet<N> atan2(const Jet<N>& y, const Jet<N>& x) {
    const double r2 = x.value * x.value + y.value * y.value;
    const double r4 = r2 * r2;
    const double xy = 2.0 * x.value * y.value / r4;
    return chain(y, x,
                 {std::atan2(y.value, x.value), x.value / r2, -y.value / r2, -xy,
                  (y.value * y.value - x.value * x.value) / r4, xy});
}

}  // namespace ruche::test
