#pragma once

#include <array>
#include <optional>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/meshing/print_mesh.hpp"

namespace ruche {

struct Result;

/// An equilibrium on the way from flat to released.
struct FilmFrame {
    /// Which part of the final mismatch (s^2 - 1)/(2 s^2) between fabric and plastic acts: curvature is
    /// nearly proportional to it (theory, 5.2).
    double share = 0.0;
    std::array<double, 2> prestretch = {1, 1};  ///< at which it is an equilibrium
    std::vector<Vec3> shape;                    ///< one position per vertex of the film's layout, mm
};

/// How a sheet gets from flat to its released shape: equilibria at growing pre-stretch, beginning with the
/// flat layout; the released shape itself is not among them. On a mesh of its own, which is coarser where the
/// result's is fine. Each frame is turned to lie as near as possible to the next.
struct ReleaseFilm {
    PrintMesh layout;
    std::vector<FilmFrame> frames;
};

/// Follows a released shape back to the flat state, from equilibrium to equilibrium (each to a last Newton
/// step below 2e-3 rad), in `scene.output.film_frames` equal steps of the mismatch. Frames that are not found
/// are left out. None without frames wanted, where the shape is not converged, where it is stopped or out of
/// time, and where the sheet is held or comes from a mesh file and is too fine to be followed quickly.
std::optional<ReleaseFilm> film_release(const Result& result, const Control& control = {});

}  // namespace ruche
