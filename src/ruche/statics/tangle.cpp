#include "ruche/statics/tangle.hpp"

#include <fmt/format.h>

namespace ruche {

std::string tangle(const Health& health) {
    constexpr double beyond_law = 0.05;
    constexpr double collapsed = 1e-4;
    constexpr double folded_deg = 160.0;
    constexpr double turned_deg = 90.0;
    if (health.max_strain_margin > beyond_law)
        return fmt::format("bare fabric is strained {:.2g} beyond the limit of its law",
                           health.max_strain_margin);
    if (health.min_area_ratio < collapsed)
        return fmt::format("an element is crushed to {:.2g} % of its area", 100.0 * health.min_area_ratio);
    if (health.max_dihedral_deg > folded_deg)
        return fmt::format("two neighbouring elements are folded on each other ({:.4g} degrees)",
                           health.max_dihedral_deg);
    if (health.max_edge_rotation_deg >= turned_deg)
        return fmt::format("plastic is turned by {:.4g} degrees against a normal at its edge",
                           health.max_edge_rotation_deg);
    return {};
}

}  // namespace ruche
