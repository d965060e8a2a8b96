// Reads a system: TOML file, built-in name, --set and other overrides.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "carom/certify/exact_system.hpp"
#include "carom/files/system_overrides.hpp"
#include "carom/system/system.hpp"

namespace carom::trust {
struct WrittenSystem;
}  // namespace carom::trust

namespace carom {

/// A key of the system file.
struct KeyDescription {
  std::string_view section;  ///< "table", "table.hole", "table.loop", "lattice", "field", …
  std::string_view kind;     ///< shape or kind the key belongs to ("" : all), several by |
  std::string_view key;
  std::string_view type;      ///< number, integer, string, boolean, point, list of points, …
  std::string_view fallback;  ///< default as written ("" : required or none)
  std::string_view meaning;
};
/// The one table of keys: parser, hints, --set and the guide's page are made from it.
const std::vector<KeyDescription>& key_table();

/// A system that the program carries with it, as the text of its file.
struct BuiltinSystem {
  std::string_view name, toml;
};
/// All of them, in the order in which `carom systems` lists them.
const std::vector<BuiltinSystem>& builtin_systems();

/// A system and the complete resolved TOML it came from (can be read again).
struct LoadedSystem {
  System system;
  std::string resolved_toml;
  /// The same with the numbers as they were written, of the first particle. Its start is that of
  /// [initial] if that is a point.
  ExactSystem exact;
  ExactNumber t_max;
};

/// `name`: a file if it has a '/' or ends in ".toml", else a built-in name. Throws InputError.
LoadedSystem load_system(const std::string& name, const SystemOverrides& = {});
/// The same from text; `file` is used in messages.
LoadedSystem read_system(std::string_view toml, const std::string& file,
                         const SystemOverrides& = {});
/// The written numbers from which the doubles of a system were rounded (SingleRunOptions::written);
/// null if they are not known.
std::shared_ptr<const trust::WrittenSystem> written_system(const LoadedSystem&);

}  // namespace carom
