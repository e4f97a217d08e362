#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "ruche/core/document.hpp"
#include "ruche/core/fields.hpp"

namespace ruche {

/// Where each value was set, by full name: "fabric.prestretch" -> line 14 of kite.toml.
using Sources = std::map<std::string, Place>;

/// Reads one table of a TOML file into structs and remembers which keys mean something, so that `finish`
/// can refuse the others. Every error is an InputError with the place of the value.
class TableReader {
  public:
    /// `path` is the table's full name, "" for the whole file. `table` must outlive the reader.
    TableReader(const Node& table, std::string path, Sources* sources = nullptr);

    /// The entry of that name, which is known from now on; null when the file does not have it.
    const Node* take(std::string_view key);

    /// The entry of that name when it is a table (or absent: null). Throws when it is something else.
    const Node* take_table(std::string_view key);

    /// The entries of an array of tables ([[support]]); empty when absent. Throws when it is something else.
    std::vector<const Node*> take_tables(std::string_view key);

    /// Reads every field of the struct that the table has; the others keep their value.
    template <class Struct>
    void read(Struct& s) {
        for (const Field<Struct>& field : fields<Struct>())
            if (const Node* node = take(field.key)) set(s, field, value_of(*node, info(field)));
    }

    /// Refuses what nobody asked for: "unknown key; did you mean fabric_thickness_mm?".
    void finish() const;

    bool has(std::string_view key) const { return table_->find(key) != nullptr; }
    std::string path_of(std::string_view key) const;
    Place place_of_key(std::string_view key) const;  ///< of the entry, or of the table when it has none

  private:
    FieldValue value_of(const Node& node, const FieldInfo& info);

    const Node* table_;
    std::string path_;
    Sources* sources_;
    std::set<std::string, std::less<>> known_;
};

/// The value of a node as the field's kind asks for it, checked. Throws InputError.
FieldValue read_value(const Node& node, const FieldInfo& info, const std::string& path);

}  // namespace ruche
