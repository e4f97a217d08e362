#include "ruche/energy/model.hpp"

namespace ruche {

template <>
std::span<const Field<ModelOptions>> fields<ModelOptions>() {
    using M = ModelOptions;
    static constexpr std::string_view edge_normals[] = {"free", "averaged"};
    static constexpr std::string_view bending_normalisation[] = {"plate", "as_printed"};
    static constexpr std::string_view laminate_thickness[] = {"true", "as_printed"};
    static constexpr std::string_view shear_strain[] = {"engineering", "tensor"};
    static constexpr std::string_view fabric_ply[] = {"linear", "same_law"};
    static constexpr std::string_view strips[] = {"shell", "rods"};
    static const Field<M> table[] = {
        {"strips", choice<&M::strips>(strips), "", -infinity, infinity,
         "What a printed strip is: shell is plastic and fabric as one layered sheet; rods are elastic rods "
         "without width along the centre lines, the model of Perez et al. 2017 and Jourdan et al. 2020, for "
         "comparison: they do nothing to the fabric across the strip."},
        {"edge_normals", choice<&M::edge_normals>(edge_normals), "", -infinity, infinity,
         "How the plastic's curvature is measured at an edge: free turns the edge's normal to where the "
         "energy is least and gives the same curvature on any mesh; averaged is the paper's."},
        {"bending_normalisation", choice<&M::bending_normalisation>(bending_normalisation), "", -infinity,
         infinity,
         "Bending energy of the fabric: plate stores 1/2 k_B kappa^2 per area, as the cantilever test that "
         "measures k_B; as_printed is the paper's eq. 7, six times as much."},
        {"laminate_thickness", choice<&M::laminate_thickness>(laminate_thickness), "", -infinity, infinity,
         "Layer thickness in the paper's eq. 8: true is the layer's thickness; as_printed halves it, which "
         "doubles the curvature."},
        {"shear_strain", choice<&M::shear_strain>(shear_strain), "", -infinity, infinity,
         "Shear strain that alpha_3 acts on: engineering is 2 E_12, tensor is E_12."},
        {"fabric_ply", choice<&M::fabric_ply>(fabric_ply), "", -infinity, infinity,
         "The fabric under plastic: linear is elastic with fabric_youngs_modulus_mpa, as the paper's eq. 8; "
         "same_law has the law of the bare fabric, through its thickness."},
        {"log_extension", &M::log_extension, "", 1e-9, 0.1,
         "The fabric's stress goes on linearly from Green strain gamma minus this; the paper has 1e-6, "
         "which is too stiff to solve with."},
        {"contact", &M::contact, "", -infinity, infinity,
         "Parts of the sheet that come close repel each other, so that a rolled sheet cannot pass through "
         "itself. Takes longer where something touches, and nothing where nothing does."},
        {"contact_distance_mm", &M::contact_distance, "mm", 0.01, 10,
         "Distance of two parts from which on they repel each other, between the surfaces where fabric and "
         "plastic meet; pressed together they come closer. At most about the size of an element."},
    };
    return table;
}

}  // namespace ruche
