#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <vector>

#include "ruche/output/relief.hpp"

namespace ruche {

using Vec2f = Eigen::Vector2f;
using Vec3f = Eigen::Vector3f;

struct Ray {
    Vec3f origin;
    Vec3f direction;  ///< need not be a unit vector; distances are in its lengths
    float begin = 0.0F;
    float end = std::numeric_limits<float>::infinity();
};

/// Where a ray met a part of the scene.
struct RayHit {
    float distance = 0.0F;
    int part = -1;  ///< index into the parts given to the scene
    int triangle = -1;
    float u = 0.0F, v = 0.0F;  ///< barycentric coordinates of the second and third vertex
};

/// Triangle meshes that can be asked what a ray meets (Embree). Answers do not depend on threads.
class RayScene {
  public:
    /// Throws std::runtime_error when Embree cannot start.
    explicit RayScene(std::vector<Relief> parts);
    RayScene(RayScene&&) noexcept;
    RayScene& operator=(RayScene&&) noexcept;
    ~RayScene();

    const std::vector<Relief>& parts() const { return parts_; }
    bool intersect(const Ray& ray, RayHit& hit) const;
    bool occluded(const Ray& ray) const;

  private:
    struct Handles;
    std::vector<Relief> parts_;
    std::unique_ptr<Handles> handles_;
};

}  // namespace ruche
