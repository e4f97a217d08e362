#include <algorithm>

#include "ruche/core/manual.hpp"
#include "ruche/study/calibration/campaign.hpp"

namespace ruche {

/// A section of the manual: what must be there says so in place of a default.
template <class Struct>
static std::string section(std::string_view title, std::string_view purpose, const Struct& s = {}) {
    const auto required = required_keys<Struct>();
    const auto is_required = [&](std::string_view key) {
        return std::find(required.begin(), required.end(), key) != required.end();
    };
    std::string text = manual_heading(title, purpose);
    for (const Field<Struct>& field : fields<Struct>()) {
        const FieldInfo about = info(field);
        text += manual_row(about, is_required(field.key) ? "required" : written(about, get(s, field)));
    }
    for (const Readings<Struct>& list : readings<Struct>())
        text += manual_row(list.about, is_required(list.about.key) ? "required" : "[]");
    return text;
}

std::string campaign_manual() {
    return "# The campaign file\n"
           "What `ruche calibrate` reads: a TOML file that names the tests' files and says what was measured "
           "on "
           "which\n"
           "sample; [calibration.md](calibration.md) has an example. The unit is part of the key, unknown "
           "keys are "
           "errors,\n"
           "paths are relative to the campaign file. This page is printed by `ruche template --campaign`.\n" +
           section<CampaignOptions>("above all tables", "What holds for all tests.") +
           section<FabricMeasurements>(
               "[fabric]", "The fabric itself. Lists are repeated readings; one number will do.") +
           section<PlasticMeasurements>("[plastic]", "What is printed.") +
           section<ColumnOptions>(
               "[columns]",
               "Where names and units in the files are not understood: for all files here, for "
               "one in its own table (columns = { force = \"3\" }).") +
           section<TensionTest>("[[tension]]", "One specimen of fabric, pulled.") +
           section<ShearTest>("[[shear]]",
                              "One piece of fabric between clamps of which one moves sideways.") +
           section<CantileverTest>("[[cantilever]]",
                                   "One strip that hangs over an edge, at several lengths.") +
           section<PlasticTest>("[[plastic_tension]]", "One printed strip, pulled.") +
           section<PrintedSample>("[[printed]]",
                                  "A strip that was printed and released, and the radius it took.") +
           section<PrintedFitOptions>("[printed_fit]", "What the printed samples determine.");
}

}  // namespace ruche
