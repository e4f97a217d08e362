#pragma once

#include <vector>

#include "ruche/output/film.hpp"
#include "ruche/output/image.hpp"

namespace ruche {

/// Part of a developed film that shadows on the ground have to end in: columns [left, right).
struct Borders {
    int left = 0, right = 0;
    float reach = 1.0F;  ///< pixels from the border inwards over which they fade
};

/// The paper behind everything, a little brighter around `middle` (0 to 1 across and down the picture);
/// linear.
std::vector<Vec3f> backdrop(int width, int height, const Vec2f& middle);

/// Lets shadows on the ground run out before the borders of a panel.
void fade_borders(Film& film, const Borders& borders);

/// A developed film as screens show it.
Image print(const Film& film);

/// The same without the ground: of it only the shadow stays, as darkness one can see through. The film has to
/// be exposed before a black ground.
Image print_transparent(const Film& film);

}  // namespace ruche
