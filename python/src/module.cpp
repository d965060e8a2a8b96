// The Python module: what C++ computes, as Python objects. The package carom gives them names.
#include <pybind11/pybind11.h>

#include <algorithm>
#include <string>

#include "base/printable.hpp"
#include "carom/base/error.hpp"
#include "carom/files/archive.hpp"
#include "carom/starts/sampler.hpp"
#include "carom_version.hpp"
#include "files/toml/overrides.hpp"
#include "loaded.hpp"

namespace py = pybind11;

namespace {

// In Python there is no command line, but keywords, and no text of a system that has no file.
carom::Place place_in_python(carom::Place place) {
  const bool of_file = place.file.find_first_of("./") != std::string::npos;
  if (place.file == carom::files::command_line_file || (place.line > 0 && !of_file))
    place = {"", 0, 0, place.key};
  if (place.key.starts_with("--")) {
    place.key.erase(0, 2);
    const auto end = std::find(place.key.begin(), place.key.end(), ' ');
    std::replace(place.key.begin(), end, '-', '_');
  }
  return place;
}

// carom.InputError, with what the message is made of.
void raise_input_error(const carom::InputError& thrown) {
  const py::object type = py::module_::import("carom.errors").attr("InputError");
  const carom::InputError error(place_in_python(thrown.place()), thrown.problem(),
                                thrown.expected(), thrown.nearest());
  const carom::Place& place = error.place();
  const py::object made =
      type(error.what(), py::make_tuple(place.file, place.line, place.column, place.key),
           error.expected(), error.nearest());
  PyErr_SetObject(type.ptr(), made.ptr());
}

}  // namespace

PYBIND11_MODULE(_carom, module) {
  carom::prepare_archives();
  module.attr("version") = carom::version;
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const carom::InputError& error) {
      raise_input_error(error);
    } catch (const carom::SamplingStopped&) {
      PyErr_SetString(PyExc_KeyboardInterrupt, "");
    }
  });
  module.def(
      "printable",
      [](const py::bytes& text, bool lines) {
        return carom::base::printable(std::string(text),
                                      lines ? carom::base::Lines::many : carom::base::Lines::one);
      },
      py::arg("text"), py::arg("lines"));
  carom::python::add_outcomes(module);
  carom::python::add_loading(module);
  carom::python::add_ensembles(module);
  carom::python::add_runs(module);
  carom::python::add_orbits(module);
  carom::python::add_certified(module);
  carom::python::add_comparisons(module);
  carom::python::add_rare(module);
  carom::python::add_streams(module);
  carom::python::add_sweeps(module);
  carom::python::add_validation(module);
  carom::python::add_equilibria(module);
  carom::python::add_pictures(module);
}
