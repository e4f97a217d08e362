#include "ruche/material/laminate.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

namespace ruche {
namespace {

Vec3 components(const Mat2& form) { return {form(0, 0), 0.5 * (form(0, 1) + form(1, 0)), form(1, 1)}; }

/// Q with <a_bar^-1 a, a_bar^-1 a'> = a^T Q a' for symmetric forms as (a11, a12, a22).
Mat3 energy_inner_product(const Mat2& rest_metric, double nu) {
    const Mat2 inverse = rest_metric.inverse();
    const double p = inverse(0, 0);
    const double q = inverse(0, 1);
    const double r = inverse(1, 1);
    const Vec3 trace(p, 2.0 * q, r);
    Mat3 trace_of_product;                                // tr(a_bar^-1 a a_bar^-1 a')
    trace_of_product << p * p, 2.0 * p * q, q * q,        //
        2.0 * p * q, 2.0 * (p * r + q * q), 2.0 * q * r,  //
        q * q, 2.0 * q * r, r * r;
    return nu / (1.0 - nu * nu) * trace * trace.transpose() + 1.0 / (1.0 + nu) * trace_of_product;
}

}  // namespace

LaminateForm laminate_form(std::span<const Ply> plies, double nu, const Mat2& reference_metric) {
    LaminateForm form;
    const Vec3 reference = components(reference_metric);
    for (const Ply& ply : plies) {
        const double factor = ply.youngs_modulus * std::sqrt(ply.rest_metric.determinant());
        const double stretching = factor * (ply.z1 - ply.z0) / 4.0;
        const double cross = -factor * (ply.z1 * ply.z1 - ply.z0 * ply.z0) / 4.0;
        const double bending = factor * (std::pow(ply.z1, 3) - std::pow(ply.z0, 3)) / 3.0;
        const Mat3 q = energy_inner_product(ply.rest_metric, nu);
        const Vec3 offset = reference - components(ply.rest_metric);
        form.quadratic.topLeftCorner<3, 3>() += stretching * q;
        form.quadratic.topRightCorner<3, 3>() += cross * q;
        form.quadratic.bottomLeftCorner<3, 3>() += cross * q;
        form.quadratic.bottomRightCorner<3, 3>() += bending * q;
        const Vec3 q_offset = q * offset;
        form.linear.head<3>() += stretching * q_offset;
        form.linear.tail<3>() += cross * q_offset;
        form.constant += 0.5 * stretching * offset.dot(q_offset);
    }
    return form;
}

FormVector free_forms(std::span<const Ply> plies, double nu, const Mat2& reference_metric) {
    const LaminateForm form = laminate_form(plies, nu, reference_metric);
    FormVector forms = -form.quadratic.ldlt().solve(form.linear);
    forms.head<3>() += components(reference_metric);
    return forms;
}

double laminate_energy_density(const Mat2& a, const Mat2& b, std::span<const Ply> plies, double nu) {
    const LaminateForm form = laminate_form(plies, nu, a);
    FormVector deviation = FormVector::Zero();
    deviation.tail<3>() = components(b);
    return form.constant + form.linear.dot(deviation) + 0.5 * deviation.dot(form.quadratic * deviation);
}

std::vector<Ply> printed_plies(const PrintedLaminate& print, const Mat2& layout_metric,
                               const Mat2& fabric_metric) {
    // The fabric lies below the interface of a front print, above that of a back print, around z = 0 of a
    // double one.
    double fabric_bottom = 0.0;
    if (print.front > 0.0) fabric_bottom = print.back > 0.0 ? -0.5 * print.fabric : -print.fabric;
    const double fabric_top = fabric_bottom + print.fabric;
    std::vector<Ply> plies = {{fabric_bottom, fabric_top, print.fabric_modulus, fabric_metric}};
    if (print.front > 0.0) {
        plies.push_back({fabric_top, fabric_top + print.front, print.front_modulus, layout_metric});
    }
    if (print.back > 0.0) {
        plies.push_back({fabric_bottom - print.back, fabric_bottom, print.back_modulus, layout_metric});
    }
    return plies;
}

}  // namespace ruche
