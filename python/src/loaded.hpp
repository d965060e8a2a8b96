// A system that is loaded for a command, with the options of that command as text.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "carom/files/system_file.hpp"
#include "cli/options.hpp"

namespace carom::python {

struct Loaded {
  LoadedSystem loaded;
  cli::Options options;
  const System& system() const { return loaded.system; }
};
using Texts = std::vector<std::pair<std::string, std::string>>;

/// What a command was asked for: the text of its system ("": a built-in one, by its name), changes
/// of keys as --set says them, options as cli::set_options takes them.
cli::Options options_of(const std::string& toml, const std::string& name,
                        const std::string& command, const Texts& set, const Texts& texts);

using LoadedPointer = std::shared_ptr<const Loaded>;

/// Classes and functions of each part of the module.
void add_loading(pybind11::module_&);
void add_ensembles(pybind11::module_&);
void add_runs(pybind11::module_&);
void add_orbits(pybind11::module_&);
void add_certified(pybind11::module_&);
void add_comparisons(pybind11::module_&);
void add_rare(pybind11::module_&);
void add_sweeps(pybind11::module_&);
void add_validation(pybind11::module_&);
void add_equilibria(pybind11::module_&);
void add_pictures(pybind11::module_&);

}  // namespace carom::python
