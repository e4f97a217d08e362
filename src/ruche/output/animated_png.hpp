#pragma once

#include <string>

#include "ruche/output/image.hpp"

namespace ruche {

/// Puts an animated PNG together, frame by frame, without loss (PNG, third edition, 2025: chunks acTL, fcTL,
/// fdAT). What does not know of animation shows the first frame.
class AnimatedPng {
  public:
    /// All images have one size and are with alpha or without, as the first. At most 65 s each.
    void add(const Image& image, int milliseconds);

    /// The contents of the file, which plays over and over. Not without a frame.
    std::string file() const;

  private:
    std::string head_;    // signature and IHDR
    std::string frames_;  // fcTL and IDAT or fdAT
    unsigned frame_count_ = 0;
    unsigned sequence_ = 0;
};

}  // namespace ruche
