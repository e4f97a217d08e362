#include "ruche/output/animation.hpp"

#include <webp/encode.h>
#include <webp/mux.h>

#include <stdexcept>

namespace ruche {

constexpr float quality = 88.0F;

struct Animation::Encoder {
    WebPAnimEncoder* handle = nullptr;
    WebPConfig config = {};
    int width = 0;
    int height = 0;
    int time_ms = 0;

    Encoder() = default;
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;
    ~Encoder() { WebPAnimEncoderDelete(handle); }

    [[noreturn]] void fail(const char* what) const {
        const char* reason = handle != nullptr ? WebPAnimEncoderGetError(handle) : "";
        throw std::runtime_error(std::string("cannot encode the animation: ") + what + " " + reason);
    }
};

Animation::Animation(int width, int height) : encoder_(std::make_unique<Encoder>()) {
    encoder_->width = width;
    encoder_->height = height;
    WebPAnimEncoderOptions options;
    if (WebPAnimEncoderOptionsInit(&options) == 0 || WebPConfigInit(&encoder_->config) == 0)
        encoder_->fail("another version of libwebp was expected");
    options.anim_params.loop_count = 0;  // over and over
    encoder_->config.quality = quality;
    encoder_->config.alpha_quality = 100;
    encoder_->handle = WebPAnimEncoderNew(width, height, &options);
    if (encoder_->handle == nullptr) encoder_->fail("the size is not possible");
}

Animation::~Animation() = default;

void Animation::add(const Image& image, int milliseconds) {
    WebPPicture picture;
    if (WebPPictureInit(&picture) == 0) encoder_->fail("another version of libwebp was expected");
    picture.use_argb = 1;
    picture.width = encoder_->width;
    picture.height = encoder_->height;
    const std::vector<unsigned char> pixels = rgba(image);
    const bool added =
        WebPPictureImportRGBA(&picture, pixels.data(), 4 * picture.width) != 0 &&
        WebPAnimEncoderAdd(encoder_->handle, &picture, encoder_->time_ms, &encoder_->config) != 0;
    WebPPictureFree(&picture);
    if (!added) encoder_->fail("a frame was refused:");
    encoder_->time_ms += milliseconds;
}

std::string Animation::file() {
    WebPData data;
    WebPDataInit(&data);
    const bool done = WebPAnimEncoderAdd(encoder_->handle, nullptr, encoder_->time_ms, nullptr) != 0 &&
                      WebPAnimEncoderAssemble(encoder_->handle, &data) != 0;
    if (!done) {
        WebPDataClear(&data);
        encoder_->fail("the file could not be put together:");
    }
    std::string bytes(reinterpret_cast<const char*>(data.bytes), data.size);
    WebPDataClear(&data);
    return bytes;
}

}  // namespace ruche
