#pragma once

#include "ruche/output/film.hpp"
#include "ruche/output/stage.hpp"

namespace ruche {

/// Part of a film that shows one stage.
struct Shot {
    const Stage* stage = nullptr;
    Camera camera;
    int left = 0, right = 0;  ///< columns [left, right); all rows
};

/// Takes the picture: soft light from the upper left, light from a bright surrounding, one bounce, gloss on
/// plastic, a little light through the fabric. The ground's colour is given per picture element in `ground`
/// (linear), so that it runs into the background. Every picture element has random numbers of its own: the
/// same bits at any thread count.
void expose(Film& film, const Shot& shot, const std::vector<Vec3f>& ground);

}  // namespace ruche
