#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace ruche {

/// Where an array of numbers lies in a run of bytes, and how to read it there: little endian; a stored
/// integer q of component k stands for origin[k] + scale[k] q (itself where these are empty).
struct PackedArray {
    std::string name;
    std::string type;  ///< "u8", "u16", "u32", or "f16": IEEE 754 binary16
    std::size_t at = 0;
    std::size_t count = 0;
    int components = 1;
    std::vector<double> origin;
    std::vector<double> scale;
};

/// Numbers as small as their use allows, one array after the other.
class PackedArrays {
  public:
    const std::vector<PackedArray>& list() const { return list_; }
    const std::string& bytes() const { return bytes_; }

    /// Whole numbers from -1 (stored as the largest of the type) up, in the smallest type that holds them.
    void add_numbers(const std::string& name, std::span<const int> values, int components = 1);

    /// In 16 bits, evenly between the smallest and the largest of each component: exact to 1/131070 of that
    /// range. Values have to be finite.
    void add_even(const std::string& name, std::span<const double> values, int components = 1);

    /// In 16 bits, each exact to 1/2048 of itself, beyond 65504 cut off: for values over many decades. What
    /// is not a number stays none.
    void add_relative(const std::string& name, std::span<const double> values);

  private:
    PackedArray& begin(const std::string& name, const char* type, std::size_t values, int components);

    std::vector<PackedArray> list_;
    std::string bytes_;
};

/// Bytes as text (RFC 4648), and back. The second throws InputError for what is none.
std::string base64(const std::string& bytes);
std::string from_base64(const std::string& text);

}  // namespace ruche
