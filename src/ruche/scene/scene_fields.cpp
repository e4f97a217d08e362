#include "ruche/scene/scene.hpp"

namespace ruche {

static constexpr double far_away = 1e5;  // mm; nobody prints on a hundred metres of fabric
static constexpr std::string_view sides[] = {"front", "back"};

template <>
std::span<const Field<PatternSource>> fields<PatternSource>() {
    using P = PatternSource;
    static const Field<P> table[] = {
        {"svg", &P::svg, "", -infinity, infinity, "Drawing of what is printed; relative to the scene file."},
        {"mesh", &P::mesh, "", -infinity, infinity,
         "Instead of a drawing: a flat triangle mesh, PLY with front_mm and back_mm per face, or OBJ."},
        {"thickness_table", &P::thickness_table, "", -infinity, infinity,
         "For an OBJ mesh: CSV file with triangle, front_mm, back_mm."},
        {"generator", &P::generator, "", -infinity, infinity,
         "Instead of a drawing: a built-in pattern; its options stand in [pattern.options]."},
        {"width_mm", &P::width_mm, "mm", 0, far_away,
         "Scale the drawing so that its page is this wide; 0 takes the size from the drawing."},
        {"flatten_tolerance_mm", &P::flatten_tolerance_mm, "mm", 1e-5, 1,
         "Largest distance between a drawn curve and the straight pieces that replace it."},
    };
    return table;
}

template <>
std::span<const Field<FabricOptions>> fields<FabricOptions>() {
    using F = FabricOptions;
    static const Field<F> table[] = {
        {"card", &F::card, "", -infinity, infinity,
         "Material card: a name from `ruche cards`, or a card file."},
        {"prestretch", &F::prestretch, "", 1, 3,
         "Length on the printing frame over relaxed length. A fabric that is not stretched has 1."},
        {"axis_deg", &F::axis_deg, "deg", -360, 360,
         "Angle from the drawing's x axis to the fabric's first axis."},
        {"margin_mm", &F::margin_mm, "mm", 0, far_away,
         "Fabric that is left around the print, where no outline is drawn. 0 cuts it along the print."},
        {"outline", &F::outline, "", -infinity, infinity,
         "Layer, group, colour, class or id of the shapes that bound the fabric, holes included. Where it is "
         "not given, a layer or group named \"fabric\" (also \"Fabric\", \"FABRIC\") bounds it; else the "
         "fabric "
         "is the print with a margin around it."},
    };
    return table;
}

template <>
std::span<const Field<PlasticOptions>> fields<PlasticOptions>() {
    using P = PlasticOptions;
    static const Field<P> table[] = {
        {"thickness_mm", &P::thickness_mm, "mm", 0.001, 50,
         "Thickness of the print where no rule says otherwise."},
        {"side", choice<&P::side>(sides), "", -infinity, infinity,
         "Side of the fabric that is printed on; the drawing shows the front."},
        {"back_thickness_factor", &P::back_thickness_factor, "", 0.1, 10,
         "Thickness of strips on the fabric's back over the thickness that is asked for: a side of other "
         "roughness may take more or less plastic (paper, Fig. 11). Measure both sides."},
    };
    return table;
}

template <>
std::span<const Field<PrintRule>> fields<PrintRule>() {
    using R = PrintRule;
    static constexpr std::string_view roles[] = {"strip", "fabric_outline", "ignore"};
    static const Field<R> table[] = {
        {"match", &R::match, "", -infinity, infinity,
         "Colour (\"#ff0000\" or a name), class, id or label of the drawn shapes that this rule is for, or "
         "the "
         "name of a layer or group around them. The nearest match wins: the shape's own before that of the "
         "innermost group, and so on outwards; of several at one place the first rule."},
        {"role", choice<&R::role>(roles), "", -infinity, infinity,
         "What these shapes are: printed strips, the fabric's outline, or nothing."},
        {"thickness_mm", &R::thickness, "mm", 0.001, 50,
         "Thickness of these strips; else that of [plastic]."},
        {"side", choice<&R::side>(sides), "", -infinity, infinity,
         "Side these strips are printed on; else that of [plastic]."},
        {"youngs_modulus_mpa", &R::youngs_modulus, "MPa", 0, 1e6,
         "Young's modulus of these strips' plastic; 0 takes the material's."},
    };
    return table;
}

template <>
std::span<const Field<Selection>> fields<Selection>() {
    using S = Selection;
    static constexpr std::string_view wheres[] = {"box", "point"};
    static const Field<S> table[] = {
        {"where", choice<&S::where>(wheres), "", -infinity, infinity,
         "box: all vertices of the layout from min_mm to max_mm; point: the vertex nearest to point_mm. "
         "Follows from the keys that are given."},
        {"min_mm", &S::min_mm, "mm", -far_away, far_away, "Lower left corner of the box, in the layout."},
        {"max_mm", &S::max_mm, "mm", -far_away, far_away, "Upper right corner of the box."},
        {"point_mm", &S::point_mm, "mm", -far_away, far_away, "A point of the layout."},
    };
    return table;
}

template <>
std::span<const Field<SupportOptions>> fields<SupportOptions>() {
    using S = SupportOptions;
    static const Field<S> table[] = {
        {"fix", &S::fix, "", -infinity, infinity, "Directions in which they are held: \"xyz\", \"z\", ..."},
        {"move_mm", &S::move_mm, "mm", -far_away, far_away,
         "Where they are taken, from their place in the flat, stretched layout."},
    };
    return table;
}

template <>
std::span<const Field<ForceOptions>> fields<ForceOptions>() {
    static const Field<ForceOptions> table[] = {
        {"force_n", &ForceOptions::force_n, "N", -1e6, 1e6,
         "Total force, shared equally by these vertices; it keeps its direction."},
    };
    return table;
}

template <>
std::span<const Field<GravityOptions>> fields<GravityOptions>() {
    using G = GravityOptions;
    static const Field<G> table[] = {
        {"acceleration_mm_per_s2", &G::acceleration_mm_per_s2, "mm/s^2", -1e6, 1e6,
         "Acceleration of gravity; on earth, with the front up, [0, 0, -9810]. Needs a support or the "
         "table."},
        {"table", &G::table, "", -infinity, infinity,
         "The sheet rests on a frictionless table that lies perpendicular to gravity."},
        {"table_height_mm", &G::table_height_mm, "mm", -far_away, far_away,
         "Height of the table above the plane of the flat layout, against gravity."},
    };
    return table;
}

template <>
std::span<const Field<OutputOptions>> fields<OutputOptions>() {
    using O = OutputOptions;
    static const Field<O> table[] = {
        {"obj", &O::obj, "", -infinity, infinity, "Write the shape and the layout as OBJ."},
        {"ply", &O::ply, "", -infinity, infinity, "Write the shape as PLY, with values per face and vertex."},
        {"vtu", &O::vtu, "", -infinity, infinity, "Write the shape as VTU (ParaView), with all fields."},
        {"glb", &O::glb, "", -infinity, infinity, "Write the shape as binary glTF, in metres, with colours."},
        {"stl", &O::stl, "", -infinity, infinity, "Write the bare surface of the shape as STL."},
        {"picture", &O::picture, "", -infinity, infinity, "Write a PNG of the drawing and the shape."},
        {"page", &O::page, "", -infinity, infinity,
         "Write report.html, a page for the browser with drawing, shape, strips and all numbers in it."},
        {"film_frames", &O::film_frames, "", 0, 200,
         "Number of equilibria from flat to released that the page's slider plays, such as 16; 0 for none. "
         "They take "
         "several times as long as the release."},
        {"picture_width_px", &O::picture_width_px, "px", 64, 16384, "Width of the picture."},
        {"picture_height_px", &O::picture_height_px, "px", 64, 16384, "Height of the picture."},
    };
    return table;
}

}  // namespace ruche
