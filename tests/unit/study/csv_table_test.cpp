#include "ruche/study/calibration/csv_table.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "ruche/core/error.hpp"
#include "ruche/study/calibration/csv_cells.hpp"
#include "ruche/study/calibration/test_record.hpp"

using namespace ruche;

namespace {

/// The same three rows, as machines and people write them.
struct Dialect {
    std::string name;
    std::string bytes;
};

std::string utf16(const std::string& ascii) {
    std::string bytes = "\xFF\xFE";
    for (const char c : ascii) bytes += {c, '\0'};
    return bytes;
}

const Dialect dialects[] = {
    {"plain", "time_s,displacement_mm,force_N\n0,0,0.5\n1,1.25,1000.5\n2,2.5,2\n"},
    {"Bluehill",
     "\"Results Table 1\"\r\n\"Operator\",\"A, B\"\r\n\r\n\"Time\",\"Extension\",\"Load\"\r\n"
     "\"(s)\",\"(mm)\",\"(N)\"\r\n\"0.0\",\"0.000\",\"0.5\"\r\n\"1.0\",\"1.250\",\"1,000.5\"\r\n"
     "\"2.0\",\"2.5\",\"2.0\"\r\n"},
    {"Bluehill with decimal commas",
     "\"Time\",\"Extension\",\"Load\"\n\"(s)\",\"(mm)\",\"(N)\"\n"
     "\"0,0\",\"0,000\",\"0,5\"\n\"1,0\",\"1,250\",\"1000,5\"\n\"2,0\",\"2,5\",\"2,0\"\n"},
    {"Zwick in Latin-1",
     "\"Pr\xFC"
     "fzeit\";\"Standardweg\";\"Standardkraft\"\n\"s\";\"mm\";\"N\"\n0,0;0,0;0,5\n"
     "1,0;1,25;1000,5\n2,0;2,5;2,0\n"},
    {"UTF-8 with a mark and thousands",
     "\xEF\xBB\xBFZeit [s];Traversenweg [mm];Kraft [N]\n0;0;0,5\n1;1,25;1.000,5\n2;2,5;2\n"},
    {"UTF-16", utf16("Time (s)\tExtension (mm)\tLoad (N)\r\n0\t0\t0.5\r\n1\t1.25\t1000.5\r\n2\t2.5\t2\r\n")},
    {"blanks and a comment", "# by hand\nt d F\n0 0 0.5\n1 1.25 1000.5\n2 2.5 2\n"},
    {"kilonewton and centimetres", "Load (kN);Extension (cm)\n0.0005;0\n1.0005;0.125\n0.002;0.25\n"},
    {"per cent of 100 mm", "Dehnung in %;Kraft in N\n0;0,5\n1,25;1000,5\n2,5;2\n"},
    {"a delimiter at each line's end",
     "Time (s);Extension (mm);Load (N);\n0;0;0.5;\n1;1.25;1000.5;\n2;2.5;2;\n"},
    {"French", "Temps (s)\tD\xC3\xA9placement (mm)\tForce (N)\n0\t0\t0,5\n1\t1,25\t1000,5\n2\t2,5\t2\n"},
};

}  // namespace

TEST_CASE("csv table: the same rows in every dialect give the same record") {
    for (const Dialect& dialect : dialects) {
        CAPTURE(dialect.name);
        const TestRecord record =
            read_record(parse_csv(dialect.bytes, "test.csv"), {.length_mm = 100.0, .width_mm = 20.0});
        REQUIRE(record.size() == 3);
        CHECK(record.force[0] == doctest::Approx(0.5).epsilon(1e-12));
        CHECK(record.force[1] == doctest::Approx(1000.5).epsilon(1e-12));
        CHECK(record.force[2] == doctest::Approx(2.0).epsilon(1e-12));
        CHECK(record.displacement[1] == doctest::Approx(1.25).epsilon(1e-12));
        CHECK(record.displacement[2] == doctest::Approx(2.5).epsilon(1e-12));
    }
}

TEST_CASE("csv table: a table of hung masses and lengths becomes force and displacement") {
    const std::string table =
        "mass_g,length_mm,width_mm,direction\n0,100,20,loading\n100,120,18.5,loading\n50,111,19,unloading\n";
    const TestRecord record =
        read_record(parse_csv(table, "test.csv"), {.length_mm = 100.0, .width_mm = 20.0});
    REQUIRE(record.size() == 3);
    CHECK(record.force[1] == doctest::Approx(0.980665).epsilon(1e-12));
    CHECK(record.displacement[2] == doctest::Approx(11.0).epsilon(1e-12));
    CHECK(record.width[1] == 18.5);
    CHECK(record.branch[0] == Branch::loading);
    CHECK(record.branch[2] == Branch::unloading);
    CHECK(record.driven_by_force);
}

TEST_CASE("cell number: decimal marks, thousands and words") {
    CHECK(cell_number("1,5", ',') == 1.5);
    CHECK(cell_number(" -1.234.567,5 ", ',') == -1234567.5);
    CHECK(cell_number("1,234.5", '.') == 1234.5);
    CHECK(cell_number("1e-3", '.') == 1e-3);
    for (const char* bad : {"", "NaN", "inf", "1.2.3", "12,34.5", "1,5", "abc", "1 2", "0x10"})
        CHECK_MESSAGE(std::isnan(cell_number(bad, '.')), bad);
}

TEST_CASE("csv table: columns can be named, numbered and given a unit") {
    const CsvTable table = parse_csv("a,b,c\n1,2,3\n4,5,6\n", "test.csv");
    const RecordContext context{.columns = {.force = "c", .displacement = "1", .force_unit = "gf"}};
    const TestRecord record = read_record(table, context);
    CHECK(record.force[1] == doctest::Approx(6 * 9.80665e-3).epsilon(1e-12));
    CHECK(record.displacement[1] == 4.0);
    CHECK(record.warnings.size() == 1);  // the displacement's unit is assumed
}
