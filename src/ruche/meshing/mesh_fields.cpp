#include "ruche/meshing/print_mesh.hpp"

namespace ruche {

template <>
std::span<const Field<MeshOptions>> fields<MeshOptions>() {
    using M = MeshOptions;
    static const Field<M> table[] = {
        {"size_mm", &M::size_mm, "mm", 0.01, 1000,
         "Edge length of the elements on plastic; down to 0.35 of it where thin or wide strips need that."},
        {"elements_across", &M::elements_across, "", 0.5, 100,
         "At least so many elements across the width of a strip."},
        {"fabric_size_mm", &M::fabric_size_mm, "mm", 0.01, 1000,
         "Edge length of the elements in bare fabric far from plastic."},
        {"grading", &M::grading, "", 0, 10, "Growth of the edge length per length away from plastic."},
        {"subdivisions", &M::subdivisions, "", 0, 6,
         "Times that every triangle is then divided into four: nested meshes, for convergence studies."},
    };
    return table;
}

}  // namespace ruche
