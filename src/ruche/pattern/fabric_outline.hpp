#pragma once

#include <vector>

#include "ruche/pattern/drawing.hpp"

namespace ruche {

/// The fabric that shapes of a drawing bound: every line closed, or closed by others that go on where it
/// ends; a curve inside another one is the edge of a hole, a curve drawn twice counts once. Shapes without
/// lines bound it by their filled region. Throws InputError naming the element when a curve stays open, or
/// crosses or touches itself or another one.
Region fabric_outline(const std::vector<const Shape*>& shapes, const std::string& file);

}  // namespace ruche
