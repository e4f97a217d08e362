#include "ruche/core/table_reader.hpp"

#include <fmt/format.h>

#include <limits>

#include "ruche/core/suggest.hpp"

namespace ruche {

TableReader::TableReader(const Node& table, std::string path, Sources* sources)
    : table_(&table), path_(std::move(path)), sources_(sources) {}

const Node* TableReader::take(std::string_view key) {
    known_.emplace(key);
    return table_->find(key);
}

const Node* TableReader::take_table(std::string_view key) {
    const Node* node = take(key);
    if (node != nullptr && node->kind != Node::Kind::table)
        throw InputError(place_of(*node, path_of(key)),
                         fmt::format("expected a table, [{}], found {}", path_of(key), describe(*node)));
    return node;
}

std::vector<const Node*> TableReader::take_tables(std::string_view key) {
    const Node* node = take(key);
    if (node == nullptr) return {};
    std::vector<const Node*> tables;
    bool only_tables = node->kind == Node::Kind::array;
    for (const Node& item : node->items) {
        only_tables = only_tables && item.kind == Node::Kind::table;
        tables.push_back(&item);
    }
    if (!only_tables)
        throw InputError(
            place_of(*node, path_of(key)),
            fmt::format("expected a list of tables, [[{}]], found {}", path_of(key), describe(*node)));
    return tables;
}

void TableReader::finish() const {
    const std::vector<std::string_view> candidates(known_.begin(), known_.end());
    for (const Node& item : table_->items)
        if (known_.find(item.key) == known_.end())
            throw InputError(place_of(item, path_of(item.key)),
                             "unknown key" + did_you_mean(item.key, candidates));
}

std::string TableReader::path_of(std::string_view key) const {
    return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

Place TableReader::place_of_key(std::string_view key) const {
    const Node* node = table_->find(key);
    return place_of(node != nullptr ? *node : *table_, path_of(key));
}

FieldValue TableReader::value_of(const Node& node, const FieldInfo& info) {
    const std::string path = path_of(info.key);
    if (sources_ != nullptr) (*sources_)[path] = place_of(node, path);
    return read_value(node, info, path);
}

static std::string_view expected(FieldKind kind) {
    switch (kind) {
        case FieldKind::number:
            return "a number";
        case FieldKind::integer:
            return "an integer";
        case FieldKind::boolean:
            return "true or false";
        case FieldKind::two_numbers:
            return "a number or two numbers [a, b]";
        case FieldKind::three_numbers:
            return "three numbers [x, y, z]";
        case FieldKind::text:
        case FieldKind::choice:
            return "a text in quotes";
    }
    return {};
}

static bool is_number(const Node& node) {
    return node.kind == Node::Kind::number || node.kind == Node::Kind::integer;
}

static double as_double(const Node& node) {
    return node.kind == Node::Kind::integer ? static_cast<double>(node.integer) : node.number;
}

template <std::size_t N>
static std::array<double, N> numbers(const Node& array) {
    std::array<double, N> values{};
    for (std::size_t i = 0; i < N; ++i) values[i] = as_double(array.items[i]);
    return values;
}

static bool is_array_of(const Node& node, std::size_t count) {
    if (node.kind != Node::Kind::array || node.items.size() != count) return false;
    for (const Node& item : node.items)
        if (!is_number(item)) return false;
    return true;
}

static bool fits_int(const Node& node) {
    return node.kind == Node::Kind::integer && node.integer >= std::numeric_limits<int>::min() &&
           node.integer <= std::numeric_limits<int>::max();
}

FieldValue read_value(const Node& node, const FieldInfo& info, const std::string& path) {
    const Place place = place_of(node, path);
    FieldValue value;
    if (info.kind == FieldKind::number && is_number(node))
        value = as_double(node);
    else if (info.kind == FieldKind::integer && fits_int(node))
        value = static_cast<int>(node.integer);
    else if (info.kind == FieldKind::boolean && node.kind == Node::Kind::boolean)
        value = node.boolean;
    else if (info.kind == FieldKind::two_numbers && is_number(node))
        value = std::array<double, 2>{as_double(node), as_double(node)};
    else if (info.kind == FieldKind::two_numbers && is_array_of(node, 2))
        value = numbers<2>(node);
    else if (info.kind == FieldKind::three_numbers && is_array_of(node, 3))
        value = numbers<3>(node);
    else if ((info.kind == FieldKind::text || info.kind == FieldKind::choice) &&
             node.kind == Node::Kind::text)
        value = node.text;
    else
        throw InputError(place, fmt::format("expected {}, found {}", expected(info.kind), describe(node)),
                         std::string(info.meaning));
    check(info, value, place);
    return value;
}

}  // namespace ruche
