#pragma once

#include <memory>
#include <string>

#include "ruche/output/image.hpp"

namespace ruche {

/// Writes an animated WebP, which browsers, chats and slides play, over and over (libwebp, lossy at a quality
/// at which nobody sees it).
class Animation {
  public:
    /// All images have this size. Throws std::runtime_error when the encoder does not take it.
    Animation(int width, int height);
    ~Animation();
    Animation(const Animation&) = delete;
    Animation& operator=(const Animation&) = delete;

    /// Shown for `milliseconds`.
    void add(const Image& image, int milliseconds);

    /// The contents of the file; to be called once, at the end.
    std::string file();

  private:
    struct Encoder;
    std::unique_ptr<Encoder> encoder_;
};

}  // namespace ruche
