#include "ruche/material/consistent_modulus.hpp"

#include "ruche/material/fabric_law.hpp"
#include "ruche/material/laminate.hpp"

namespace ruche {

double consistent_fabric_modulus(const Material& material, const std::array<double, 2>& s) {
    // Both tensions are per thickness, and linear in E_f.
    const auto of_law = [&](double modulus) {
        Material m = material;
        m.fabric_youngs_modulus = modulus;
        const Vec3 stress = FabricLaw(m)({0.5 * (s[0] * s[0] - 1.0), 0.5 * (s[1] * s[1] - 1.0), 0.0}).stress;
        // F S per relaxed area, over the layout's width.
        return 0.5 * (stress[0] * s[0] / s[1] + stress[1] * s[1] / s[0]);
    };
    const Mat2 relaxed_metric = Vec2(1.0 / (s[0] * s[0]), 1.0 / (s[1] * s[1])).asDiagonal();
    const Ply ply{.z0 = 0.0, .z1 = 1.0, .youngs_modulus = 1.0, .rest_metric = relaxed_metric};
    const LaminateForm form = laminate_form({&ply, 1}, material.laminate_poissons_ratio, Mat2::Identity());
    // dW/da; a grows by twice the stretch.
    const double of_ply = form.linear[0] + form.linear[2];
    const double without = of_law(0.0);
    return without / (of_ply - (of_law(1.0) - without));
}

}  // namespace ruche
