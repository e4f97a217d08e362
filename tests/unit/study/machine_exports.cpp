#include "machine_exports.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "synthetic_tests.hpp"

namespace ruche::test {

Test test_of(int cycles, int rows) {
    const Material material;
    const LawCurve curve = exact_curve(material, 0.0, 1.7, rows);
    Test test;
    const auto read = [&](std::size_t i, double factor) {
        test.push_back({0.2 * static_cast<double>(test.size()), sample_length * (curve.stretch[i] - 1.0),
                        factor * curve.nominal_stress[i] * sample_width * material.fabric_thickness,
                        sample_width * stretch_of(curve.transverse[i])});
    };
    for (int cycle = 0; cycle < cycles; ++cycle) {
        for (std::size_t i = curve.stretch.size(); i-- > 1;) read(i, 1.1);
        for (std::size_t i = 0; i < curve.stretch.size(); ++i) read(i, 1.0);
    }
    return test;
}

std::string replaced(std::string text, char what, char by) {
    std::replace(text.begin(), text.end(), what, by);
    return text;
}

std::string rows_of(const Test& test, const std::function<std::string(const Reading&)>& row) {
    std::string text;
    for (const Reading& r : test) text += row(r);
    return text;
}

std::string plain_row(const Reading& r) {
    return fmt::format("{:.2f},{:.5f},{:.6f}\n", r.time, r.displacement, r.force);
}
std::string quoted_row(const Reading& r) {
    return fmt::format("\"{:.5f}\",\"{:.5f}\",\"{:.5f}\"\r\n", r.time, r.displacement, r.force);
}
std::string german_row(const Reading& r) {
    return replaced(fmt::format("{:.2f};{:.5f};{:.5f};{:.4f}\r\n", r.time, r.force, r.displacement, r.width),
                    '.', ',');
}

Test changed(Test test, const std::function<void(Reading&)>& change) {
    for (Reading& r : test) change(r);
    return test;
}

namespace {

/// UTF-16 as Windows has it.
std::string utf16_of(const std::string& ascii, bool with_mark) {
    std::string bytes = with_mark ? "\xFF\xFE" : "";
    for (const char c : ascii) bytes += {c, '\0'};
    return bytes;
}

}  // namespace

std::vector<Export> other_layouts() {
    std::vector<Export> all;
    const Test test = test_of(1);
    const Test weak = changed(test, [](Reading& r) { r.force *= 0.5; });
    const std::string results =
        "\"Results Table 1\"\r\n\"\",\"Maximum Load\",\"Tensile strain at Maximum Load\"\r\n"
        "\"\",\"(N)\",\"(%)\"\r\n\"1\",\"2.284\",\"70.0\"\r\n\"2\",\"2.301\",\"70.0\"\r\n"
        "\"Mean\",\"2.29\",\"70.0\"\r\n\"Standard deviation\",\"0.01\",\"0.0\"\r\n";
    const std::string raw = "\"Raw Data\"\r\n" + bluehill_names + rows_of(test, quoted_row);
    all.push_back(
        {"Instron Bluehill Universal: UTF-16, method parameters and results above, titles of blocks",
         utf16_of("\"Method Parameters\"\r\n\"Sample name\",\"knit\"\r\n\"Rate 1\",\"100\","
                  "\"mm/min\"\r\n\r\n" +
                      results + "\r\n" + raw,
                  true),
         "", ""});
    all.push_back({"Instron Bluehill Universal: results and statistics below the readings",
                   raw + "\r\n\r\n" + results, "", ""});
    all.push_back({"results right below the readings, without titles",
                   raw + "\"Mean\",\"38.5\",\"0.92\"\r\n\"Maximum\",\"77.0\",\"2.28\"\r\n", "", ""});
    all.push_back(
        {"Instron Bluehill Universal: specimens with their results in between, the first chosen",
         raw + results + "\"Specimen 2\"\r\n" + bluehill_names + rows_of(weak, quoted_row) + results,
         "specimen = 1\n", ""});
    all.push_back({"Instron Bluehill in German: the separator named in the first line, Verfahrweg",
                   "sep=;\r\nZeit;Verfahrweg;Kraft\r\n(s);(mm);(N)\r\n" +
                       rows_of(test,
                               [](const Reading& r) {
                                   return replaced(fmt::format("{:.3f};{:.5f};{:.5f}\r\n", r.time,
                                                               r.displacement, r.force),
                                                   '.', ',');
                               }),
                   "", ""});
    all.push_back({"Zwick testXpert, the .TRA file: commas, Latin-1, strain in per cent",
                   "\"Pr\xFC"
                   "fzeit\",\"Dehnung\",\"Standardkraft\"\r\n\"s\",\"%\",\"N\"\r\n" +
                       rows_of(test,
                               [](const Reading& r) {
                                   return fmt::format("{:.3f},{:.6f},{:.6f}\r\n", r.time,
                                                      r.displacement / 1.1, r.force);
                               }),
                   "", ""});
    all.push_back({"Lloyd Nexygen: the batch above, statistics below",
                   "Batch reference:,knit 7\nTest date:,03/05/2024 10:11\nPreload:,0.01,N\n\n"
                   "Load (N),Machine extension (mm),Extension from preload (mm),Time (s)\n" +
                       rows_of(test,
                               [](const Reading& r) {
                                   return fmt::format("{0:.5f},{1:.5f},{1:.5f},{2:.2f}\n", r.force,
                                                      r.displacement, r.time);
                               }) +
                       "\nStatistics,Load (N),Machine extension (mm),Work (J)\nMaximum,2.284,77.000,0.1\n"
                       "Mean,2.284,77.000,0.1\n",
                   "", ""});
    all.push_back({"MTS TestWorks: tabs, crosshead and load, units below",
                   "Sample ID:\tknit-7.mss\nMethod:\tcyclic.msm\nSpecimen Results:\nName\tValue\tUnits\n"
                   "Width\t20.000\tmm\nPeak Load\t2.284\tN\n\nCrosshead\tLoad\tTime\nmm\tN\tsec\n" +
                       rows_of(test,
                               [](const Reading& r) {
                                   return fmt::format("{:.6f}\t{:.6f}\t{:.3f}\n", r.displacement, r.force,
                                                      r.time);
                               }),
                   "", ""});
    all.push_back({"MTS TestSuite: units in brackets in a row below, kilonewton",
                   "\"Axial Count\",\"Axial Displacement\",\"Axial Force\",\"Running Time\"\r\n"
                   "\"(cycles)\",\"(mm)\",\"(kN)\",\"(s)\"\r\n" +
                       rows_of(test,
                               [](const Reading& r) {
                                   return fmt::format("\"1\",\"{:.6f}\",\"{:.9f}\",\"{:.3f}\"\r\n",
                                                      r.displacement, 1e-3 * r.force, r.time);
                               }),
                   "", ""});
    all.push_back({"Tinius Olsen Horizon: UTF-16 without a mark, tabs",
                   utf16_of("Test\tknit cyclic\r\n\r\nTime (s)\tForce (N)\tPosition (mm)\r\n" +
                                rows_of(test,
                                        [](const Reading& r) {
                                            return fmt::format("{:.2f}\t{:.6f}\t{:.5f}\r\n", r.time, r.force,
                                                               r.displacement);
                                        }),
                            false),
                   "", ""});
    all.push_back({"CellScale: a word in front, the size beside the displacement, units behind a dash",
                   "SetName,Cycle,Time_S,Size_mm,Displacement_mm,Force_N\n" +
                       rows_of(test,
                               [](const Reading& r) {
                                   return fmt::format("stretch,1,{:.2f},{:.5f},{:.5f},{:.6f}\n", r.time,
                                                      sample_length + r.displacement, r.displacement,
                                                      r.force);
                               }),
                   "", ""});
    all.push_back({"quoted numbers in groups of thousands",
                   "\"Time\",\"Extension\",\"Load\"\n\"(s)\",\"(mm)\",\"(mN)\"\n" +
                       rows_of(test,
                               [](const Reading& r) {
                                   const double mn = 1e3 * r.force;
                                   const int thousands = static_cast<int>(mn / 1e3);
                                   const std::string load =
                                       mn < 1e3 ? fmt::format("{:.3f}", mn)
                                                : fmt::format("{},{:07.3f}", thousands, mn - 1e3 * thousands);
                                   return fmt::format("\"{:.1f}\",\"{:.5f}\",\"{}\"\n", r.time,
                                                      r.displacement, load);
                               }),
                   "", ""});
    const std::string gauge = rows_of(
        test, [](const Reading& r) { return fmt::format("{:.6f},N,{:.5f},mm\n", r.force, r.displacement); });
    all.push_back({"a hand-held gauge: units in the cells, no names", gauge, "",
                   "no column of the force was found among 4 columns without names"});
    all.push_back({"a hand-held gauge, its columns said", gauge,
                   "columns = { force = \"1\", displacement = \"3\", force_unit = \"N\", displacement_unit = "
                   "\"mm\" }\n",
                   ""});
    return all;
}

}  // namespace ruche::test
