#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/scene/scene.hpp"

namespace ruche {

/// A scene to measure with, of the sizes that people print.
struct BenchmarkSceneInfo {
    std::string_view name;
    std::string_view meaning;
    int triangles;  ///< unless asked otherwise
};
std::vector<BenchmarkSceneInfo> benchmark_scenes();

/// One of them, made in code: an installed program needs no file for it. Scenes from a drawing write it into
/// a folder of their own below the system's temporary one, which goes with the object.
class BenchmarkScene {
  public:
    /// Throws InputError for a name that is not in the list.
    explicit BenchmarkScene(std::string_view name);
    BenchmarkScene(const BenchmarkScene&) = delete;
    BenchmarkScene& operator=(const BenchmarkScene&) = delete;
    ~BenchmarkScene();

    /// Chooses all element sizes, by one factor, so that the mesh has about `triangles` triangles (within 5
    /// %, 10 % where the mesher will not come closer). Throws InputError where the pattern itself takes more.
    void resize(int triangles, const Control& control = {});

    const Scene& scene() const { return scene_; }
    Scene& scene() { return scene_; }

  private:
    void draw(const std::string& svg);

    std::string folder_;
    Scene scene_;
};

}  // namespace ruche
