#include "ruche/scene/state.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>
#include <type_traits>

#include "ruche/core/atomic_file.hpp"
#include "ruche/core/document.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/scene/write_scene.hpp"
#include "ruche/statics/transfer.hpp"

namespace ruche {

static_assert(std::endian::native == std::endian::little, "state files hold numbers as they lie in memory");

static constexpr std::string_view signature = "ruche state 1\n";

/// 64-bit FNV-1a, <http://www.isthe.com/chongo/tech/comp/fnv/>.
static std::uint64_t hash(std::string_view bytes) {
    std::uint64_t value = 14695981039346656037ULL;
    for (const char byte : bytes) value = (value ^ static_cast<unsigned char>(byte)) * 1099511628211ULL;
    return value;
}

namespace {

/// Numbers one after the other; lists after their length.
class Writer {
  public:
    template <class Number>
    void number(Number value) {
        static_assert(std::is_arithmetic_v<Number>);
        char raw[sizeof(Number)];
        std::memcpy(raw, &value, sizeof(Number));
        bytes.append(raw, sizeof(Number));
    }
    void text(std::string_view text) {
        number<std::uint64_t>(text.size());
        bytes += text;
    }
    template <class Range>
    void numbers(const Range& range) {
        for (const auto value : range) number(value);
    }
    std::string bytes;
};

/// The same backwards; `damaged` is thrown when the bytes do not suffice.
class Reader {
  public:
    Reader(std::string_view bytes, std::string path) : bytes_(bytes), path_(std::move(path)) {}

    template <class Number>
    Number number() {
        Number value;
        std::memcpy(&value, take(sizeof(Number)).data(), sizeof(Number));
        return value;
    }
    std::string text() { return std::string(take(number<std::uint64_t>())); }

    /// Length of a list whose entries have `size` bytes each.
    std::size_t length(std::size_t size) {
        const auto count = number<std::uint64_t>();
        if (count > bytes_.size() / size) damaged();
        return count;
    }
    [[noreturn]] void damaged() const {
        throw InputError({.file = path_}, "is a damaged state file: it is truncated or was changed",
                         "Run without --resume and --start.");
    }

  private:
    std::string_view take(std::size_t count) {
        if (count > bytes_.size()) damaged();
        const std::string_view taken = bytes_.substr(0, count);
        bytes_.remove_prefix(count);
        return taken;
    }
    std::string_view bytes_;
    std::string path_;
};

void append_mesh(Writer& out, const TriangleMesh& mesh) {
    out.number<std::uint64_t>(mesh.vertices.size());
    for (const Vec2& vertex : mesh.vertices) out.numbers(std::array{vertex.x(), vertex.y()});
    out.number<std::uint64_t>(mesh.triangles.size());
    for (const Triangle& triangle : mesh.triangles) out.numbers(triangle);
}

TriangleMesh read_mesh(Reader& in) {
    TriangleMesh mesh;
    mesh.vertices.resize(in.length(2 * sizeof(double)));
    for (Vec2& vertex : mesh.vertices)
        for (int k = 0; k < 2; ++k) vertex[k] = in.number<double>();
    mesh.triangles.resize(in.length(3 * sizeof(int)));
    for (Triangle& triangle : mesh.triangles)
        for (int& corner : triangle) {
            corner = in.number<int>();
            if (corner < 0 || corner >= mesh.vertex_count()) in.damaged();
        }
    return mesh;
}

template <class Struct>
void append_fields(Writer& out, const Struct& s) {
    for (const Field<Struct>& field : fields<Struct>()) out.text(to_string(get(s, field)));
}

}  // namespace

std::uint64_t fingerprint(const ModelInput& model) {
    Writer out;
    append_mesh(out, model.mesh);
    for (const Print& print : model.print)
        out.numbers(std::array{print.front, print.back, print.front_modulus, print.back_modulus});
    for (const Rod& rod : model.rods) {
        for (const int vertex : rod.vertices) out.number(vertex);
        out.numbers(std::array{rod.width, rod.thickness, rod.youngs_modulus});
        out.number(static_cast<int>(rod.side));
    }
    append_fields(out, model.material);
    append_fields(out, model.options);
    out.numbers(model.prestretch);
    out.number(model.fabric_axis_deg);
    out.numbers(model.gravity);
    for (const Support& support : model.supports) {
        out.number(support.vertex);
        out.numbers(support.fixed);
        out.numbers(support.at);
    }
    for (const NodalForce& force : model.forces) {
        out.number(force.vertex);
        out.numbers(force.force);
    }
    out.number(model.table.present);
    out.numbers(std::array{model.table.height, model.table.stiffness_per_area});
    return hash(out.bytes);
}

State state_of(const Result& result) {
    return {.scene = to_toml(result.scene),
            .fingerprint = fingerprint(scene_model(result.scene, result.layout)),
            .layout = result.layout.mesh,
            .x = result.equilibrium.x,
            .iterations = result.equilibrium.iterations};
}

std::string to_bytes(const State& state) {
    Writer out;
    out.bytes = signature;
    out.text(state.scene);
    out.number(state.fingerprint);
    append_mesh(out, state.layout);
    out.number<std::uint64_t>(static_cast<std::uint64_t>(state.x.size()));
    out.numbers(state.x);
    out.number(state.iterations);
    out.number(hash(out.bytes));
    return out.bytes;
}

void write_state(const std::string& path, const State& state) {
    write_file_atomically(path, to_bytes(state));
}

State read_state(const std::string& path) {
    constexpr std::size_t four_gigabytes = std::size_t{4} << 30U;
    const std::string bytes = read_file(path, "state file", four_gigabytes);
    if (!std::string_view(bytes).starts_with(signature))
        throw InputError({.file = path}, "is not a state file of this version of ruche",
                         "A result folder holds one as state.ruche.");
    const std::string_view body = std::string_view(bytes).substr(signature.size());
    Reader in(body, path);
    if (body.size() < sizeof(std::uint64_t)) in.damaged();
    const std::size_t end = bytes.size() - sizeof(std::uint64_t);
    if (Reader(std::string_view(bytes).substr(end), path).number<std::uint64_t>() !=
        hash(std::string_view(bytes).substr(0, end)))
        in.damaged();
    State state;
    state.scene = in.text();
    state.fingerprint = in.number<std::uint64_t>();
    state.layout = read_mesh(in);
    state.x.resize(static_cast<Eigen::Index>(in.length(sizeof(double))));
    for (double& unknown : state.x) {
        unknown = in.number<double>();
        if (!std::isfinite(unknown)) in.damaged();
    }
    state.iterations = in.number<int>();
    if (state.x.size() < Eigen::Index{3} * state.layout.vertex_count()) in.damaged();
    return state;
}

/// Values of a TOML text by "section.key"; what stands for them, as written.
static std::map<std::string, std::string> toml_lines(const std::string& text) {
    std::map<std::string, std::string> values;
    std::istringstream lines(text);
    std::string section;
    for (std::string line; std::getline(lines, line);) {
        const std::size_t equals = line.find(" = ");
        if (line.starts_with('[')) section = line.substr(0, line.find(']')).substr(line.rfind('[', 2) + 1);
        if (equals != std::string::npos)
            values[section + "." + line.substr(0, equals)] += line.substr(equals + 3);
    }
    return values;
}

/// "fabric.prestretch was [1.7, 1.7], now [1.6, 1.6]; ..." for at most three differences.
static std::string differences(const std::string& before, const std::string& now) {
    const auto old_values = toml_lines(before);
    std::string text;
    int count = 0;
    for (const auto& [key, value] : toml_lines(now)) {
        const auto old_value = old_values.find(key);
        const bool same = old_value != old_values.end() && old_value->second == value;
        if (same || key.starts_with("output.") || key.starts_with("solver.") || ++count > 3) continue;
        text += fmt::format("{}{} was {}, now {}", text.empty() ? "" : "; ", key,
                            old_value != old_values.end() ? old_value->second : "not there", value);
    }
    return text.empty() ? "the drawing or the mesh has changed" : text;
}

Eigen::VectorXd resume_from(const State& state, const Scene& scene, const ModelInput& model,
                            const std::string& path) {
    if (state.fingerprint != fingerprint(model))
        throw InputError({.file = path},
                         "belongs to another scene: " + differences(state.scene, to_toml(scene)),
                         "Use --start to take only the shape from it, or run without --resume.");
    return state.x;
}

static bool same_mesh(const TriangleMesh& a, const TriangleMesh& b) {
    return a.vertices == b.vertices && a.triangles == b.triangles;
}

Eigen::VectorXd start_from(const State& state, const Model& model) {
    if (same_mesh(state.layout, model.input().mesh) && state.x.size() == model.size()) return state.x;
    Retraction retraction(model);
    return transfer({.layout = state.layout, .print = {}, .x = state.x}, model, retraction);
}

}  // namespace ruche
