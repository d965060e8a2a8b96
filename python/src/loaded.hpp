// What the parts of the module share: systems that are loaded for a command, and outcomes.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/outcome.hpp"

namespace carom::python {

using cli::Loaded;
using cli::LoadedPointer;
using cli::Outcome;
using Texts = std::vector<std::pair<std::string, std::string>>;

/// What a command was asked for: the text of its system ("": a built-in one, by its name), changes
/// of keys as --set says them, options as cli::set_options takes them.
cli::Options options_of(const std::string& toml, const std::string& name,
                        const std::string& command, const Texts& set, const Texts& texts);

/// Classes and functions of each part of the module.
void add_outcomes(pybind11::module_&);
void add_loading(pybind11::module_&);
void add_ensembles(pybind11::module_&);
void add_runs(pybind11::module_&);
void add_orbits(pybind11::module_&);
void add_certified(pybind11::module_&);
void add_comparisons(pybind11::module_&);
void add_rare(pybind11::module_&);
void add_streams(pybind11::module_&);
void add_sweeps(pybind11::module_&);
void add_validation(pybind11::module_&);
void add_equilibria(pybind11::module_&);
void add_pictures(pybind11::module_&);

}  // namespace carom::python
