#pragma once

namespace ruche {

/// A heavy strip that is clamped horizontally and hangs over: the elastica under its own weight. In units of
/// the overhang L, with the load Gamma = w g L^3 / k_B (w: mass per area, k_B: bending stiffness per width),
/// s from the clamp and theta below the horizontal (Bickley 1934; the "master curve" of Romero et al. 2021):
///
///     theta'' = -Gamma (1 - s) cos theta,   theta(0) = 0,   theta'(1) = 0
struct Cantilever {
    double load = 0.0;       ///< Gamma
    double reach = 1.0;      ///< x: horizontal distance of the tip from the clamp, over L
    double drop = 0.0;       ///< y: how far the tip hangs below the clamp, over L
    double tip_angle = 0.0;  ///< theta(1), rad
};

/// Seen from the tip, with u = Gamma^(1/3) (1 - s), the strips of all loads are one family theta'' = -u cos
/// theta, theta'(0) = 0 whose members differ in the tip's angle: no boundary-value problem is left. Loads
/// from 1e-6 to 1e4, to about twelve digits (Runge-Kutta-Fehlberg of order 8).
Cantilever cantilever(double load);

/// The strip whose chord from clamp to tip hangs at atan2(y, x) = `angle` below the horizontal, in (0, 1.5].
Cantilever cantilever_of_chord(double angle);

}  // namespace ruche
