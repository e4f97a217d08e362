#include "ruche/studio/workspace.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <fstream>

#include "ruche/core/error.hpp"

using namespace ruche;
namespace fs = std::filesystem;

namespace {

/// A folder "work" beside a secret; "work/out" and "work/out.svg" are links that lead out.
class Neighbourhood {
  public:
    Neighbourhood() : path_(fs::temp_directory_path() / ("ruche-workspace-" + std::to_string(getpid()))) {
        fs::create_directories(path_ / "work" / "run.out");
        write("secret.svg", "<svg/>");
        write("work/d.svg", "<svg/>");
        write("work/run.out/report.json", "{}");
        write("work/run.out/shape.obj", "v 0 0 0");
        write("work/run.out/state.ruche", "...");
        fs::create_symlink(path_, path_ / "work" / "out");
        fs::create_symlink(path_ / "secret.svg", path_ / "work" / "out.svg");
        fs::create_symlink(path_ / "work" / "d.svg", path_ / "work" / "in.svg");
    }
    ~Neighbourhood() { fs::remove_all(path_); }

    void write(const std::string& name, const std::string& text) const {
        std::ofstream(path_ / name) << text;
    }
    std::string work() const { return (path_ / "work").string(); }

  private:
    fs::path path_;
};

}  // namespace

TEST_CASE("workspace: paths and links that lead out are refused, those that stay inside are followed") {
    const Neighbourhood place;
    const Workspace workspace(place.work());
    CHECK(workspace.inside("d.svg") == fs::canonical(place.work()) / "d.svg");
    CHECK(workspace.inside("in.svg") == workspace.inside("d.svg"));
    CHECK(workspace.inside("not yet.svg").filename() == "not yet.svg");
    CHECK(workspace.inside("run.out/../d.svg") == workspace.inside("d.svg"));
    for (const std::string& path :
         {std::string(""), std::string(".."), std::string("../secret.svg"), std::string("/etc/passwd"),
          std::string("out/secret.svg"), std::string("out.svg"), std::string("run.out/../../secret.svg"),
          std::string("d.svg\0x", 7), std::string("missing/../../secret.svg"), std::string("out/none/x")}) {
        CAPTURE(path);
        CHECK_THROWS_AS((void)workspace.inside(path), OutsideFolder);
    }
}

TEST_CASE("workspace: only drawings, scenes and a result's files for people are served") {
    const Neighbourhood place;
    const Workspace workspace(place.work());
    CHECK_FALSE(workspace.served_file("d.svg").empty());
    CHECK_FALSE(workspace.served_file("run.out/shape.obj").empty());
    CHECK(workspace.served_file("run.out/state.ruche").empty());
    CHECK(workspace.served_file("run.out").empty());
    place.write("work/shape.obj", "v 0 0 0");  // beside no report
    CHECK(workspace.served_file("shape.obj").empty());
    CHECK(workspace.drawings() == std::vector<std::string>{"d.svg"});  // links are not the folder's own
}

TEST_CASE("workspace: an uploaded drawing gets a plain name and never replaces another") {
    const Neighbourhood place;
    const Workspace workspace(place.work());
    CHECK(workspace.keep_drawing("../../My drawing (2).svg", "<svg/>") == "My-drawing-2.svg");
    CHECK(workspace.keep_drawing("d.svg", "<svg/>") == "d.svg");
    CHECK(workspace.keep_drawing("d.svg", "<svg></svg>") == "d-2.svg");
    CHECK(workspace.keep_drawing("out.svg", "<svg/>") == "out-2.svg");  // the link is left alone
    CHECK(workspace.keep_drawing("\xff\xfe/..", "<svg/>") == "drawing.svg");
    CHECK_THROWS_AS((void)workspace.keep_drawing("x.svg", "hello"), InputError);
}

TEST_CASE(
    "workspace: a scan keeps its kind of file and a plain name, and is listed, a result's shape is not") {
    const Neighbourhood place;
    const Workspace workspace(place.work());
    CHECK(workspace.scans().empty());
    CHECK(workspace.keep_measured("../my scan.PLY", "ply") == "my-scan.ply");
    CHECK(workspace.keep_measured("my scan.ply", "ply") == "my-scan.ply");
    CHECK(workspace.keep_measured("my scan.ply", "other") == "my-scan-2.ply");
    CHECK(workspace.keep_measured("??.stl", "solid") == "scan.stl");
    CHECK(workspace.keep_measured("IMG 1.JPG", "jpeg") == "IMG-1.jpg");
    CHECK(workspace.scans() == std::vector<std::string>{"my-scan-2.ply", "my-scan.ply", "scan.stl"});
    CHECK_THROWS_AS((void)workspace.keep_measured("scan.svg", "<svg/>"), InputError);
    CHECK_THROWS_AS((void)workspace.keep_measured("scan", ""), InputError);
}

TEST_CASE("workspace: a new result gets a folder that is neither there nor promised") {
    const Neighbourhood place;
    const Workspace workspace(place.work());
    CHECK(workspace.new_result("run", {}) == "run-2.out");
    CHECK(workspace.new_result("run", {"run-2.out", "run-3.out"}) == "run-4.out");
    CHECK(workspace.new_result("out", {}) == "out.out");
    CHECK_THROWS_AS(Workspace(place.work() + "/d.svg"), InputError);
}
