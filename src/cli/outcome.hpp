// What a command gives, of whatever kind: computed, or read from an archive.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "carom/files/system_file.hpp"
#include "cli/commands/own_step.hpp"
#include "cli/options.hpp"
#include "files/json.hpp"

namespace carom::cli {

/// A system that is loaded for a command, with the options of that command as text.
struct Loaded {
  LoadedSystem loaded;
  Options options;
  const System& system() const { return loaded.system; }
};
using LoadedPointer = std::shared_ptr<Loaded>;

class Outcome {
 public:
  Outcome() = default;
  explicit Outcome(LoadedPointer system) : loaded(std::move(system)) {}
  virtual ~Outcome() = default;
  virtual files::Json json() const = 0;
  virtual std::string text() const = 0;
  /// Why the result cannot be trusted, a line each.
  virtual std::vector<std::string> doubts() const { return {}; }
  /// Writes its archive. Throws InputError where it exists without `force`, and for results that no
  /// archive holds. `stop` may be set meanwhile: then there is no file.
  virtual void save(const std::string& file, bool force, const std::atomic<bool>& stop) const;

  const System& system() const { return loaded->system(); }
  LoadedPointer loaded;             ///< null: it has no system
  std::optional<OwnStep> own_step;  ///< of one that was flown here
};
using OutcomePointer = std::shared_ptr<Outcome>;

/// The result that an archive holds. Throws InputError for anything else.
OutcomePointer open_outcome(const std::string& file);

/// The system that an archive of such a command holds. `engine`: as the archive says.
LoadedPointer loaded_again(const std::string& command, const std::string& toml,
                           const std::string& name, const std::string& file,
                           const std::string& engine = "auto");

/// Of each kind of archive.
OutcomePointer open_ensemble(const std::string& file);
OutcomePointer open_run(const std::string& file);
OutcomePointer open_certified(const std::string& file);
OutcomePointer open_section(const std::string& file);
OutcomePointer open_relax(const std::string& file);
OutcomePointer open_orbits(const std::string& file);
OutcomePointer open_comparison(const std::string& file);

}  // namespace carom::cli
