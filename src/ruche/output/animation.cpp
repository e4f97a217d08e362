#include "ruche/output/animation.hpp"

#include <webp/encode.h>
#include <webp/mux.h>

#include <stdexcept>

#include "ruche/output/animated_png.hpp"

namespace ruche {

constexpr float quality = 88.0F;

class Animation::Encoder {
  public:
    Encoder() = default;
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;
    virtual ~Encoder() = default;

    virtual void add(const Image& image, int milliseconds) = 0;
    virtual std::string file() = 0;
};

class Animation::Webp : public Encoder {
  public:
    Webp(int width, int height) : width_(width), height_(height) {
        WebPAnimEncoderOptions options;
        if (WebPAnimEncoderOptionsInit(&options) == 0 || WebPConfigInit(&config_) == 0)
            fail("another version of libwebp was expected");
        options.anim_params.loop_count = 0;  // over and over
        config_.quality = quality;
        config_.alpha_quality = 100;
        handle_ = WebPAnimEncoderNew(width, height, &options);
        if (handle_ == nullptr) fail("the size is not possible");
    }
    Webp(const Webp&) = delete;
    Webp& operator=(const Webp&) = delete;
    ~Webp() override { WebPAnimEncoderDelete(handle_); }

    void add(const Image& image, int milliseconds) override {
        WebPPicture picture;
        if (WebPPictureInit(&picture) == 0) fail("another version of libwebp was expected");
        picture.use_argb = 1;
        picture.width = width_;
        picture.height = height_;
        const std::vector<unsigned char> pixels = rgba(image);
        const bool added = WebPPictureImportRGBA(&picture, pixels.data(), 4 * picture.width) != 0 &&
                           WebPAnimEncoderAdd(handle_, &picture, time_ms_, &config_) != 0;
        WebPPictureFree(&picture);
        if (!added) fail("a frame was refused:");
        time_ms_ += milliseconds;
    }

    std::string file() override {
        WebPData data;
        WebPDataInit(&data);
        const bool done = WebPAnimEncoderAdd(handle_, nullptr, time_ms_, nullptr) != 0 &&
                          WebPAnimEncoderAssemble(handle_, &data) != 0;
        if (!done) {
            WebPDataClear(&data);
            fail("the file could not be put together:");
        }
        std::string bytes(reinterpret_cast<const char*>(data.bytes), data.size);
        WebPDataClear(&data);
        return bytes;
    }

  private:
    [[noreturn]] void fail(const char* what) const {
        const char* reason = handle_ != nullptr ? WebPAnimEncoderGetError(handle_) : "";
        throw std::runtime_error(std::string("cannot encode the animation: ") + what + " " + reason);
    }

    WebPAnimEncoder* handle_ = nullptr;
    WebPConfig config_ = {};
    int width_ = 0;
    int height_ = 0;
    int time_ms_ = 0;
};

class Animation::Apng : public Encoder {
  public:
    void add(const Image& image, int milliseconds) override { png_.add(image, milliseconds); }
    std::string file() override { return png_.file(); }

  private:
    AnimatedPng png_;
};

Animation::Animation(AnimationKind kind, int width, int height) {
    if (kind == AnimationKind::webp)
        encoder_ = std::make_unique<Webp>(width, height);
    else
        encoder_ = std::make_unique<Apng>();
}

Animation::~Animation() = default;

void Animation::add(const Image& image, int milliseconds) { encoder_->add(image, milliseconds); }

std::string Animation::file() { return encoder_->file(); }

}  // namespace ruche
