// Tension tests as the programs of testing machines export them. Each file is made here from the same test,
// with that program's habits; each is read to the same stress and strain, or refused with what to do.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "machine_exports.hpp"
#include "ruche/study/calibration/calibration.hpp"
#include "synthetic_tests.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

const std::string zwick_names =
    "Pr\xFC"
    "fzeit;Standardkraft;Standardweg;Breite\r\ns;N;mm;mm\r\n";

std::string several(const std::string& head, const Test& first, const Test& second,
                    const std::function<std::string(const Reading&)>& row) {
    return head + rows_of(first, row) + "\r\n\"Specimen 2\"\r\n" + head + rows_of(second, row);
}

std::vector<Export> exports() {
    const Test test = test_of(1);
    const Test cycles = test_of(5);
    const Test weak = changed(test, [](Reading& r) { r.force *= 0.5; });
    std::vector<Export> all;
    all.push_back(
        {"Instron Bluehill 2: a block of results above, quotes, a row of units",
         "\"Bluehill Results\"\r\n\"Sample note 1\",\"knit, white\"\r\n\"Results Table 1\"\r\n"
         "\"\",\"Maximum Load\",\"Tensile strain at Maximum Load\"\r\n\"\",\"(N)\",\"(%)\"\r\n"
         "\"1\",\"2.284\",\"70.0\"\r\n\"2\",\"2.301\",\"70.0\"\r\n\"Mean\",\"2.29\",\"70.0\"\r\n\r\n"
         "\"Specimen 1\"\r\n" +
             bluehill_names + rows_of(test, quoted_row),
         "", ""});
    all.push_back(
        {"Instron Bluehill 3: many columns, units in brackets behind names in brackets",
         "Time (s),Extension (mm),Load (N),Tensile strain (Extension) (%),Tensile stress (MPa),Cycle\r\n" +
             rows_of(test,
                     [](const Reading& r) {
                         return fmt::format("{:.3f},{:.5f},{:.5f},{:.4f},{:.6f},1\r\n", r.time,
                                            r.displacement, r.force, r.displacement / 1.1, r.force / 9.2);
                     }),
         "", ""});
    all.push_back({"Instron WaveMatrix: channels in the names",
                   "\"Total Time (s)\",\"Total Cycles\",\"Position(Linear:Digital Position) (mm)\","
                   "\"Load(Linear:Load) (kN)\"\r\n" +
                       rows_of(cycles,
                               [](const Reading& r) {
                                   return fmt::format("{:.3f},{},{:.5f},{:.9f}\r\n", r.time, 1,
                                                      r.displacement, 1e-3 * r.force);
                               }),
                   "", ""});
    const std::string two = several(bluehill_names, test, weak, quoted_row);
    all.push_back({"several specimens, one below the other", two, "",
                   "has 2 specimens: tables begin at the lines 3, 126"});
    all.push_back({"several specimens, one chosen", two, "specimen = 1\n", ""});
    all.push_back({"a specimen that is not there", two, "specimen = 3\n", "there is no specimen 3"});
    all.push_back({"Zwick testXpert: Latin-1, semicolons, decimal commas, the force first",
                   "Pr\xFC"
                   "fvorschrift;Zug zyklisch\r\nPr\xFC"
                   "fer;M\xFCller\r\nVorkraft;0,01;N\r\n\r\n" +
                       zwick_names + rows_of(cycles, german_row),
                   "", ""});
    all.push_back({"Zwick testXpert: three decimals, which look like thousands",
                   zwick_names + rows_of(changed(test, [](Reading& r) { r.force *= 1000.0; }),
                                         [](const Reading& r) {
                                             return replaced(
                                                 fmt::format("{:.3f};{:.3f};{:.3f};{:.3f}\r\n", r.time,
                                                             r.force, r.displacement, r.width),
                                                 '.', ',');
                                         }),
                   "columns = { force_unit = \"mN\" }\n", ""});
    all.push_back({"Zwick: strain in per cent",
                   "Standardkraft [cN];Nominelle Dehnung [%]\n" +
                       rows_of(test,
                               [](const Reading& r) {
                                   return replaced(
                                       fmt::format("{:.4f};{:.5f}\n", 100.0 * r.force, r.displacement / 1.1),
                                       '.', ',');
                               }),
                   "", ""});
    all.push_back(
        {"MTS TestSuite: tabs, axial channels, units below",
         "MTS793|MPT|ENU|1|2|.|/|:|1|0|0|A\n\nData Header:\tTime:\t0.2\tSec\nStation Name:\tfabric.cfg\n"
         "Axial Displacement\tAxial Force\tRunning Time\nmm\tN\tSec\n" +
             rows_of(test,
                     [](const Reading& r) {
                         return fmt::format("{:.7E}\t{:.7E}\t{:.7E}\n", r.displacement, r.force, r.time);
                     }),
         "", ""});
    const std::string side_by_side =
        "\"Name\",\"1 _ 1\",\"\",\"1 _ 2\",\"\"\r\n\"Time\",\"Force\",\"Stroke\",\"Force\",\"Stroke\"\r\n"
        "\"sec\",\"N\",\"mm\",\"N\",\"mm\"\r\n" +
        rows_of(test, [](const Reading& r) {
            return r.time < 15.0 ? fmt::format("{},{},{},{},{}\r\n", r.time, r.force, r.displacement,
                                               0.5 * r.force, r.displacement)
                                 : fmt::format("{},{},{},,\r\n", r.time, r.force, r.displacement);
        });
    all.push_back({"Shimadzu Trapezium: specimens side by side", side_by_side, "",
                   "the columns 2, 4 are all called \"Force\""});
    all.push_back(
        {"Shimadzu Trapezium: the first of those side by side", side_by_side, "specimen = 1\n", ""});
    all.push_back({"Mark-10 MESUR: pound-force and inches",
                   "Reading,Load [lbF],Travel [in],Time [sec.]\n" +
                       [&] {
                           int number = 0;
                           return rows_of(test, [&number](const Reading& r) {
                               return fmt::format("{},{:.7f},{:.7f},{:.3f}\n", ++number,
                                                  r.force / 4.4482216152605, r.displacement / 25.4, r.time);
                           });
                       }(),
                   "", ""});
    all.push_back({"Stable Micro Systems: force in gram, distance, no time",
                   "Force (g)\tDistance (mm)\n" + rows_of(test,
                                                          [](const Reading& r) {
                                                              return fmt::format("{:.4f}\t{:.5f}\n",
                                                                                 r.force / 9.80665e-3,
                                                                                 r.displacement);
                                                          }),
                   "", ""});
    all.push_back({"time of day, and a date in each row",
                   "Date;Time;Force [N];Position [mm];\n" +
                       rows_of(test,
                               [](const Reading& r) {
                                   return fmt::format("2024-05-03;10:11:{:04.1f};{:.6f};{:.5f};\n", r.time,
                                                      r.force, r.displacement);
                               }),
                   "", ""});
    all.push_back({"a word in each row, and empty columns at the end",
                   "Step,Force (N),Displacement (mm),,,\n" +
                       rows_of(test,
                               [](const Reading& r) {
                                   return fmt::format("Cycle 1,{:.6f},{:.5f},,,\n", r.force, r.displacement);
                               }),
                   "", ""});
    all.push_back({"French: thousands with narrow blanks, a decimal comma, micrometres",
                   "Temps (s);Force (mN);D\xC3\xA9placement (\xC2\xB5m)\n" +
                       rows_of(test,
                               [](const Reading& r) {
                                   const int um = static_cast<int>(std::lround(1e3 * r.displacement));
                                   const std::string grouped =
                                       um < 1000 ? fmt::format("{}", um)
                                                 : fmt::format("{}\xE2\x80\xAF{:03}", um / 1000, um % 1000);
                                   return replaced(fmt::format("{:.1f};{:.3f};", r.time, 1e3 * r.force), '.',
                                                   ',') +
                                          grouped + ",0\n";
                               }),
                   "", ""});
    all.push_back({"numpy: names in a remark",
                   "# displacement_mm force_N\n" + rows_of(test,
                                                           [](const Reading& r) {
                                                               return fmt::format("{:.18e} {:.18e}\n",
                                                                                  r.displacement, r.force);
                                                           }),
                   "", ""});
    all.push_back({"the names again in the middle, the time going on",
                   [&] {
                       std::string text;
                       for (std::size_t i = 0; i < test.size(); ++i) {
                           if (i % 50 == 0) text += "\nPage\nTime (s),Extension (mm),Load (N)\n";
                           text += plain_row(test[i]);
                       }
                       return text;
                   }(),
                   "", ""});
    all.push_back({"strain without a unit",
                   "Time (s),Strain,Load (N)\n" + rows_of(test,
                                                          [](const Reading& r) {
                                                              return fmt::format(
                                                                  "{:.2f},{:.7f},{:.6f}\n", r.time,
                                                                  r.displacement / sample_length, r.force);
                                                          }),
                   "", "\"Strain\" has no unit"});
    all.push_back({"strain as a ratio, said to be",
                   "Time (s),Strain,Load (N)\n" + rows_of(test,
                                                          [](const Reading& r) {
                                                              return fmt::format(
                                                                  "{:.2f},{:.7f},{:.6f}\n", r.time,
                                                                  r.displacement / sample_length, r.force);
                                                          }),
                   "columns = { displacement_unit = \"mm/mm\" }\n", ""});
    const std::string names = "Time (s),Extension (mm),Load (N)\n";
    all.push_back({"tension negative",
                   names + rows_of(changed(test, [](Reading& r) { r.force = -r.force; }), plain_row), "",
                   "warning: its sign was turned"});
    all.push_back(
        {"the distance between the grips in place of a displacement",
         names + rows_of(changed(test, [](Reading& r) { r.displacement += sample_length; }), plain_row), "",
         "warning: taken for the distance between the grips"});
    all.push_back(
        {"a crosshead that was not set to zero",
         names +
             rows_of(changed(test, [&](Reading& r) { r.displacement += 312.5 - test.front().displacement; }),
                     plain_row),
         "", "warning: it was taken for a position"});
    all.push_back({"a load cell that was not set to zero",
                   names + rows_of(changed(test, [](Reading& r) { r.force += 0.4; }), plain_row), "",
                   "warning: the load cell was not set to zero, or the sample was pre-loaded"});
    all.push_back({"kilonewton with three decimals",
                   "Time (s),Extension (mm),Load (kN)\n" + rows_of(test_of(2, 120),
                                                                   [](const Reading& r) {
                                                                       return fmt::format(
                                                                           "{:.2f},{:.5f},{:.3f}\n", r.time,
                                                                           r.displacement, 1e-3 * r.force);
                                                                   }),
                   "", "warning: different values only"});
    all.push_back({"numbers without names", rows_of(test, plain_row), "",
                   "no column of the force was found among 3 columns without names"});
    all.push_back({"numbers without names, by their columns", rows_of(test, plain_row),
                   "columns = { displacement = \"2\", force = \"3\", force_unit = \"N\", displacement_unit = "
                   "\"mm\" }\n",
                   ""});
    for (Export& layout : other_layouts()) all.push_back(std::move(layout));
    return all;
}

/// Largest errors over full scale, against the unloading as it was.
double error_of(const TensionCurve& curve) {
    const LawCurve exact = exact_curve(Material{}, 0.0, 1.7, 60);
    // The row at the peak is the last of the loading; all cycles are the same.
    const std::size_t cycles = curve.cycles.size();
    REQUIRE(curve.used.size() == cycles);
    REQUIRE(curve.stretch.size() == cycles * (exact.stretch.size() - 1));
    double error = 0.0;
    for (std::size_t i = 0; i < curve.stretch.size(); ++i) {
        const std::size_t k = 1 + i / cycles;
        error = std::max(error, std::abs(curve.stretch[i] - exact.stretch[k]));
        error = std::max(
            error, std::abs(curve.nominal_stress[i] - exact.nominal_stress[k]) / exact.nominal_stress[0]);
    }
    return error;
}

TensionCurve read(const TestFolder& folder, const Export& file) {
    folder.write("test.csv", file.bytes);
    const std::string campaign =
        "[[tension]]\nfile = \"test.csv\"\nangle_deg = 0\nlength_mm = 110\nwidth_mm = 20\n" + file.more;
    const Campaign read = parse_campaign(campaign, folder.path() + "/campaign.toml");
    return read_tension_curve(read.tension[0], Material{}.fabric_thickness);
}

}  // namespace

TEST_CASE("machine exports: each is read to the same stress and strain, or says what is wrong") {
    const TestFolder folder("machine-exports");
    for (const Export& file : exports()) {
        CAPTURE(file.name);
        const bool warns = file.trouble.starts_with("warning: ");
        if (!file.trouble.empty() && !warns) {
            CHECK_THROWS_WITH_AS(read(folder, file), doctest::Contains(file.trouble.c_str()), InputError);
            continue;
        }
        try {
            const TensionCurve curve = read(folder, file);
            std::string warnings;
            for (const std::string& warning : curve.warnings) warnings += warning + "\n";
            if (warns) {
                CHECK_MESSAGE(warnings.find(file.trouble.substr(9)) != std::string::npos, warnings);
                continue;
            }
            CHECK_MESSAGE(warnings.empty(), warnings);
            // What the coarsest of them rounds to: micrometres of 110 mm.
            CHECK(error_of(curve) < 2e-5);
        } catch (const InputError& error) {
            FAIL_CHECK(error.what());
        }
    }
}
