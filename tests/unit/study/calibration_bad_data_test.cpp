// What people really bring: each case ends in a message with file and row, or in a warning that the card
// keeps.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>
#include <functional>

#include "ruche/study/calibration/calibration.hpp"
#include "synthetic_tests.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

/// A sound campaign of three orientations; cases spoil the file of the first or the campaign.
struct Sound {
    std::string first;  ///< the file at 0 degrees
    std::string head = "[fabric]\nthickness_mm = 0.46\nareal_density_kg_per_m2 = 0.2\npoissons_ratio = 0.3\n";
    std::string first_test = "file = \"0.csv\"\nangle_deg = 0\nlength_mm = 110\nwidth_mm = 20\n";
    std::vector<double> others = {45, 90};
    std::string tail;
};

using Change = std::function<void(Sound&)>;

/// Rows of the file, the header first.
std::vector<std::string> rows_of(const std::string& csv) {
    std::vector<std::string> rows;
    std::size_t begin = 0;
    for (std::size_t end = csv.find('\n'); end != std::string::npos; end = csv.find('\n', begin)) {
        rows.push_back(csv.substr(begin, end - begin));
        begin = end + 1;
    }
    return rows;
}

std::string joined(const std::vector<std::string>& rows) {
    std::string csv;
    for (const std::string& row : rows) csv += row + "\n";
    return csv;
}

/// Changes the numbers of every row: time, displacement, force, width.
Change on_rows(const std::function<void(std::array<double, 4>&, std::size_t)>& change) {
    return [change](Sound& sound) {
        std::vector<std::string> rows = rows_of(sound.first);
        for (std::size_t i = 1; i < rows.size(); ++i) {
            std::array<double, 4> v{};
            std::size_t at = 0;
            for (double& number : v) {
                std::size_t used = 0;
                number = std::stod(rows[i].substr(at), &used);
                at += used + 1;
            }
            change(v, i);
            rows[i] = fmt::format("{},{},{},{}", v[0], v[1], v[2], v[3]);
        }
        sound.first = joined(rows);
    };
}

struct Case {
    std::string name;
    Change change;
    std::string message;  ///< in the error, or in a warning
    bool is_warning = false;
};

const Case cases[] = {
    {"one column", [](Sound& s) { s.first = "Load (N)\n0\n1\n2\n3\n"; },
     "0.csv: has no table of numbers with at least two columns"},
    {"empty file", [](Sound& s) { s.first.clear(); }, "0.csv: is empty"},
    {"only a header", [](Sound& s) { s.first = "Extension (mm),Load (N)\n"; }, "has no table of numbers"},
    {"no unloading",
     [](Sound& s) {
         std::vector<std::string> rows = rows_of(s.first);
         rows.resize(rows.size() / 2);
         s.first = joined(rows);
     },
     "0.csv:24: there is no unloading: the displacement never comes back"},
    {"two points", [](Sound& s) { s.first = "Extension (mm),Load (N)\n0,0\n50,1\n"; },
     "has 2 rows of numbers; at least 6"},
    {"force in the wrong unit by 1000", on_rows([](auto& v, std::size_t) { v[2] *= 1000.0; }),
     "N per mm of width; knits pull with"},
    {"force too small by 1000", on_rows([](auto& v, std::size_t) { v[2] *= 1e-3; }),
     "N per mm of width; knits pull with"},
    {"displacement in metres without saying so", on_rows([](auto& v, std::size_t) { v[1] *= 1e-3; }),
     "times its length; 1.7 was expected"},
    {"displacement in micrometres", on_rows([](auto& v, std::size_t) { v[1] *= 1e3; }),
     "times its length; 1.7 was expected"},
    {"swapped columns", on_rows([](auto& v, std::size_t) {
         std::swap(v[1], v[2]);
         v[1] *= 20.0;
         v[2] *= 0.1;
     }),
     "are the two columns swapped?"},
    {"a unit that is none of a force", [](Sound& s) { s.first.replace(s.first.find("(N)"), 3, "(mm)"); },
     "\"mm\" of column 3"},
    {"NaN in one row",
     [](Sound& s) {
         std::vector<std::string> rows = rows_of(s.first);
         rows[20] = "4,NaN,1,20";
         s.first = joined(rows);
     },
     "0.csv:21: \"NaN\" is no number; 1 of", true},
    {"NaN in every third row",
     [](Sound& s) {
         std::vector<std::string> rows = rows_of(s.first);
         for (std::size_t i = 3; i < rows.size(); i += 3) rows[i] = "1,NaN,NaN,NaN";
         s.first = joined(rows);
     },
     "0.csv:4: \"NaN\" is no number"},
    {"slack of 8 mm",
     [](Sound& s) {
         on_rows([](auto& v, std::size_t) { v[1] += 8.0; })(s);
         s.first.insert(s.first.find('\n') + 1, "0,0,0,20\n0,2,0,20\n0,4,0,20\n0,6,0,20\n0,8,0,20\n");
     },
     "of slack before the sample pulls", true},
    {"a grip that slips", on_rows([](auto& v, std::size_t i) {
         if (i > 18 && i < 30) v[2] *= 0.5;
     }),
     "a grip slipped or a yarn broke", true},
    {"a force that stands alone", on_rows([](auto& v, std::size_t i) {
         if (i == 12) v[2] = 99.0;
     }),
     "0.csv:13: a force of 99 N stands alone", true},
    {"a load cell that drifts",
     on_rows([](auto& v, std::size_t i) { v[2] += 0.008 * static_cast<double>(i); }),
     "when the clamp is back", true},
    {"force with the other sign", on_rows([](auto& v, std::size_t) { v[2] = -v[2]; }), "its sign was turned",
     true},
    {"orientation missing in the campaign",
     [](Sound& s) { s.first_test = "file = \"0.csv\"\nlength_mm = 110\nwidth_mm = 20\n"; },
     "tension.1.angle_deg: missing"},
    {"no test along the second axis", [](Sound& s) { s.others = {45}; },
     "no tension test along the fabric's second axis"},
    {"no test between the axes", [](Sound& s) { s.others = {90}; }, "no tension test between the axes"},
    {"the file is not there",
     [](Sound& s) { s.first_test = "file = \"1.csv\"\nangle_deg = 0\nlength_mm = 110\nwidth_mm = 20\n"; },
     "1.csv: there is no such file"},
    {"width of the sample missing",
     [](Sound& s) { s.first_test = "file = \"0.csv\"\nangle_deg = 0\nlength_mm = 110\n"; },
     "tension.1.width_mm: missing"},
    {"a misspelt key", [](Sound& s) { s.first_test += "widht_mm = 20\n"; }, "did you mean width_mm?"},
    {"a spreadsheet", [](Sound& s) { s.first = std::string("PK\x03\x04\0\0\0\0", 8); },
     "0.csv: is a spreadsheet (xlsx, ods) or a zip file"},
    {"a drawing", [](Sound& s) { s.first = "<?xml version=\"1.0\"?>\n<svg width=\"9\" height=\"9\"/>\n"; },
     "0.csv: is an XML or SVG file, expected a table as text"},
    {"a picture", [](Sound& s) { s.first = std::string("\x89PNG\r\n\x1A\n\0\0\0\rIHDR", 16); },
     "0.csv: is a picture (PNG)"},
    {"a report as PDF, whose last page looks like a table",
     [](Sound& s) {
         s.first = "%PDF-1.4\nxref\n";
         for (int i = 0; i < 20; ++i) s.first += fmt::format("{:010} 00000 n\n", 17 * i);
     },
     "0.csv: is a PDF"},
    {"bytes", [](Sound& s) { s.first = std::string("ab\0\1\0\0\2cdefghijklmn", 18); },
     "0.csv: is a binary file"},
    {"names that nobody knows", [](Sound& s) { s.first.replace(0, s.first.find('\n'), "A,B,C,D"); },
     "no column of the force was found"},
    {"a column that is not there", [](Sound& s) { s.first_test += "columns = { force = \"Lod (N)\" }\n"; },
     "did you mean Load (N)?"},
    {"a constant displacement", on_rows([](auto& v, std::size_t) { v[1] = 3.0; }),
     "the displacement never changes"},
    {"a cycle that is not there", [](Sound& s) { s.first_test += "cycle = 4\n"; },
     "there is no cycle 4: the file has 1"},
    {"widths in centimetres without saying so", on_rows([](auto& v, std::size_t) { v[3] *= 0.1; }),
     "make no sense and were left out", true},
    {"stretched too little for the pre-stretch", [](Sound& s) { s.head = "prestretch = 2.4\n" + s.head; },
     "beyond the data the law is a guess", true},
    {"no thickness", [](Sound& s) { s.head = "[fabric]\npoissons_ratio = 0.3\n"; },
     "thickness was not measured", true},
    {"a force without unit", [](Sound& s) { s.first.replace(s.first.find(" (N)"), 4, ""); },
     "does not say the unit of its force: N assumed", true},
    {"a cantilever longer than its strip",
     [](Sound& s) { s.tail = "[[cantilever]]\nlength_mm = 50\nx_mm = 80\ny_mm = 10\n"; },
     "farther from the clamp than the strip"},
    {"a mass without area", [](Sound& s) { s.head += "sample_mass_g = 2\n"; }, "sample_area_mm2: missing"},
};

Calibration run(const TestFolder& folder, const Sound& sound) {
    std::string campaign = sound.head + "[[tension]]\n" + sound.first_test + "grips = \"dogbone\"\n";
    folder.write("0.csv", sound.first);
    for (const double angle : sound.others) {
        folder.write(fmt::format("{}.csv", angle),
                     machine_csv(exact_curve(Material{}, angle, 1.7, 24), Material{}));
        campaign += fmt::format(
            "[[tension]]\nfile = \"{0}.csv\"\nangle_deg = {0}\nlength_mm = 110\nwidth_mm = 20\n"
            "grips = \"dogbone\"\n",
            angle);
    }
    return calibrate(parse_campaign(campaign + sound.tail, folder.path() + "/campaign.toml"));
}

Sound sound_campaign() {
    Sound sound;
    sound.first = machine_csv(exact_curve(Material{}, 0.0, 1.7, 24), Material{});
    return sound;
}

}  // namespace

TEST_CASE("bad data: the campaign that the cases spoil is sound") {
    const TestFolder folder("bad-data-none");
    const Calibration result = run(folder, sound_campaign());
    CHECK(result.sets[0].fit.material.alpha_1 == doctest::Approx(Material{}.alpha_1).epsilon(0.2));
}

TEST_CASE("bad data: every case is refused with file and row, or warned of in the card") {
    for (std::size_t i = 0; i < std::size(cases); ++i) {
        const Case& c = cases[i];
        CAPTURE(c.name);
        const TestFolder folder(fmt::format("bad-data-{}", i));
        Sound sound = sound_campaign();
        c.change(sound);
        if (!c.is_warning) {
            CHECK_THROWS_WITH_AS(run(folder, sound), doctest::Contains(c.message.c_str()), InputError);
            continue;
        }
        const Calibration result = run(folder, sound);
        bool warned = false;
        std::string all;
        for (const std::string& warning : result.card.warnings) {
            warned = warned || warning.find(c.message) != std::string::npos;
            all += warning + "\n";
        }
        CHECK_MESSAGE(warned, all);
    }
}

TEST_CASE("bad data: a file of 200 MB is refused at once, with what to do") {
    const TestFolder folder("bad-data-large");
    const std::string file = folder.write("large.csv", sound_campaign().first);
    std::filesystem::resize_file(file, 200U << 20U);
    CHECK_THROWS_WITH_AS(read_csv_table(file), doctest::Contains("is longer than 32 MB"), InputError);
    CHECK_THROWS_WITH_AS(read_csv_table(file), doctest::Contains("Export it with fewer"), InputError);
}
