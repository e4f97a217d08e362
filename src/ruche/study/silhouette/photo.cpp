#include "ruche/study/silhouette/photo.hpp"

#include <fmt/format.h>
#include <png.h>

#include <array>
#include <csetjmp>
#include <cstdio>
#include <fstream>
#include <string_view>

// After <cstdio>, which it does not include itself.
#include <jpeglib.h>

#include "ruche/core/document.hpp"
#include "ruche/core/error.hpp"

namespace ruche {
namespace {

constexpr std::string_view png_begin = "\x89PNG\r\n\x1a\n";
constexpr std::string_view jpeg_begin = "\xff\xd8\xff";
constexpr std::size_t largest_photo_file = std::size_t{1} << 29U;
constexpr double most_pixels = 200e6;

InputError broken(const std::string& path, const char* kind, const std::string& why) {
    return {{.file = path}, fmt::format("is not a complete {} picture: {}", kind, why)};
}

void must_be_small(const std::string& path, double width, double height) {
    if (width * height > most_pixels)
        throw InputError({.file = path},
                         fmt::format("has {} x {} pixels, at most 200 million are read", width, height),
                         "Save a smaller copy: a few megapixels are plenty.");
}

Image read_png(const std::string& bytes, const std::string& path) {
    png_image header = {};
    header.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()) == 0)
        throw broken(path, "PNG", header.message);
    header.format = PNG_FORMAT_RGB;
    Image image{.width = static_cast<int>(header.width), .height = static_cast<int>(header.height)};
    try {
        must_be_small(path, header.width, header.height);
        image.rgb.resize(PNG_IMAGE_SIZE(header));
    } catch (...) {
        png_image_free(&header);
        throw;
    }
    const png_color white = {255, 255, 255};
    if (png_image_finish_read(&header, &white, image.rgb.data(), 0, nullptr) == 0)
        throw broken(path, "PNG", header.message);
    return image;
}

/// The library's way out of a broken file: back to where `back` was set, with a message.
struct JpegWayOut {
    jpeg_error_mgr manager;
    std::jmp_buf back;
    std::array<char, JMSG_LENGTH_MAX> message;
};

[[noreturn]] void leave(j_common_ptr state) {
    auto* out = reinterpret_cast<JpegWayOut*>(state->err);
    state->err->format_message(state, out->message.data());
    std::longjmp(out->back, 1);
}

/// What a cut-off file lacks would be filled with grey: that is an error here.
void leave_on_warning(j_common_ptr state, int level) {
    if (level < 0) leave(state);
}

/// Nothing in here has a destructor that a jump could skip. False: see the message.
bool decode(jpeg_decompress_struct& state, JpegWayOut& out, const std::string& bytes, Image& image) {
    if (setjmp(out.back) != 0) return false;
    jpeg_create_decompress(&state);
    jpeg_mem_src(&state, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&state, TRUE);
    if (static_cast<double>(state.image_width) * state.image_height > most_pixels) return true;
    state.out_color_space = JCS_RGB;
    jpeg_start_decompress(&state);
    const std::size_t row_bytes = 3 * static_cast<std::size_t>(state.output_width);
    image.width = static_cast<int>(state.output_width);
    image.height = static_cast<int>(state.output_height);
    image.rgb.resize(row_bytes * state.output_height);
    while (state.output_scanline < state.output_height) {
        JSAMPROW row = image.rgb.data() + row_bytes * state.output_scanline;
        jpeg_read_scanlines(&state, &row, 1);
    }
    jpeg_finish_decompress(&state);
    return true;
}

Image read_jpeg(const std::string& bytes, const std::string& path) {
    Image image;
    jpeg_decompress_struct state = {};
    JpegWayOut out = {};
    state.err = jpeg_std_error(&out.manager);
    out.manager.error_exit = leave;
    out.manager.emit_message = leave_on_warning;
    const bool whole = decode(state, out, bytes, image);
    const double width = state.image_width;
    const double height = state.image_height;
    jpeg_destroy_decompress(&state);
    if (!whole) throw broken(path, "JPEG", out.message.data());
    must_be_small(path, width, height);
    return image;
}

std::string first_bytes(const std::string& path) {
    std::string begin(png_begin.size(), '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    begin.resize(static_cast<std::size_t>(file.gcount()));
    return begin;
}

}  // namespace

bool is_photo(const std::string& path) {
    const std::string begin = first_bytes(path);
    return begin.starts_with(png_begin) || begin.starts_with(jpeg_begin);
}

Image read_photo(const std::string& path) {
    const std::string bytes = read_file(path, "photo", largest_photo_file);
    if (bytes.starts_with(png_begin)) return read_png(bytes, path);
    if (bytes.starts_with(jpeg_begin)) return read_jpeg(bytes, path);
    throw InputError({.file = path}, "is neither a PNG nor a JPEG picture");
}

}  // namespace ruche
