#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ruche/output/camera.hpp"
#include "ruche/output/colour_field.hpp"
#include "ruche/output/image.hpp"
#include "ruche/scene/result.hpp"

namespace ruche {

struct PortraitOptions {
    int width_px = 1600;
    int height_px = 1200;
    double azimuth_deg = 0.0;  ///< how far the viewer walks around the shape, counter-clockwise from above
    std::optional<double> elevation_deg;  ///< of the viewer above the horizon; else the most telling one
    std::string colour;                   ///< name of a field; empty = fabric and plastic as they are
    bool transparent = false;             ///< nothing behind the sheet but its shadow
};

/// Pictures of one result's released shape, and of others of the same sheet, all from one distance and with
/// one legend. Needs no display. Same bits at any thread count.
class Portrait {
  public:
    /// `others`: shapes that have to fit into the picture, too (see film_release). Throws InputError for a
    /// colour that is none.
    Portrait(const Result& result, PortraitOptions options, const std::vector<FilmFrame>& others = {});

    /// The released shape, after walking on by `turn_deg`.
    Image released(double turn_deg = 0.0) const;

    /// Another shape of the sheet on `layout`, in the colours of its materials.
    Image other(const PrintMesh& layout, const std::vector<Vec3>& shape) const;

  private:
    Image take(const Result& result, const std::vector<Vec3>& shape, double turn_deg, bool coloured) const;
    Placement placement(const std::vector<Vec3>& shape, double turn_deg) const;
    void draw_legend(Image& image) const;

    const Result& result_;
    PortraitOptions options_;
    View view_;
    double radius_ = 1.0;  ///< mm, around any shape's middle
    std::optional<ColourField> field_;
};

}  // namespace ruche
