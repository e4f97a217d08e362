#pragma once

#include <Eigen/Core>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "ruche/meshing/print_mesh.hpp"
#include "ruche/statics/iterate.hpp"

namespace ruche {

/// The shape that a running release has reached, for those who look at it from other threads. It keeps the
/// last one when the release has ended.
class LiveShape {
  public:
    /// Takes the next shape of a job, turned to lie as near as possible to the flat sheet.
    void take(int job, const Iterate& iterate);

    /// Counts the shapes taken.
    int version() const;

    /// The last shape as JSON: {"job": 3, "mesh": 2, "iteration": 4, "triangles": 1400, "residual_N": ...,
    /// "history": [[triangles, residual], ...], "arrays": {...}, "bytes": "base64"} with the array shape_mm,
    /// and with those of the layout unless `known_mesh` is the mesh's number. "{}" when there is none.
    std::string json(int known_mesh) const;

  private:
    struct Step {
        int triangles;
        double residual;
    };
    mutable std::mutex mutex_;
    int job_ = 0;
    int mesh_ = 0;
    int version_ = 0;
    int iteration_ = 0;
    double residual_ = 0.0;
    std::shared_ptr<const PrintMesh> layout_;
    std::shared_ptr<const std::vector<Vec3>> shape_;
    std::vector<Step> history_;
};

}  // namespace ruche
