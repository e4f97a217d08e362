#include "ruche/study/calibration/campaign.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "ruche/core/table_reader.hpp"

namespace ruche {
namespace {

/// A number or a list of numbers.
std::vector<double> numbers_of(TableReader& reader, FieldInfo field) {
    std::vector<double> numbers;
    const Node* node = reader.take(field.key);
    if (node == nullptr) return numbers;
    const std::string path = reader.path_of(field.key);
    field.kind = FieldKind::number;
    if (node->kind != Node::Kind::array) return {std::get<double>(read_value(*node, field, path))};
    for (const Node& item : node->items) numbers.push_back(std::get<double>(read_value(item, field, path)));
    return numbers;
}

/// Fields and lists of readings.
template <class Struct>
void read_all(TableReader& reader, Struct& s) {
    reader.read(s);
    for (const Readings<Struct>& list : readings<Struct>()) s.*list.values = numbers_of(reader, list.about);
}

void require(const TableReader& reader, std::span<const std::string_view> keys) {
    for (const std::string_view key : keys)
        if (!reader.has(key))
            throw InputError(reader.place_of_key(key), "missing",
                             "Every test says what was measured: this cannot be guessed.");
}

void find_file(TestFile& test, const std::string& folder) {
    std::filesystem::path path(test.file);
    if (path.is_relative() && !folder.empty()) path = std::filesystem::path(folder) / path;
    test.file = path.lexically_normal().string();
}

/// Reads campaigns; `columns` of the file are those of every test that says nothing else.
class Reader {
  public:
    Reader(Campaign& campaign, const Node& root)
        : campaign_(campaign),
          root_(root, ""),
          folder_(std::filesystem::path(campaign.file).parent_path().string()) {}

    void read() {
        root_.read(campaign_.options);
        if (const Node* node = root_.take_table("columns")) {
            TableReader reader(*node, "columns");
            reader.read(columns_);
            reader.finish();
        }
        read_fabric();
        read_plastic();
        for (const Node* node : root_.take_tables("tension")) read_tension(*node);
        for (const Node* node : root_.take_tables("shear")) read_shear(*node);
        for (const Node* node : root_.take_tables("cantilever")) read_cantilever(*node);
        for (const Node* node : root_.take_tables("plastic_tension")) read_plastic_tension(*node);
        for (const Node* node : root_.take_tables("printed")) read_printed(*node);
        if (const Node* node = root_.take_table("printed_fit")) {
            TableReader reader(*node, "printed_fit");
            reader.read(campaign_.printed_fit);
            reader.finish();
        }
        root_.finish();
        if (campaign_.tension.empty() && campaign_.printed.empty())
            throw InputError({.file = campaign_.file}, "has neither [[tension]] nor [[printed]]",
                             "A campaign names the files of tension tests, or the radii of printed samples.");
    }

  private:
    void read_fabric() {
        const Node* node = root_.take_table("fabric");
        if (node == nullptr) return;
        TableReader reader(*node, "fabric");
        FabricMeasurements& f = campaign_.fabric;
        read_all(reader, f);
        reader.finish();
        if (!f.sample_mass_g.empty() && f.sample_area_mm2 <= 0.0)
            throw InputError(reader.place_of_key("sample_area_mm2"), "missing",
                             "sample_mass_g is the mass of what area?");
        if (f.youngs_modulus == YoungsModulusChoice::stated && f.youngs_modulus_mpa <= 0.0)
            throw InputError(reader.place_of_key("youngs_modulus_mpa"), "missing",
                             "youngs_modulus = \"stated\" needs the value.");
    }

    void read_plastic() {
        const Node* node = root_.take_table("plastic");
        if (node == nullptr) return;
        TableReader reader(*node, "plastic");
        read_all(reader, campaign_.plastic);
        reader.finish();
    }

    template <class Test>
    TableReader begin(const Node& node, std::string_view name, std::size_t number, Test& test) {
        TableReader reader(node, fmt::format("{}.{}", name, number));
        test.place = place_of(node, fmt::format("{}.{}", name, number));
        read_all(reader, test);
        require(reader, required_keys<Test>());
        return reader;
    }

    /// What all tests with a file have in common.
    void finish(TableReader& reader, TestFile& test) const {
        find_file(test, folder_);
        test.columns = columns_;
        if (const Node* node = reader.take_table("columns")) {
            TableReader own(*node, reader.path_of("columns"));
            own.read(test.columns);
            own.finish();
        }
        reader.finish();
    }

    void read_tension(const Node& node) {
        TensionTest test;
        test.prestretch = campaign_.options.prestretch;
        TableReader reader = begin(node, "tension", campaign_.tension.size() + 1, test);
        finish(reader, test);
        if (test.branch == Branch::unknown)
            throw InputError(reader.place_of_key("branch"), "expected \"unloading\" or \"loading\"");
        campaign_.tension.push_back(test);
    }

    void read_shear(const Node& node) {
        ShearTest test;
        TableReader reader = begin(node, "shear", campaign_.shear.size() + 1, test);
        finish(reader, test);
        campaign_.shear.push_back(test);
    }

    void read_plastic_tension(const Node& node) {
        PlasticTest test;
        TableReader reader = begin(node, "plastic_tension", campaign_.plastic_tension.size() + 1, test);
        finish(reader, test);
        campaign_.plastic_tension.push_back(test);
    }

    void read_cantilever(const Node& node) {
        CantileverTest test;
        TableReader reader = begin(node, "cantilever", campaign_.cantilever.size() + 1, test);
        reader.finish();
        if (test.side != "front" && test.side != "back")
            throw InputError(reader.place_of_key("side"),
                             fmt::format("\"{}\" is none of front, back", test.side));
        if (test.x_mm.size() != test.length_mm.size() || test.y_mm.size() != test.length_mm.size())
            throw InputError(reader.place_of_key("length_mm"),
                             fmt::format("{} lengths, {} x and {} y", test.length_mm.size(), test.x_mm.size(),
                                         test.y_mm.size()),
                             "Each overhang has one x and one y.");
        for (std::size_t i = 0; i < test.x_mm.size(); ++i) {
            if (std::hypot(test.x_mm[i], test.y_mm[i]) <= 1.05 * test.length_mm[i]) continue;
            throw InputError(
                reader.place_of_key("x_mm"),
                fmt::format("the tip at ({}, {}) mm is farther from the clamp than the strip of {} "
                            "mm is long",
                            test.x_mm[i], test.y_mm[i], test.length_mm[i]),
                "x and y are measured from the edge where the overhang begins.");
        }
        campaign_.cantilever.push_back(test);
    }

    void read_printed(const Node& node) {
        PrintedSample sample{.prestretch = campaign_.options.prestretch};
        TableReader reader = begin(node, "printed", campaign_.printed.size() + 1, sample);
        if (sample.scene.empty()) {
            static constexpr std::string_view keys[] = {"length_mm", "width_mm", "thickness_mm"};
            require(reader, keys);
        } else if (!folder_.empty() && std::filesystem::path(sample.scene).is_relative()) {
            sample.scene = (std::filesystem::path(folder_) / sample.scene).lexically_normal().string();
        }
        reader.finish();
        campaign_.printed.push_back(sample);
    }

    Campaign& campaign_;
    TableReader root_;
    std::string folder_;
    ColumnOptions columns_;
};

Campaign campaign_of(const Node& root, const std::string& file) {
    Campaign campaign{.file = file};
    Reader(campaign, root).read();
    if (campaign.options.name.empty()) campaign.options.name = std::filesystem::path(file).stem().string();
    return campaign;
}

}  // namespace

Campaign read_campaign(const std::string& path) { return campaign_of(read_toml(path), path); }

Campaign parse_campaign(const std::string& text, const std::string& file) {
    return campaign_of(parse_toml(text, file), file);
}

}  // namespace ruche
