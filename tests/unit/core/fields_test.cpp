#include "ruche/core/fields.hpp"

#include <doctest/doctest.h>

#include <set>

#include "ruche/scene/scene.hpp"

using namespace ruche;

namespace {
template <class Struct>
void check_table() {
    std::set<std::string_view> keys;
    for (const Field<Struct>& field : fields<Struct>()) {
        const FieldInfo about = info(field);
        CAPTURE(about.key);
        CHECK(keys.insert(about.key).second);
        CHECK(about.key.ends_with(unit_suffix(about.unit)));
        CHECK(about.meaning.ends_with('.'));
        CHECK(about.low <= about.high);
        CHECK_NOTHROW(check(about, get(Struct{}, field), {}));
    }
    CHECK_FALSE(keys.empty());
}
}  // namespace

TEST_CASE("fields: every table has unique keys that end in their unit and defaults in range") {
    const Scene scene;
    for_each_section(scene, []<class Section>(const std::string& name, const Section&) {
        CAPTURE(name);
        check_table<Section>();
    });
    check_table<PrintRule>();
    check_table<Selection>();
    check_table<SupportOptions>();
    check_table<ForceOptions>();
}

TEST_CASE("fields: units become the suffixes of keys") {
    CHECK(unit_suffix("") == "");
    CHECK(unit_suffix("MPa") == "_mpa");
    CHECK(unit_suffix("kg/m^2") == "_kg_per_m2");
    CHECK(unit_suffix("N mm") == "_n_mm");
    CHECK(unit_suffix("mm/s^2") == "_mm_per_s2");
}

TEST_CASE("fields: the bare names of the material are the pinned ones") {
    std::set<std::string_view> names;
    for (const Field<Material>& field : fields<Material>()) names.insert(bare_name(info(field)));
    CHECK(names == std::set<std::string_view>{
                       "fabric_thickness", "fabric_areal_density", "alpha_1", "alpha_2", "alpha_3", "beta_1",
                       "beta_2", "gamma_1", "gamma_2", "fabric_poissons_ratio", "fabric_youngs_modulus",
                       "fabric_bending_stiffness", "neo_hookean_share", "plastic_youngs_modulus",
                       "plastic_density", "laminate_poissons_ratio"});
}

TEST_CASE("fields: what is set is what is got, for every kind") {
    SolveOptions solver;
    for (const Field<SolveOptions>& field : fields<SolveOptions>()) {
        if (field.key == "noise_mm") set(solver, field, 0.25);
        if (field.key == "seed") set(solver, field, 7);
        if (field.key == "deterministic") set(solver, field, false);
    }
    CHECK(solver.noise_mm == 0.25);
    CHECK(solver.seed == 7);
    CHECK_FALSE(solver.deterministic);
    PlasticOptions plastic;
    for (const Field<PlasticOptions>& field : fields<PlasticOptions>())
        if (field.key == "side") {
            set(plastic, field, std::string("back"));
            CHECK(std::get<std::string>(get(plastic, field)) == "back");
        }
    CHECK(plastic.side == Side::back);
}

TEST_CASE("fields: a struct filled in code is checked by the same table") {
    Material material;
    CHECK_NOTHROW(check_fields(material, "material"));
    material.neo_hookean_share = 1.5;
    CHECK_THROWS_WITH_AS(check_fields(material, "material"), doctest::Contains("1.5 is outside [0, 1]"),
                         InputError);
    material.neo_hookean_share = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(check_fields(material, "material"), doctest::Contains("not a finite number"),
                         InputError);
}
