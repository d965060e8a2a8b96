// Systems: text, built-in names, what a command changes in them.
#include <pybind11/stl.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/base/stopwatch.hpp"
#include "carom/files/archive.hpp"
#include "cli/command_table.hpp"
#include "cli/commands/commands.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"
#include "cli/reports/table_report.hpp"
#include "files/text_file.hpp"
#include "loaded.hpp"
#include "run_in_background.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

LoadedPointer load(const std::string& toml, const std::string& name, const std::string& command,
                   const Texts& set, const Texts& texts) {
  auto made = std::make_shared<Loaded>();
  made->options = options_of(toml, name, command, set, texts);
  cli::check_engine(made->options);
  made->loaded = cli::system_of_command(made->options);
  return made;
}

// Of each command that takes a system: its options, and whether a value follows them.
using OptionNames = std::vector<std::pair<std::string, bool>>;
std::vector<std::pair<std::string, OptionNames>> options_of_commands() {
  std::vector<std::pair<std::string, OptionNames>> all;
  for (const cli::CommandRow& command : cli::command_table()) {
    OptionNames names;
    for (const cli::OptionRow& option : command.options) {
      std::string name = option.names.back().substr(2);  // without its dashes
      std::replace(name.begin(), name.end(), '-', '_');
      names.emplace_back(std::move(name), !option.value.empty());
    }
    const auto is_set = [](const auto& one) { return one.first == "set"; };
    if (std::any_of(names.begin(), names.end(), is_set))
      all.emplace_back(command.name, std::move(names));
  }
  return all;
}

struct TableOutcome final : Outcome {
  explicit TableOutcome(const LoadedPointer& of)
      : Outcome(of),
        measured(carom::measure(*system().table)),
        seconds(watch.seconds()),
        cpu_seconds(watch.cpu_seconds()) {}
  files::Json json() const override {
    return cli::table_json(loaded->loaded, measured, "", seconds, cpu_seconds);
  }
  std::string text() const override { return cli::table_text(system(), measured, ""); }

  Stopwatch watch;
  TableMeasure measured;
  double seconds, cpu_seconds;
};

std::shared_ptr<TableOutcome> measured(const LoadedPointer& loaded) {
  return std::make_shared<TableOutcome>(loaded);
}

}  // namespace

cli::Options options_of(const std::string& toml, const std::string& name,
                        const std::string& command, const Texts& set, const Texts& texts) {
  cli::Options options;
  cli::set_options(options, command, texts);
  options.command = command;
  options.line = "carom." + command + " (Python)";
  options.system = name;
  if (!toml.empty()) options.system_text = toml;
  options.quiet = true;
  options.overrides.set = set;
  return options;
}

void add_outcomes(py::module_& module) {
  py::class_<Outcome, cli::OutcomePointer>(module, "Outcome")
      .def_readonly("system", &Outcome::loaded)
      .def(
          "json",
          [](const Outcome& self) {
            return (self.own_step ? self.own_step->with_halvings(self.json()) : self.json()).text();
          })
      .def("text",
           [](const Outcome& self) {
             return self.own_step ? self.text() + self.own_step->text() : self.text();
           })
      .def("doubts", &Outcome::doubts)
      .def(
          "save",
          [](const Outcome& self, const std::string& file, bool force) {
            Course course;
            const std::exception_ptr interruption =
                run_in_background(course, py::none(), [&] { self.save(file, force, course.stop); });
            if (interruption) std::rethrow_exception(interruption);
          },
          py::arg("file"), py::arg("force"));
  module.def("open_outcome", &cli::open_outcome, py::call_guard<py::gil_scoped_release>(),
             py::arg("file"));
  module.def("kind_of_archive", &kind_of_archive, py::call_guard<py::gil_scoped_release>(),
             py::arg("file"));
}

void add_loading(py::module_& module) {
  py::class_<Loaded, LoadedPointer>(module, "Loaded")
      .def_property_readonly("name", [](const Loaded& self) { return self.system().name; })
      .def_property_readonly("title", [](const Loaded& self) { return self.system().title; })
      .def_property_readonly("toml", [](const Loaded& self) { return self.loaded.resolved_toml; })
      .def_property_readonly("engine",
                             [](const Loaded& self) { return cli::engine_of(self.system()); });
  py::class_<TableOutcome, Outcome, std::shared_ptr<TableOutcome>>(module, "TableOutcome");
  module.def("measure", &measured, py::call_guard<py::gil_scoped_release>(), py::arg("system"));
  module.def(
      "load",
      [](const std::string& toml, const std::string& name, const std::string& command,
         const Texts& set, const Texts& texts) { return load(toml, name, command, set, texts); },
      py::call_guard<py::gil_scoped_release>(), py::arg("toml"), py::arg("name"),
      py::arg("command"), py::arg("set"), py::arg("texts"));
  module.def(
      "read_text",
      [](const std::string& file) {
        std::string text;
        {
          const py::gil_scoped_release release;
          text = files::text_of_file(file, files::most_of_system_file, {file, 0, 0, ""}, "",
                                     "a TOML file");
        }
        return py::bytes(text);
      },
      py::arg("file"));
  module.def("systems", [] {
    std::vector<std::pair<std::string, std::string>> all;
    for (const BuiltinSystem& one : builtin_systems())
      all.emplace_back(std::string(one.name), std::string(one.toml));
    return all;
  });
  module.def("keys", [] {
    py::list all;
    for (const KeyDescription& key : key_table())
      all.append(py::make_tuple(std::string(key.section), std::string(key.kind),
                                std::string(key.key), std::string(key.type),
                                std::string(key.fallback), std::string(key.meaning)));
    return all;
  });
  module.def("options", &options_of_commands);
  module.def("counted", &base::counted, py::arg("number"), py::arg("noun"));
  module.def("nearest_name", &nearest_name, py::arg("name"), py::arg("known"));
}

}  // namespace carom::python
