#pragma once

#include <memory>
#include <string>

#include "ruche/output/image.hpp"

namespace ruche {

/// Kinds of films: WebP is lossy at a quality at which nobody sees it (libwebp) and smaller, animated
/// PNG is lossless and played by programs that do not know WebP.
enum class AnimationKind { webp, png };

/// Writes a film that browsers, chats and slides play, over and over.
class Animation {
  public:
    /// All images have this size. Throws std::runtime_error when the encoder does not take it.
    Animation(AnimationKind kind, int width, int height);
    ~Animation();
    Animation(const Animation&) = delete;
    Animation& operator=(const Animation&) = delete;

    /// Shown for `milliseconds`.
    void add(const Image& image, int milliseconds);

    /// The contents of the file; to be called once, at the end.
    std::string file();

  private:
    class Encoder;
    class Webp;
    class Apng;
    std::unique_ptr<Encoder> encoder_;
};

}  // namespace ruche
