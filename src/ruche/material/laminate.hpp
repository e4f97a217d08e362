#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "ruche/geometry/vectors.hpp"

namespace ruche {

/// A layer at heights [z0, z1] (mm) along the front normal, with Young's modulus in MPa and its rest metric,
/// all in one basis of the layout.
struct Ply {
    double z0 = 0.0;
    double z1 = 0.0;
    double youngs_modulus = 0.0;
    Mat2 rest_metric = Mat2::Identity();
};

/// First and second fundamental form of the reference surface as one vector: (a11, a12, a22, b11, b12, b22).
using FormVector = Eigen::Matrix<double, 6, 1>;
using FormMatrix = Eigen::Matrix<double, 6, 6>;

/// Energy of a stack of plies per parametric area (model: van Rees et al. 2017, paper eq. 8, with true
/// thicknesses):
///
///     W = 1/2 sum_plies E sqrt(det a_bar) [ (z1-z0)/4 |A|^2 - (z1^2-z0^2)/2 <A, B> + (z1^3-z0^3)/3 |B|^2 ]
///     A = a_bar^-1 a - I,  B = a_bar^-1 b,  <A, B> = nu/(1-nu^2) tr A tr B + 1/(1+nu) tr(A B)
///
/// It is quadratic in (a, b): W = constant + linear . d + d . quadratic d / 2 with d = (a - reference, b).
/// The reference metric is the one that the deviation is measured from (choose it near the solution: no
/// cancellation).
struct LaminateForm {
    FormMatrix quadratic = FormMatrix::Zero();
    FormVector linear = FormVector::Zero();
    double constant = 0.0;
};
LaminateForm laminate_form(std::span<const Ply> plies, double poissons_ratio, const Mat2& reference_metric);

/// The forms (a, b) of least energy when nothing holds them: those of a free narrow strip (theory page,
/// closed forms).
FormVector free_forms(std::span<const Ply> plies, double poissons_ratio, const Mat2& reference_metric);

/// The same energy for one pair of forms, mJ/mm^2 of the layout when the basis is orthonormal there.
double laminate_energy_density(const Mat2& a, const Mat2& b, std::span<const Ply> plies,
                               double poissons_ratio);

/// The plies of a print, the fabric first: reference surface at the fabric/plastic interface; on both sides,
/// at mid-fabric. Thicknesses in mm; a side that is not printed has thickness 0.
struct PrintedLaminate {
    double front = 0.0;
    double back = 0.0;
    double fabric = 0.0;
    double front_modulus = 0.0;
    double back_modulus = 0.0;
    double fabric_modulus = 0.0;
};
std::vector<Ply> printed_plies(const PrintedLaminate& print, const Mat2& layout_metric,
                               const Mat2& fabric_metric);

}  // namespace ruche
