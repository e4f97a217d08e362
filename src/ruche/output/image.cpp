#include "ruche/output/image.hpp"

#include <png.h>

#include <stdexcept>

namespace ruche {

std::vector<unsigned char> rgba(const Image& image) {
    const std::size_t pixels = image.rgb.size() / 3;
    std::vector<unsigned char> bytes;
    bytes.reserve(4 * pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        bytes.insert(bytes.end(), {image.rgb[3 * i], image.rgb[3 * i + 1], image.rgb[3 * i + 2]});
        bytes.push_back(image.alpha.empty() ? 255 : image.alpha[i]);
    }
    return bytes;
}

std::string to_png(const Image& image) {
    const bool clear = !image.alpha.empty();
    const std::vector<unsigned char> pixels = clear ? rgba(image) : image.rgb;
    png_image header = {};
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(image.width);
    header.height = static_cast<png_uint_32>(image.height);
    header.format = clear ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
    std::string file(size, '\0');
    if (png_image_write_to_memory(&header, file.data(), &size, 0, pixels.data(), 0, nullptr) == 0)
        throw std::runtime_error(std::string("cannot encode the picture: ") + header.message);
    file.resize(size);
    return file;
}

}  // namespace ruche
