#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "ruche/core/error.hpp"
#include "ruche/pattern/drawing.hpp"

/// libFuzzer: whatever the bytes, read_svg returns a finite drawing or throws InputError.
/// How to build and run it: tests/CMakeLists.txt.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string path =
        (std::filesystem::temp_directory_path() / ("ruche-svg-fuzz-" + std::to_string(getpid()) + ".svg"))
            .string();
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    try {
        const ruche::Drawing drawing = ruche::read_svg(path, {.flatten_tolerance_mm = 0.1});
        for (const ruche::Shape& shape : drawing.shapes) {
            if (!(ruche::area(shape.stroked) >= 0.0 && ruche::area(shape.filled) >= 0.0)) std::abort();
            for (const ruche::Polyline& line : shape.lines) {
                for (const ruche::Vec2& point : line) {
                    if (!point.allFinite()) std::abort();
                }
            }
        }
    } catch (const ruche::InputError&) {
    }
    std::remove(path.c_str());
    return 0;
}
